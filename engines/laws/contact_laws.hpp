/// Contact laws as pure functions of one contact: Hertz with history, Hertz with restitution damping, linear spring-dashpot.
///
/// A law sees the kinematics of one contact and the tangential spring carried from the step before, and returns the forces
/// and the new spring. It knows no bodies and keeps no state, so YADE's functors, GrainLoop and the tests all call this code.
///
/// `S` is the scalar (double, float or a SIMD pack), `T` the tangential vector: a signed `S` along t = z x n in two
/// dimensions, `Vector3r` in three. `n` points from the grain that the force acts on (i) to its partner (j).
///
/// Signs: normal force F_n > 0 repels. v_n > 0 separates (v_n = -d(overlap)/dt). v_t is the velocity of i's surface relative
/// to j's in the tangent plane; the tangential force on i is returned with its sign, i.e. opposing slip.
#pragma once
#include <cmath>

#include "engines/base/branchless.hpp"

namespace graindrive::laws {

/// What a law is told about one contact at one step.
template <class S, class T>
struct Kinematics {
	S overlap;              ///< delta = R_i + R_j - r_ij [m], > 0
	S normal_velocity;      ///< v_n, > 0 when separating [m/s]
	T tangential_velocity;  ///< v_t of i's surface against j's [m/s]
	S effective_radius;     ///< R_i R_j / (R_i + R_j) [m]
	S effective_mass;       ///< m_i m_j / (m_i + m_j) [kg]
	S dt;                   ///< time step [s]
};

/// What a law answers: forces on grain i, and the tangential spring to carry to the next step.
template <class S, class T, class Mask>
struct Response {
	S normal;       ///< F_n, along -n on i [N]
	T tangential;   ///< F_t on i [N]
	T slip;         ///< tangential spring s [m], to be kept with the contact; YADE's own laws keep a force [N], see yade_laws.hpp
	Mask slipping;  ///< true where Coulomb's bound was active
};

/// Brilliantov-Silbert law (LAMMPS `gran/hertz/history`): the Magnus and wiggle papers' Eqs (2.1), (2.2).
///
///   F_n = sqrt(R_eff delta) (K_n delta - m_eff gamma_n v_n)
///   F_t = -min(mu |F_n|, sqrt(R_eff delta) |K_t s + m_eff gamma_t v_t|) t
///
/// Brilliantov et al., Phys. Rev. E 53, 5382 (1996); Silbert et al., Phys. Rev. E 64, 051302 (2001). F_n may attract at the
/// end of an impact: the papers and LAMMPS do not cut it. A slipping spring is shortened so that spring and dashpot together
/// give the bound. Cutting comes before the factor sqrt(R_eff delta), common to both sides, which saves a division.
template <class P = Real>
struct HertzHistory {
	static constexpr bool acts_at_contact_point = false, remembers_force = false;

	P k_n;      ///< normal stiffness K_n [Pa]
	P k_t;      ///< tangential stiffness K_t [Pa], > 0
	P gamma_n;  ///< normal damping [1/(m s)]
	P gamma_t;  ///< tangential damping [1/(m s)]
	P mu;       ///< friction coefficient [-]

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& slip) const
	{
		using std::abs;
		using std::sqrt;
		const S hertz = sqrt(c.effective_radius * c.overlap);
		const S normal = k_n * c.overlap - c.effective_mass * gamma_n * c.normal_velocity;
		const T dashpot = (c.effective_mass * gamma_t) * c.tangential_velocity;
		const T spring = slip + c.tangential_velocity * c.dt;
		const auto bound = truncated(T(-(k_t * spring + dashpot)), S(mu * abs(normal)));
		const T shortened = (bound.value + dashpot) * (S(-1) / k_t);
		return Response<S, T, decltype(bound.cut)>{ hertz * normal, hertz * bound.value, select(bound.cut, shortened, spring),
			bound.cut };
	}
};

