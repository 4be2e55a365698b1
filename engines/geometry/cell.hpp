/// The periodic cell: nearest images, wrapping, and images that slide past one another (Lees-Edwards).
#pragma once
#include <string>

#include "engines/geometry/refuse.hpp"

namespace graindrive::geometry {

/// A vector or a point after whole periods were taken off.
template <int D>
struct Image {
	Vec<D> at;       ///< [m]
	Vec<D> periods;  ///< how many were taken off along each axis, whole numbers [-]
	bool wrapped;    ///< `at` differs from what was given
};

/// The box along each axis, and its shear.
///
/// Images n periods further along the axis `across` are displaced by n `offset` along the axis `along`, and move with n `rate`:
///
///   x(image) = x + n (L e_across + offset e_along),  v(image) = v + n (growth e_across + rate e_along),
///   d offset/dt = rate,  dL/dt = growth
///
/// (Lees, Edwards, J. Phys. C 5, 1921 (1972)). With across = y, along = x the mean shear rate is dv_x/dy = rate/L_y.
template <int D>
struct Cell {
	static constexpr int none = -1;

	Vec<D> low, high;       ///< [m]; used along periodic axes
	bool periodic[D] = {};  ///< by axis
	int across = none;      ///< axis whose images are displaced, `none` without shear
	int along = 0;          ///< axis of their displacement
	double offset = 0;      ///< of the image one period further [m]
	double rate = 0;        ///< velocity of that image [m/s]
	double growth = 0;      ///< the same along `across`: the period there becomes longer [m/s]

	double length(int k) const { return high[k] - low[k]; }
	bool sheared() const { return across != none; }

	/// The separation d = b - a to the nearest image of b.
	///
	/// d - L nearbyint(d/L) along each axis. Under shear no image is nearer as long as the result is shorter than half of every
	/// period: the images of the next layers are farther than L_across/2.
	Image<D> nearest(const Vec<D>& d) const
	{
		return reduced(d, [](double x, int, double period) { return std::nearbyint(x / period); });
	}

	/// The image of a point that lies in the cell: x - L floor((x - low)/L). The point's velocity changes by `velocity_change`.
	///
	/// A point in [low, high) does not change, so wrapping twice equals wrapping once. A point that lies on a side up to round-off may
	/// come out on the other one, or beyond it by a round-off: these are images of one another.
	Image<D> wrap(const Vec<D>& at) const
	{
		return reduced(at, [this](double x, int k, double period) { return std::floor((x - low[k]) / period); });
	}

	/// Velocity of the image one period further along `across` [m/s].
	Vec<D> image_velocity() const
	{
		Vec<D> v;
		if (sheared()) v[along] = rate, v[across] = growth;
		return v;
	}

	void set_image_velocity(const Vec<D>& v) { rate = v[along], growth = v[across]; }

	/// What a velocity, or a difference of velocities b - a, gains when it is seen from the image: -n times that of the next one [m/s].
	Vec<D> velocity_change(const Image<D>& image) const
	{
		return sheared() ? -image.periods[across] * image_velocity() : Vec<D>{};
	}

	/// The cell after a time dt. Whole periods of the offset are left out: they displace no image.
	void advance(double dt)
	{
		if (!sheared()) return;
		set_offset(offset + rate * dt);
		high[across] += growth * dt;
	}

	void set_offset(double value)
	{
		const double period = length(along);
		offset = value - period * std::floor(value / period);
	}

	/// @throws std::invalid_argument where sides, axes or shear make no cell
	void check() const;

private:
	/// Along the axis `across` first, for its periods displace the point along the other.
	template <class Count>
	Image<D> reduced(const Vec<D>& given, Count count) const
	{
		Image<D> image{ given, {}, false };
		const auto take_off = [&](int k) {
			const double period = length(k);
			image.periods[k] = count(image.at[k], k, period);
			image.at[k] = image.at[k] - period * image.periods[k];
		};
		if (sheared()) {
			take_off(across);
			image.at[along] -= image.periods[across] * offset;
		}
		for (int k = 0; k < D; ++k)
			if (periodic[k] && k != across) take_off(k);
		image.wrapped = image.at != given;
		return image;
	}
};

template <int D>
void Cell<D>::check() const
{
	const auto name = [](int k) { return std::string(1, "xyz"[k]); };
	for (int k = 0; k < D; ++k) {
		if (!periodic[k]) continue;
		require(std::isfinite(low[k]) && std::isfinite(high[k]) && high[k] > low[k] && std::isfinite(length(k)),
			"a periodic cell must have finite sides with low < high along " + name(k), Vec<2>{ low[k], high[k] },
			"give low and high in this order");
	}
	if (!sheared()) return;
	const auto is_periodic_axis = [&](int k) { return k >= 0 && k < D && periodic[k]; };
	require(is_periodic_axis(across) && is_periodic_axis(along) && across != along,
		"a sheared cell needs two different periodic axes, across and along, from 0 for x to " + std::to_string(D - 1),
		std::to_string(across) + " and " + std::to_string(along), "make both axes periodic, or set across to -1 for no shear");
	require(std::isfinite(offset) && std::isfinite(rate) && std::isfinite(growth),
		"offset, rate and growth of a sheared cell must be finite", Vec<3>{ offset, rate, growth }, "correct them");
}

static_assert(std::is_trivially_copyable_v<Cell<2>> && std::is_trivially_copyable_v<Cell<3>>);

}  // namespace graindrive::geometry
