/// The three averaging kernels: how a grain and a contact's line are shared out among the points of a grid.
///
/// A grain's share at a point is the area fraction that it adds there; a line's share is int_0^1 W(point - x(s)) ds [1/m^2]. Every
/// kernel integrates to 1 over the plane, so shares times the area of a bin add up to the grain's area.
/// In three dimensions volumes take the place of areas in `grain`; `line` stays as it is.
#pragma once
#include <variant>
#include <vector>

#include "engines/measures/disk_disk_overlap.hpp"
#include "engines/measures/disk_square_overlap.hpp"
#include "engines/measures/field_grid.hpp"
#include "engines/measures/line_integrals.hpp"

namespace graindrive {

/// Exact area of a disk inside a square bin: Kumar, Dhiman, Reddy 2019, Eqs (A3), (A4), (A6), who count 100 sub-bins.
///
/// `lever` is the centroid of the overlap from the grain's centre, so that v + omega x lever is the mean velocity of the part of
/// the grain that lies in the bin, exactly; the paper takes the bin's centre there, which may lie outside the grain.
struct DiskBinKernel {
	Real reach(Real radius) const { return radius; }

	template <class Add>
	void grain(const FieldGrid& grid, const Vector2r& at, Real radius, Add&& add) const
	{
		const Real bin_area = grid.spacing * grid.spacing;
		const Vector2r size(radius, radius), side(grid.spacing, grid.spacing);
		grid.visit_bins(at - size, at + size, [&](int i, int j) {
			const Vector2r low = grid.corner(i, j) - at;
			const Overlap overlap = disk_square_overlap(radius, low, low + side);
			if (overlap.area > 0) add(j * grid.nx + i, overlap.area / bin_area, overlap.moment / overlap.area);
		});
	}

	template <class Add>
	void line(const FieldGrid& grid, const Vector2r& from, const Vector2r& branch, Add&& add) const
	{
		const Real bin_area = grid.spacing * grid.spacing;
		const Vector2r to = from + branch, side(grid.spacing, grid.spacing);
		grid.visit_bins(from.cwiseMin(to), from.cwiseMax(to), [&](int i, int j) {
			const Vector2r low = grid.corner(i, j);
			const Real fraction = fraction_in_box<Vector2r>(from, branch, low, low + side);
			if (fraction > 0) add(j * grid.nx + i, fraction / bin_area);
		});
	}
};

/// W(r) = exp(-r^2/w^2)/(pi w^2 (1 - exp(-c^2))) for r < c w, else 0: Tripura et al., Eq. (3.5), cut as they cut it.
///
/// The last factor makes the cut kernel integrate to 1 (1.00012 for c = 3), so that no area is lost. On a grid the sum of the
/// shares differs from the integral by the kernel's step at the cut, exp(-c^2) of its peak: 1e-5 of the area for spacing w/2.
struct GaussianKernel {
	Real width;   ///< w [m]
	Real cutoff;  ///< c [w]

	Real radius() const { return cutoff * width; }
	Real reach(Real) const { return radius(); }
	Real norm() const { return 1 / (pi * width * width * -std::expm1(-cutoff * cutoff)); }

	template <class Add>
	void grain(const FieldGrid& grid, const Vector2r& at, Real grain_radius, Add&& add) const
	{
		const Real share = pi * grain_radius * grain_radius * norm(), square_radius = radius() * radius();
		const Vector2r size(radius(), radius());
		int row = -1;
		Real square_y = 0, row_share = 0;
		grid.visit_bins(at - size, at + size, [&](int i, int j) {
			const Vector2r away = grid.centre(i, j) - at;
			if (j != row) row = j, square_y = away[1] * away[1], row_share = share * std::exp(-square_y / (width * width));
			const Real square_x = away[0] * away[0];
			if (square_x + square_y >= square_radius) return;
			add(j * grid.nx + i, row_share * std::exp(-square_x / (width * width)), Vector2r(Vector2r::Zero()));
		});
	}

	template <class Add>
	void line(const FieldGrid& grid, const Vector2r& from, const Vector2r& branch, Add&& add) const
	{
		const Vector2r to = from + branch, size(radius(), radius());
		const Real factor = norm();
		grid.visit_bins(from.cwiseMin(to) - size, from.cwiseMax(to) + size, [&](int i, int j) {
			const Real integral = gaussian_along_line<Vector2r>(from, branch, grid.centre(i, j), width, radius());
			if (integral > 0) add(j * grid.nx + i, factor * integral);
		});
	}
};

/// The part of a grain inside a sphere (in two dimensions a disk) about the point, over the sphere's: Guillard et al. 2014, (A2), (A3).
///
/// (A2) gives the whole grain's weight to grains inside and none to those outside; between, the exact overlap.
struct SphereKernel {
	Real radius;  ///< [m]

	Real reach(Real grain_radius) const { return radius + grain_radius; }

	template <class Add>
	void grain(const FieldGrid& grid, const Vector2r& at, Real grain_radius, Add&& add) const
	{
		const Vector2r size(reach(grain_radius), reach(grain_radius));
		grid.visit_bins(at - size, at + size, [&](int i, int j) {
			const Real overlap = disk_disk_overlap(grain_radius, radius, (grid.centre(i, j) - at).norm());
			if (overlap > 0) add(j * grid.nx + i, overlap / (pi * radius * radius), Vector2r(Vector2r::Zero()));
		});
	}

	template <class Add>
	void line(const FieldGrid& grid, const Vector2r& from, const Vector2r& branch, Add&& add) const
	{
		const Vector2r to = from + branch, size(radius, radius);
		grid.visit_bins(from.cwiseMin(to) - size, from.cwiseMax(to) + size, [&](int i, int j) {
			const Real fraction = fraction_in_sphere<Vector2r>(from, branch, grid.centre(i, j), radius);
			if (fraction > 0) add(j * grid.nx + i, fraction / (pi * radius * radius));
		});
	}
};

using FieldKernel = std::variant<DiskBinKernel, GaussianKernel, SphereKernel>;

}  // namespace graindrive
