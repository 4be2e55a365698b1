/// The averaging kernels: how a grain and a contact's line are shared out among the points of a grid.
///
/// A grain's share at a point is the fraction of area, in three dimensions of volume, that it adds there; a line's share is
/// int_0^1 W(point - x(s)) ds [1/m^D]. Every kernel integrates to 1 over the plane or over space, so shares times the area or volume of a
/// bin add up to the grain's. Kernels on a grid that is averaged along an axis add the mean over that axis.
#pragma once
#include <boost/math/special_functions/gamma.hpp>
#include <variant>
#include <vector>

#include "engines/measures/averaged_kernels.hpp"
#include "engines/measures/ball_overlap.hpp"
#include "engines/measures/disk_square_overlap.hpp"
#include "engines/measures/field_grid.hpp"
#include "engines/measures/line_integrals.hpp"

namespace graindrive {

/// Exact area of a disk inside a square bin: Kumar, Dhiman, Reddy 2019, Eqs (A3), (A4), (A6), who count 100 sub-bins. In the plane only.
///
/// `lever` is the centroid of the overlap from the grain's centre, so that v + omega x lever is the mean velocity of the part of
/// the grain that lies in the bin, exactly; the paper takes the bin's centre there, which may lie outside the grain.
struct DiskBinKernel {
	Real reach(Real radius) const { return radius; }

	template <class Add>
	void grain(const FieldGrid<2>& grid, const Vector2r& at, Real radius, Add&& add) const
	{
		const Real bin_area = grid.spacing * grid.spacing;
		const Vector2r size(radius, radius), side(grid.spacing, grid.spacing);
		grid.visit_bins(at - size, at + size, [&](const auto& place) {
			const Vector2r low = grid.corner(place) - at;
			const Overlap overlap = disk_square_overlap(radius, low, low + side);
			if (overlap.area > 0) add(grid.point(place), overlap.area / bin_area, overlap.moment / overlap.area);
		});
	}

	template <class Add>
	void line(const FieldGrid<2>& grid, const Vector2r& from, const Vector2r& branch, Add&& add) const
	{
		const Real bin_area = grid.spacing * grid.spacing;
		const Vector2r to = from + branch, side(grid.spacing, grid.spacing);
		grid.visit_bins(from.cwiseMin(to), from.cwiseMax(to), [&](const auto& place) {
			const Vector2r low = grid.corner(place);
			const Real fraction = fraction_in_box<Vector2r>(from, branch, low, low + side);
			if (fraction > 0) add(grid.point(place), fraction / bin_area);
		});
	}
};

/// Calls add(point, share, lever 0) where share(distance of the point from the grain) > 0.
template <int D, class Share, class Add>
void share_by_distance(
	const FieldGrid<D>& grid, const Eigen::Matrix<Real, D, 1>& at, Real reach, const Share& share, const Add& add)
{
	using Vector = Eigen::Matrix<Real, D, 1>;
	const Vector size = Vector::Constant(reach);
	grid.visit_bins(at - size, at + size, [&](const auto& place) {
		const Real part = share((grid.centre(place) - at).norm());
		if (part > 0) add(grid.point(place), part, Vector(Vector::Zero()));
	});
}

/// Calls add(point, factor integral) where integral(point) of a line > 0.
template <int D, class Integral, class Add>
void share_line(const FieldGrid<D>& grid, const Eigen::Matrix<Real, D, 1>& from, const Eigen::Matrix<Real, D, 1>& branch,
	Real reach, const Integral& integral, const Add& add)
{
	using Vector = Eigen::Matrix<Real, D, 1>;
	const Vector to = from + branch, size = Vector::Constant(reach);
	grid.visit_bins(from.cwiseMin(to) - size, from.cwiseMax(to) + size, [&](const auto& place) {
		const Real part = integral(Vector(grid.centre(place)));
		if (part > 0) add(grid.point(place), part);
	});
}

/// W(r) = exp(-r^2/w^2)/N for r < c w, else 0: Tripura et al., Eq. (3.5), cut as they cut it.
///
/// N makes the cut kernel integrate to 1, so that no area is lost: pi w^2 (1 - exp(-c^2)) in the plane (1.00012 of the whole for c = 3),
/// pi^(3/2) w^3 (erf(c) - 2 c exp(-c^2)/sqrt(pi)) in space, which is the incomplete gamma function P(3/2, c^2). On a grid the sum of the
/// shares differs from the integral by the kernel's step at the cut, exp(-c^2) of its peak: 1e-5 of the area for spacing w/2.
template <int D>
struct GaussianKernel {
	using Vector = Eigen::Matrix<Real, D, 1>;
	Real width;   ///< w [m]
	Real cutoff;  ///< c [w]

	Real radius() const { return cutoff * width; }
	Real reach(Real) const { return radius(); }
	Real norm() const
	{
		if constexpr (D == 2) return 1 / (pi * width * width * -std::expm1(-cutoff * cutoff));
		const Real whole = std::sqrt(pi) * width;
		return 1 / (whole * whole * whole * boost::math::gamma_p(Real(1.5), cutoff * cutoff));
	}

