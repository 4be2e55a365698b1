/// The energy ledger: where the energy of a scene is, where it came from and where it went, at the steps of the leapfrog.
///
/// In space the stored vectors of a contact turn with its normal. At step n, with positions x_n and the forces there, the leapfrog's velocities v- = v_{n-1/2} and v+ = v_{n+1/2} obey exactly
///
///   K_n = sum 1/2 m v-.v+,   K_n - K_{n-1} = sum 1/2 F_{n-1}.v dt + 1/2 F_n.v dt,  v = v_{n-1/2} that of the interval between them
///
/// whose sum over steps is the drives' sum F.(v- + v+)/2 dt. Every force is split into its parts and every part's power booked so.
///   elastic        of the closed form: U_n of the law's `terms`, for Hertz 2/5 K_n sqrt(R_eff) delta^{5/2}; U_t = 1/2 k_t s^2
///   damping        by the dashpots' forces, at the velocities that they were computed with
///                  (the tangential one while the contact sticks)
///   friction       the work of the tangential force where Coulomb's bound is active, less what the spring takes up, (k_t s)_mean Delta s.
///                  A shortened spring and its dashpot together are the bound, so their shares in it mean nothing
///   stiffening     1/2 s_{n-1} s_n (k_n - k_{n-1}): Hertz's k_t grows with delta, so a stretched spring gains and loses energy with the
///                  load although no force does work. The law is not conservative in this; the term can have either sign.
///   opening        1/2 k_t s^2 of contacts that part while their spring is stretched
///   work           of driven degrees of freedom, walls, loads and forces from outside on the grains, and of a cell that deforms: by
///                  contacts across its side, F on the owner times the velocity of the partner's image against the partner; by
///                  grains that are wrapped, 1/2 m (v'^2 - v^2); by what a change of the flow gives all grains at once
///   time step      an elastic force's work in steps is not exactly its closed form, most of all in the steps in which a contact begins
///                  and ends; that difference, and a contact's turning between two steps, contact by contact: what leapfrog itself adds
/// No entry is computed as the remainder of the others: forces are computed again from the motion, and `residual` is the energy that
/// the sum of all entries does not explain. It is round-off unless a force, a spring or a grain is wrong; the error of the time step
/// has its own entry.
#pragma once
#include <cstdint>
#include <vector>

#include "engines/loop/pair_geometry.hpp"

namespace graindrive::loop {

/// A part of a work that belongs to the interval before the step, and one that belongs to the next.
struct Halves {
	double before = 0, after = 0;
};

/// A contact at a step: with the velocities before and after it.
template <int D>
struct MetContact {
	std::uint64_t key;  ///< of the pair
	double overlap, effective_radius, effective_mass;
	Vec<D> n;                      ///< the step's normal
	double v_n_before, v_n_after;  ///< at the step's normal
	Tangent<D> v_t_before, v_t_after;
	Tangent<D> slip_before;            ///< tangential spring that the step began with
	Vec<D> image_before, image_after;  ///< velocity of the second one's image against itself, in a sheared cell [m/s]
};

/// All that is no contact.
struct LedgerMotion {
	double translation = 0, rotation = 0, potential = 0;  ///< [J]
	Halves falling;                                       ///< change of potential along periodic axes
	Halves walls, loads;                                  ///< work on the grains
	Halves cell;                                          ///< by what a change of the flow gives all grains at once
	std::vector<Halves> bodies;
};

/// The entries, in J, since the ledger was opened; energies are those of the last step.
struct Energies {
	double translation = 0, rotation = 0, elastic_normal = 0, elastic_tangential = 0, potential = 0;
	double normal_damping = 0, tangential_damping = 0, friction = 0, opening = 0;  ///< dissipated
	double stiffening = 0;                                                         ///< given to springs by the load
	double work_of_bodies = 0, work_of_walls = 0, work_of_loads = 0;
	double work_of_cell = 0;  ///< of a cell that deforms: V sum of stress times velocity gradient
	double initial = 0;       ///< sum of the energies when the ledger was opened
	double turnover = 0;      ///< sum of the |changes| of all entries
	double time_step = 0;     ///< given by the leapfrog itself

	double stored() const { return translation + rotation + elastic_normal + elastic_tangential + potential; }
	double residual() const
	{
		return stored() + normal_damping + tangential_damping + friction + opening - stiffening - work_of_bodies - work_of_walls -
		       work_of_loads - work_of_cell - time_step - initial;
	}
};

template <int D>
class EnergyLedger {
public:
	EnergyLedger(const ContactLaw& law, bool friction, double dt) : law(law), with_friction(friction), dt(dt) {}

	/// Books one step. Sorts the contacts by key, so that sums do not depend on where they lie.
	void book(std::vector<MetContact<D>>& contacts, const LedgerMotion& motion);

	/// A grain is wrapped across a sheared side and continues as its image, whose higher velocity comes from the cell.
	void see_from_image(double inverse_mass, const Vec<D>& velocity, const Vec<D>& of_image)
	{
		if (steps == 0) return;  // the energy that the ledger opens with is yet to come
		const double given = (geometry::squared_norm(of_image) - geometry::squared_norm(velocity)) / (2 * inverse_mass);
		now.work_of_cell += given, now.turnover += std::abs(given);
	}

	/// From here on the ledger explains the motion by another law; for tests of the ledger itself.
	void suppose(const ContactLaw& other) { law = other; }

	const Energies& energies() const { return now; }
	const std::vector<double>& work_by_body() const { return body_work; }
	long steps_booked() const { return steps; }

	template <class Visitor>
	void visit(Visitor&& visit)
	{
		visit_law(visit, law);
		visit(with_friction), visit(dt), visit(steps), visit(now), visit(past), visit(body_work), visit(pending),
			visit(pending_bodies), visit(fallen);
	}

private:
	/// Data of a contact for the next step.
	struct Past {
		std::uint64_t key;
		Vec<D> n;
		Tangent<D> spring_force;  // T
		double stiffness;         // k_t
		Tangent<D> slip;          // s
		Tangent<D> moved_after;   // v_t+ dt
		double elastic_after;     // half of the normal spring's work in the coming interval
	};
	struct Pending {
		double normal_damping = 0, tangential_damping = 0, falling = 0, walls = 0, loads = 0, cell = 0;
	};

	ContactLaw law;
	bool with_friction;
	double dt;
	long steps = 0;
	Energies now;
	std::vector<Past> past;
	std::vector<double> body_work, pending_bodies;
	Pending pending;
	double fallen = 0;

	struct Sums;
	Past meet(const MetContact<D>& contact, const Past& before, Sums& sums) const;
	static Past turned(Past before, const Vec<D>& n);
	void part(const Past& before, Sums& sums) const;
};

}  // namespace graindrive::loop
