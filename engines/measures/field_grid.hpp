/// The grid of a field: bins with a point in the middle of each, and the periodic images that its window sees.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "engines/base/real.hpp"

namespace graindrive {

/// Calls visit(place) for every place of the box from `first` to `last`, both counted; the first axis runs fastest.
template <class Number, std::size_t D, class Visit>
void visit_places(const std::array<Number, D>& first, const std::array<Number, D>& last, Visit&& visit)
{
	for (std::size_t k = 0; k < D; ++k)
		if (!(first[k] <= last[k])) return;
	std::array<Number, D> at = first;
	for (std::size_t k = 0; k < D;) {
		visit(at);
		for (k = 0; k < D && ++at[k] > last[k]; ++k) at[k] = first[k];
	}
}

/// Squares or cubes of one size from `low` on; bin (i, j, k) is point number (k ny + j) nx + i. Positions are relative to the window's
/// origin. Along an axis that fields are averaged over there is one bin, as long as the window.
template <int D>
struct FieldGrid {
	using Vector = Eigen::Matrix<Real, D, 1>;
	using Place = std::array<int, D>;

	Vector low = Vector::Zero();  ///< lower left corner of the window [m]
	Real spacing = 1;             ///< [m]
	Place bins{};                 ///< number of bins along each axis
	int averaged = -1;            ///< axis that fields are averaged over; -1: none
	Real length = 0;              ///< of the window along that axis [m]

	int size() const
	{
		int all = 1;
		for (const int n : bins) all *= n;
		return all;
	}
	int point(const Place& place) const
	{
		int number = place[D - 1];
		for (int k = D - 2; k >= 0; --k) number = number * bins[k] + place[k];
		return number;
	}
	Place place(int point) const
	{
		Place at;
		for (int k = 0; k < D; point /= bins[k], ++k) at[k] = point % bins[k];
		return at;
	}
	Real edge(int axis) const { return axis == averaged ? length : spacing; }
	Vector corner(const Place& place) const { return offset(place, 0); }
	Vector centre(const Place& place) const { return offset(place, Real(0.5)); }
	Vector high() const { return corner(bins); }

	/// Calls visit(place) for the bins that the box from `from` to `to` meets, the first axis fastest.
	template <class Visit>
	void visit_bins(const Vector& from, const Vector& to, Visit&& visit) const
	{
		const auto bin = [&](Real x, int axis) {
			return int(std::clamp(std::floor((x - low[axis]) / edge(axis)), Real(-1), Real(bins[axis])));
		};
		Place first, last;
		for (int k = 0; k < D; ++k) {
			first[k] = std::max(bin(from[k], k), 0);
			last[k] = std::min(bin(to[k], k), bins[k] - 1);
		}
		visit_places(first, last, visit);
	}

	/// Calls visit(shift) for every multiple of the periods that brings the box centre +- reach into the window.
	template <class Visit>
	void visit_images(const Vector& centre, const Vector& reach, const Vector& periods, Visit&& visit) const
	{
		const Vector top = high();
		std::array<Real, D> first, last;
		for (int k = 0; k < D; ++k) {
			const Real least = low[k] - reach[k] - centre[k], most = top[k] + reach[k] - centre[k];
			first[k] = periods[k] > 0 ? std::ceil(least / periods[k]) : least <= 0 ? 0 : 1;
			last[k] = periods[k] > 0 ? std::floor(most / periods[k]) : most >= 0 ? 0 : -1;
		}
		visit_places(first, last,
			[&](const std::array<Real, D>& windings) { visit(Vector(Vector::Map(windings.data()).cwiseProduct(periods))); });
	}

private:
	/// The corner of a bin, or what lies a part of a bin further along every axis.
	Vector offset(const Place& place, Real part) const
	{
		Vector bins_away;
		for (int k = 0; k < D; ++k) bins_away[k] = place[k] + part;
		Vector at = low + spacing * bins_away;
		if (averaged >= 0) at[averaged] = low[averaged] + length * bins_away[averaged];
		return at;
	}
};

}  // namespace graindrive