	template <class Add>
	void grain(const FieldGrid<D>& grid, const Vector& at, Real grain_radius, Add&& add) const
	{
		const Real share = ball_volume<D>(grain_radius) * norm(), square_radius = radius() * radius();
		const Vector size = Vector::Constant(radius());
		typename FieldGrid<D>::Place row;
		row.fill(-1);
		Real square_across = 0, row_share = 0;
		grid.visit_bins(at - size, at + size, [&](const auto& place) {
			const Vector away = grid.centre(place) - at;
			if (!std::equal(row.begin() + 1, row.end(), place.begin() + 1)) {
				row = place;
				square_across = away.template tail<D - 1>().squaredNorm();
				row_share = share * std::exp(-square_across / (width * width));
			}
			const Real square_x = away[0] * away[0];
			if (square_x + square_across >= square_radius) return;
			add(grid.point(place), row_share * std::exp(-square_x / (width * width)), Vector(Vector::Zero()));
		});
	}

	template <class Add>
	void line(const FieldGrid<D>& grid, const Vector& from, const Vector& branch, Add&& add) const
	{
		const Real factor = norm();
		share_line<D>(
			grid, from, branch, radius(),
			[&](const Vector& point) { return factor * gaussian_along_line<Vector>(from, branch, point, width, radius()); }, add);
	}
};

/// The part of a grain inside a sphere (in two dimensions a disk) about the point, over the sphere's: Guillard et al. 2014, (A2), (A3).
///
/// (A2) gives the whole grain's volume to grains inside and none to those outside; between, the exact overlap.
template <int D>
struct SphereKernel {
	using Vector = Eigen::Matrix<Real, D, 1>;
	Real radius;  ///< [m]

	Real reach(Real grain_radius) const { return radius + grain_radius; }

	template <class Add>
	void grain(const FieldGrid<D>& grid, const Vector& at, Real grain_radius, Add&& add) const
	{
		const auto share = [&](Real distance) {
			return ball_overlap<D>(grain_radius, radius, distance) / ball_volume<D>(radius);
		};
		share_by_distance<D>(grid, at, reach(grain_radius), share, add);
	}

	template <class Add>
	void line(const FieldGrid<D>& grid, const Vector& from, const Vector& branch, Add&& add) const
	{
		share_line<D>(
			grid, from, branch, radius,
			[&](const Vector& point) { return fraction_in_sphere<Vector>(from, branch, point, radius) / ball_volume<D>(radius); },
			add);
	}
};

/// The Gaussian of space, averaged over one axis of the grid: positions and lines lie in the middle of that axis.
struct AveragedGaussianKernel {
	GaussianKernel<3> whole;

	Real reach(Real) const { return whole.radius(); }

	template <class Add>
	void grain(const FieldGrid<3>& grid, const Vector3r& at, Real grain_radius, Add&& add) const
	{
		const Real factor = ball_volume<3>(grain_radius) * whole.norm() / grid.length;
		const auto share = [&](Real rho) { return factor * gaussian_along_axis(rho * rho, whole.width, whole.cutoff); };
		share_by_distance<3>(grid, at, whole.radius(), share, add);
	}

	template <class Add>
	void line(const FieldGrid<3>& grid, const Vector3r& from, const Vector3r& branch, Add&& add) const
	{
		const Real factor = whole.norm() / grid.length;
		share_line<3>(
			grid, from, branch, whole.radius(),
			[&](const Vector3r& point) {
				return factor * mean_gaussian_along_axis(from, branch, point, whole.width, whole.cutoff);
			},
			add);
	}
};

/// Spheres about all points of a line along one axis of the grid: positions and lines lie in the middle of that axis.
struct AveragedSphereKernel {
	Real radius;  ///< [m]

	Real reach(Real grain_radius) const { return radius + grain_radius; }

	template <class Add>
	void grain(const FieldGrid<3>& grid, const Vector3r& at, Real grain_radius, Add&& add) const
	{
		const Real factor = 1 / (ball_volume<3>(radius) * grid.length);
		const auto share = [&](Real rho) { return factor * sphere_overlap_along_axis(grain_radius, radius, rho); };
		share_by_distance<3>(grid, at, reach(grain_radius), share, add);
	}

	template <class Add>
	void line(const FieldGrid<3>& grid, const Vector3r& from, const Vector3r& branch, Add&& add) const
	{
		const Real factor = 1 / (ball_volume<3>(radius) * grid.length);
		share_line<3>(
			grid, from, branch, radius,
			[&](const Vector3r& point) { return factor * mean_chord_along_axis(from, branch, point, radius); }, add);
	}
};

template <int D>
struct KernelsOf;
template <>
struct KernelsOf<2> {
	using type = std::variant<DiskBinKernel, GaussianKernel<2>, SphereKernel<2>>;
};
template <>
struct KernelsOf<3> {
	using type = std::variant<GaussianKernel<3>, SphereKernel<3>, AveragedGaussianKernel, AveragedSphereKernel>;
};
/// Any of the kernels of two or three dimensions.
template <int D>
using FieldKernel = typename KernelsOf<D>::type;

}  // namespace graindrive
