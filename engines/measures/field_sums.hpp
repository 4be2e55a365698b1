/// The sums at every point of a field during a run, and the fields computed from them, in D = 2 or 3 dimensions.
///
/// Velocities enter as weighted running means and sums of squared deviations (West, Comm. ACM 22, 532 (1979)), so a small temperature on
/// a large mean velocity survives any number of frames. Sums over frames and grains k, with the kernel's shares phi_k:
///
///   area or solid fraction  Phi = sum phi_k/frames                            Kumar et al. (A6), Tripura et al. (3.1)
///   density         rho = sum phi_k m_k/V_k/frames, V_k = pi R_k^2 or 4/3 pi R_k^3    [kg/m^D]
///   velocity        v = sum phi_k v_k/sum phi_k                               (A3), (A4), (3.2), Guillard et al. (A2)
///   temperature     T = sum phi_k |v_k - v|^2/D/sum phi_k                     (A7), v the mean over all frames
///   contact stress  sum_c F_a b_b int_0^1 W ds/frames                         (3.3), Guillard et al. (A3)
///   kinetic stress  sum_k m_k/V_k phi_k (v_k - u)_a (v_k - u)_b/frames, u the mean velocity weighted by mass
///
/// F is the force on the far end of the branch vector b: stress is positive in compression, P = tr/D as Tripura et al., Eq. (3.4).
///
/// A grid may be averaged along one axis. All then counts that lies in the window along that axis, grains by their centres and lines by
/// their part, each with the kernel's integral over the whole axis: the mean over a whole period of the fields in space, exactly.
#pragma once
#include "engines/measures/field_kernels.hpp"

namespace graindrive {

/// A grain as a field sees it, relative to the window's origin and, if asked for, to its velocity.
template <int D>
struct FieldGrain {
	Eigen::Matrix<Real, D, 1> position, velocity;  ///< [m], [m/s]
	Real spin, radius, mass;                       ///< [rad/s], about z, read by 'diskBin' only; [m], [kg]
};

/// The line along which a contact carries momentum, and the force on its far end.
template <int D>
struct FieldContact {
	Eigen::Matrix<Real, D, 1> from, branch, force;  ///< [m], [m], [N]
};

/// What decides where and how is averaged.
template <int D>
struct FieldPlan {
	FieldGrid<D> grid;
	FieldKernel<D> kernel;
	Eigen::Matrix<Real, D, 1> periods;  ///< [m], 0 where not periodic
	bool stress;
};

/// Places of the sums at one point; those from `momentum` on exist with stress only. Kinetic stress is symmetric: its upper half by rows.
template <int D>
struct FieldSum {
	enum Place {
		fraction,
		density,
		velocity,
		square = velocity + D,
		momentum,
		kinetic = momentum + D,
		contact = kinetic + D * (D + 1) / 2,
		all = contact + D * D
	};
};

template <int D>
constexpr int sums_at_a_point(bool stress)
{
	return stress ? FieldSum<D>::all : FieldSum<D>::momentum;
}

/// Adds a grain, in all its periodic images, to the sums of every point of the grid.
template <int D>
void add_grain(const FieldPlan<D>& plan, const FieldGrain<D>& grain, Real* sums);

/// Adds a contact's F_a b_b int W ds, in all its periodic images.
template <int D>
void add_contact(const FieldPlan<D>& plan, const FieldContact<D>& contact, Real* sums);

/// The fields at one point; not a number where no grain ever was (velocity, temperature) or no sample was taken (all).
template <int D>
struct FieldMeans {
	Real fraction, density, temperature;  ///< of area or volume; [kg/m^D]; [m^2/s^2]
	Eigen::Matrix<Real, D, 1> velocity;
	Eigen::Matrix<Real, D, D> contact_stress, kinetic_stress;  ///< [N/m^(D - 1)], positive in compression
};

/// The fields computed from the sums at one point and the number of samples; without samples the sums are not read.
template <int D>
FieldMeans<D> means_at(const Real* sums, Real samples, bool stress);

}  // namespace graindrive
