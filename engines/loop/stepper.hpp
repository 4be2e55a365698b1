/// The loop itself: search, pair forces and motion of a scene, step after step, the same bits on any number of threads.
#pragma once
#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "engines/loop/books.hpp"
#include "engines/loop/budgets.hpp"
#include "engines/loop/disks/disk_neighbours.hpp"
#include "engines/loop/rigid_bodies.hpp"
#include "engines/loop/running_guards.hpp"
#include "engines/loop/spheres/sphere_neighbours.hpp"
#include "engines/loop/thread_team.hpp"

namespace graindrive::loop {

template <int D>
using Neighbours = std::conditional_t<D == 2, DiskNeighbours, SphereNeighbours>;

/// Over disks (D = 2) or spheres (D = 3).
template <int D>
class Stepper {
public:
	/// @throws std::invalid_argument for a scene that cannot be run: says which number, the rule and the way out
	/// The time step must be stable at the largest overlap that `guards` allow.
	explicit Stepper(const Scene<D>& scene, const Guards<D>& guards = {});
	Stepper(const Stepper&) = delete;

	/// Goes n steps on. @throws std::runtime_error when a guard trips, with step, grain and likely cause
	void step(long n = 1);

	/// Computes the contacts of bodies at the present positions, before anything moves: `bodies()` then hold their forces and
	/// `touches_on` tells their contacts. The next step goes on from there, with velocities of bodies as they are then.
	void compute_body_forces();
	bool step_under_way() const { return body_forces_known; }
	/// Forgets them, as if they had not been computed.
	void take_back_body_forces();

	/// For velocities given on the step, not half a step behind: takes the first half kick (springs are left as they are).
	void begin_on_step();

	/// Writes the complete state and a text of the caller into one file (see checkpoint.hpp).
	void save(const std::string& path, const std::string& companion = "");
	/// A loop that continues as the saved one would have, to the last bit, on any number of threads.
	static std::unique_ptr<Stepper> restore(const std::string& path, int threads = 1, std::string* companion = nullptr);

	long steps_done() const { return state.steps; }
	double time() const { return state.steps * state.scene.dt; }
	const Scene<D>& settings() const { return state.scene; }
	double& target_fraction() { return state.scene.target_fraction; }
	std::vector<RigidBody<D>>& bodies() { return state.scene.bodies; }

	std::size_t size() const { return state.scene.grains.size(); }
	Grain<D> grain(std::size_t index) const;
	Vec<D> arm(std::size_t member) const;  ///< of a body's grain, from the body's place [m]
	void positions(double* to) const;      ///< size() times D numbers, in the order of `Scene::grains`
	void velocities(double* to) const;
	void spins(double* to) const;  ///< one number a grain in the plane, three in space
	/// Contacts of the last step, at its beginning; those at the present positions while a step is under way, or where pairs have been
	/// laid out anew since. Of spheres always those at the present positions: their kernels keep no forces of pairs.
	std::vector<Contact<D>> contacts();
	/// Contacts at the present positions, before anything moves: the forces that the next step will find, to the last bit.
	std::vector<Contact<D>> present_contacts();
	/// The same and `surface_contacts`, for someone who looks between steps: no step is then under way if none was before.
	struct Sight {
		std::vector<Contact<D>> pairs, surfaces;
	};
	Sight look_between_steps();
	/// Appends the contacts on a body, as of the last `compute_body_forces`; of disks also as of the last step.
	void touches_on(std::size_t body, std::vector<Touch<D>>& touches) const;

	/// External forces on free grains, from the next step until they are set again; those on bodies are in `bodies()`.
	void set_pushes(std::vector<Push<D>> on_grains);
	/// Gives a grain another place, velocity and spin, between two steps.
	void put(std::size_t index, const Grain<D>& grain);
	/// Gives a body and its members another velocity, between two steps.
	void set_velocity(std::size_t body, const Vec<D>& velocity, const Spin<D>& spin);
	/// Continues with law, friction, gravity, precision, threads and skin of `wanted`. Springs are kept if the kind of law does not change.
	/// @throws std::invalid_argument as the constructor, and for another physics while energy is tracked
	void change(const Scene<D>& wanted);

