/// What is summed at every point of a field while a run goes, and the fields that the sums tell.
///
/// Velocities enter as weighted running means and sums of squared deviations (West, Comm. ACM 22, 532 (1979)), so a small temperature on
/// a large mean velocity survives any number of frames. Sums over frames and grains k, with the kernel's shares phi_k:
///
///   area fraction   Phi = sum phi_k/frames                                    Kumar et al. (A6), Tripura et al. (3.1)
///   density         rho = sum phi_k m_k/(pi R_k^2)/frames                     [kg/m^2]
///   velocity        v = sum phi_k v_k/sum phi_k                               (A3), (A4), (3.2)
///   temperature     T = sum phi_k |v_k - v|^2/2/sum phi_k                     (A7), v the mean over all frames
///   contact stress  sum_c F_a b_b int_0^1 W ds/frames                         (3.3), Guillard et al. (A3)
///   kinetic stress  sum_k m_k/(pi R_k^2) phi_k (v_k - u)_a (v_k - u)_b/frames, u the mean velocity weighted by mass
///
/// F is the force on the far end of the branch vector b: stress is positive in compression, P = tr/2 as Tripura et al., Eq. (3.4).
#pragma once
#include "engines/measures/field_kernels.hpp"

namespace graindrive {

/// A grain as a field sees it, relative to the window's origin and, if asked for, to its velocity.
struct FieldGrain {
	Vector2r position, velocity;  ///< [m], [m/s]
	Real spin, radius, mass;      ///< [rad/s], [m], [kg]
};

/// The line along which a contact carries momentum, and the force on its far end.
struct FieldContact {
	Vector2r from, branch, force;  ///< [m], [m], [N]
};

/// What decides where and how is averaged.
struct FieldPlan {
	FieldGrid grid;
	FieldKernel kernel;
	Vector2r periods;  ///< [m], 0 where not periodic
	bool stress;
};

/// Places of the sums at one point; those from `momentum` on exist with stress only.
struct FieldSum {
	enum Place { area, density, velocity = 2, square = 4, momentum = 5, kinetic = 7, contact = 10, all = 14 };
};

constexpr int sums_at_a_point(bool stress) { return stress ? FieldSum::all : FieldSum::momentum; }

/// Adds a grain, in all its periodic images, to the sums of every point of the grid.
void add_grain(const FieldPlan& plan, const FieldGrain& grain, Real* sums);

/// Adds a contact's F_a b_b int W ds, in all its periodic images.
void add_contact(const FieldPlan& plan, const FieldContact& contact, Real* sums);

/// The fields at one point; not a number where no grain ever was (velocity, temperature) or no sample was taken (all).
struct FieldMeans {
	Real area_fraction, density, temperature;
	Vector2r velocity;
	Eigen::Matrix<Real, 2, 2> contact_stress, kinetic_stress;  ///< [N/m], positive in compression
};

/// The fields that the sums at one point tell after so many samples; without samples the sums are not read.
FieldMeans means_at(const Real* sums, Real samples, bool stress);

}  // namespace graindrive