/// Hertz-Mindlin law with damping set by the coefficient of restitution: Guillard, Forterre, Pouliquen,
/// Phys. Fluids 26, 043301 (2014), Eq. (A1) and Table I.
///
///   F_n = k* delta^(3/2) - g_n delta^(1/4) v_n,                  k*   = (4/3) E_eff sqrt(R_eff), g_n = sqrt(5) b sqrt(m_eff k*)
///   F_t = -(k*_t delta^(1/2) s + g_t delta^(1/4) v_t), <= mu |F_n|,  k*_t = c k*,               g_t = sqrt(10/3) b sqrt(m_eff k*_t)
///
/// with E_eff = E/(2(1-nu^2)), c = 3(1-nu)/(2-nu) and b = -ln e/sqrt(ln^2 e + pi^2). Both columns of Table I are this one
/// formula: R_eff = d/4, m_eff = m/2 for two grains, R_eff = d/2, m_eff = m for a grain on the cylinder (a plane). In the
/// table's cylinder column the k*_n under the root is the grains' one (only that gives the printed 0.26 kg s^-1 m^-1/4).
/// The table writes gamma_t over delta_t^(1/4); the stiffness it damps grows as sqrt(delta_n), so a damping that stays a
/// constant fraction of critical needs delta_n, which is the reading here (LIGGGHTS takes the same).
template <class P = Real>
struct HertzRestitution {
	static constexpr bool acts_at_contact_point = false, remembers_force = false;

	P effective_young;   ///< E_eff = E / (2 (1 - nu^2)) [Pa]
	P tangential_ratio;  ///< c = k*_t / k*_n [-], > 0
	P damping_fraction;  ///< b, fraction of critical damping [-]
	P mu;                ///< friction coefficient [-]

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& slip) const
	{
		using std::abs;
		using std::sqrt;
		const S k_n = (effective_young * (4.0 / 3.0)) * sqrt(c.effective_radius);
		const S k_t = tangential_ratio * k_n;
		const S root = sqrt(c.overlap);
		const S fourth_root = sqrt(root);
		const S g_n = (damping_fraction * std::sqrt(5.0)) * sqrt(c.effective_mass * k_n);
		const S g_t = (damping_fraction * std::sqrt(10.0 / 3.0)) * sqrt(c.effective_mass * k_t);
		const S stiffness = k_t * root;
		const S normal = k_n * c.overlap * root - g_n * fourth_root * c.normal_velocity;
		const T dashpot = (g_t * fourth_root) * c.tangential_velocity;
		const T spring = slip + c.tangential_velocity * c.dt;
		const auto bound = truncated(T(-(stiffness * spring + dashpot)), S(mu * abs(normal)));
		const T shortened = (bound.value + dashpot) * (S(-1) / stiffness);
		return Response<S, T, decltype(bound.cut)>{ normal, bound.value, select(bound.cut, shortened, spring), bound.cut };
	}
};

/// Linear spring-dashpot with a spring that is integrated only while the contact sticks: Oba, Otsuki (2025).
///
///   F_n = k_n delta - eta_n v_n,  F_t = -(k_t s + eta_t v_t), cut at mu F_n,  ds/dt = v_t while sticking, else 0
///   eta = -2 ln e sqrt(m_eff k_n / (pi^2 + ln^2 e))
template <class P = Real>
struct SpringDashpot {
	static constexpr bool acts_at_contact_point = false, remembers_force = false;

	P k_n;      ///< normal stiffness [N/m]
	P k_t;      ///< tangential stiffness [N/m]
	P damping;  ///< eta / sqrt(m_eff): -2 ln e sqrt(k_n / (pi^2 + ln^2 e)) [kg^1/2 s^-1], see `spring_dashpot`
	P mu;       ///< friction coefficient [-]

	template <class S, class T>
	auto operator()(const Kinematics<S, T>& c, const T& slip) const
	{
		using std::abs;
		using std::sqrt;
		const S eta = damping * sqrt(c.effective_mass);
		const S normal = k_n * c.overlap - eta * c.normal_velocity;
		const T spring = slip + c.tangential_velocity * c.dt;
		const auto bound = truncated(T(-(k_t * spring + eta * c.tangential_velocity)), S(mu * abs(normal)));
		return Response<S, T, decltype(bound.cut)>{ normal, bound.value, select(bound.cut, slip, spring), bound.cut };
	}
};

/// b = -ln e / sqrt(ln^2 e + pi^2): fraction of critical damping of a linear contact with restitution e in (0, 1].
Real damping_fraction(Real restitution);

/// Hertz-Mindlin grains of one material: Young's modulus [Pa], Poisson's ratio, restitution, friction (Guillard Table I).
/// @throws std::invalid_argument for a value out of range
HertzRestitution<Real> hertz_restitution(Real young, Real poisson, Real restitution, Real mu);

/// Spring-dashpot from stiffnesses [N/m] and restitution in (0, 1].
/// @throws std::invalid_argument for a value out of range
SpringDashpot<Real> spring_dashpot(Real k_n, Real k_t, Real restitution, Real mu);

}  // namespace graindrive::laws