	std::vector<Spring<D>> springs() const;
	void set_springs(const std::vector<Spring<D>>& springs);  ///< before the first step
	void forget_springs();                                    ///< all contacts restart with a zero spring
	/// @throws std::invalid_argument where it exceeds the critical step
	void set_time_step(double dt);

	/// Adds the wall, or changes the one on its side. @throws std::invalid_argument naming the wall and the rule
	void set_wall(const Wall<D>& wall);
	void remove_wall(Side side);
	void set_surface_springs(const std::vector<SurfaceTouch<D>>& springs);  ///< before the first step
	const std::vector<SurfaceTouch<D>>& surface_springs() const { return state.touches; }
	/// `second` is the surface, in the order of walls, then solids; n points into it, and forces act on the grain.
	std::vector<Contact<D>> surface_contacts() const;

	/// Opens or closes the energy ledger; it costs a plain pass over all contacts at every step.
	void track_energy(bool on);
	const EnergyLedger<D>* energy_ledger() const { return books ? &books->ledger : nullptr; }
	EnergyLedger<D>* energy_ledger() { return books ? &books->ledger : nullptr; }

	/// How the cell flows in the step that comes; grains follow a change at once, each with its height.
	void set_flow(const Flow<D>& flow) { state.flow = flow; }
	/// A sheared cell as others have it now, where it may differ from what this loop has made of it.
	void follow_cell(const Cell<D>& cell);

	double kinetic_energy() const;    ///< of free grains, translation and rotation, at the half step [J]
	double kinetic_energy_on_step();  ///< the same with the velocities of the whole step [J]

	Processor processor_in_use() const { return pairs.processor(); }
	int pairs_at_once() const { return pairs.width(); }
	long searches_done() const { return state.searches; }
	long selections_done() const { return state.selections; }
	std::size_t pairs_selected() const { return pairs.counts().selected; }
	Guards<D>& guarding() { return state.guards; }
	/// What guards call the grains, by index, and the step that this loop began with; by default indices and 0.
	void speak_of(std::vector<int> names, long first_step) { speech = { std::move(names), first_step }; }

private:
	State<D> state;
	Neighbours<D> pairs{ state };
	Budgets<D> budgets{ state };
	RigidBodies<D> rigid{ state, pairs.motion() };
	Surfaces<D> surfaces{ state, pairs.motion() };
	Speech speech;
	RunningGuards<D> guards{ state, speech };
	std::unique_ptr<ThreadTeam> team;
	std::unique_ptr<Books<D>> books;
	std::vector<Spring<D>> given_springs;  // until the first search

	// Within a step.
	std::vector<char> thread_beyond;  // by thread: a block went beyond its limit
	std::exception_ptr failure;
	bool searching = false;
	bool moved_since_look = false;  // far enough for a search, or put elsewhere: guards look at all grains at once
	bool body_forces_known = false;
	std::vector<std::uint32_t> handed_over;  // rows in space that have been told the forces of surfaces and pushes
	bool laid_out_since_forces = false;
	double drifted = 0;  // for how long grains have moved since their forces were computed [s]

	void set_up();
	void arrange_rows();
	void use_whole_steps();
	void half_step(double spring_time, double drift);
	void run(const std::function<void(int)>& work);
	bool one_step(int rank, bool early_pairs_done);
	bool prepare(int rank);
	void look_before();
	void finish();
	void hand_outside_forces_over();
	void take_back_outside_forces();
	void change_flow();
	void kick_grain(std::uint32_t row, const Vec<D>& force, const Spin<D>& turning);
	void gather_body_forces();

	bool update_lists(int rank);
	void plan_lists();
	void begin_search();
	void wrap_into_cell();
	void finish_lists();

	State<D> snapshot();
	void go_back_to(const State<D>& before);
	void resume();

	double slipping_bound() const;
	bool slips(const ForceParts<D>& force, const Tangent<D>& remembered) const;
	Row<D> row_before(double time, std::uint32_t at) const;
	std::vector<Contact<D>> contacts_in_memory() const;
	double moved_since_forces(std::uint32_t candidate) const;
	double overlap_at_forces(std::uint32_t candidate) const;
	Contact<D> contact_of(std::uint32_t a, std::uint32_t b, const Vec<D>& force, const Tangent<D>& spring) const;
	void append_surface_touches(std::size_t body, std::vector<Touch<D>>& touches) const;
};

}  // namespace graindrive::loop
