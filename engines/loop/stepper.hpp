/// The loop itself: search, pair forces and motion of a scene, step after step, the same bits on any number of threads.
#pragma once
#include <array>
#include <exception>
#include <memory>
#include <string>

#include "engines/loop/energy_ledger.hpp"
#include "engines/loop/pair_geometry.hpp"
#include "engines/loop/pair_list.hpp"
#include "engines/loop/state.hpp"
#include "engines/loop/thread_team.hpp"

namespace graindrive::loop {

/// A contact, all of it at the moment of its forces: the beginning of the last step. Forces act on `first`; on `second` they are opposite.
struct Contact {
	std::uint32_t first, second;  ///< indices in `Scene::grains`
	double n_x, n_y;              ///< from first to second
	double point_x, point_y;      ///< on the surface of first [m]
	double normal, friction;      ///< F_n > 0 repels, F_t along z x n on first [N]
	double overlap;               ///< [m]
	double slip;                  ///< tangential spring [m], or the force [N] that YADE's own laws remember
	bool slipping;                ///< Coulomb's bound is active
};

/// The tangential spring of two grains, or what else the law remembers; its sign does not change when they change places.
struct Spring {
	std::uint32_t first, second;  ///< indices in `Scene::grains`
	double slip;                  ///< [m]; [N] with a law that remembers a force
};

/// A pair's force on its owner, -F_n n + F_t (z x n).
struct ForceParts {
	double normal, friction;  ///< F_n > 0 repels, F_t [N]
	double n_x, n_y;          ///< from the owner to its partner
};

/// One contact on a member of a rigid body.
struct Touch {
	std::uint32_t member, partner;  ///< indices in `Scene::grains`
	double arm_x,
		arm_y;  ///< from the body's centre to where the law's force acts: the member's surface, or half an overlap below [m]
	double n_x, n_y;          ///< from the member to its partner
	double normal, friction;  ///< F_n along -n on the member, F_t along z x n on the member [N]
	bool slipping;            ///< Coulomb's bound is active
};

class Stepper {
public:
	/// @throws std::invalid_argument for a scene that cannot be run: says which number, the rule and the way out
	explicit Stepper(const Scene& scene);
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

	/// Writes everything that decides how the run goes on, and a text of the caller's, into one file (see checkpoint.hpp).
	void save(const std::string& path, const std::string& companion = "");
	/// A loop that goes on as the saved one would have, to the last bit, on any number of threads.
	static std::unique_ptr<Stepper> restore(const std::string& path, int threads = 1, std::string* companion = nullptr);

	long steps_done() const { return state.steps; }
	double time() const { return state.steps * state.scene.dt; }
	const Scene& settings() const { return state.scene; }
	double& target_area_fraction() { return state.scene.target_area_fraction; }
	std::vector<RigidBody>& bodies() { return state.scene.bodies; }

	std::size_t size() const { return state.scene.grains.size(); }
	Grain grain(std::size_t index) const;
	Vector2r arm(std::size_t member) const;  ///< of a body's grain, from the body's centre [m]
	void positions(double* xy) const;        ///< size() pairs, in the order of `Scene::grains`
	void velocities(double* xy) const;
	void spins(double* spin) const;
	/// Contacts of the last step, at its beginning; those at the present positions while a step is under way, or where pairs have been
	/// laid out anew since.
	std::vector<Contact> contacts();
	/// Contacts at the present positions, before anything moves: the forces that the next step will find, to the last bit.
	std::vector<Contact> present_contacts();
	/// The same and `wall_contacts`, for someone who looks between steps: no step is then under way if none was before.
	struct Sight {
		std::vector<Contact> pairs, walls;
	};
	Sight look_between_steps();
	/// Appends the contacts on a body, as of the last `compute_body_forces` or step.
	void touches_on(std::size_t body, std::vector<Touch>& touches) const;

	/// Forces from outside on free grains, from the next step until they are set anew; those on bodies stand in `bodies()`.
	void set_pushes(std::vector<Push> on_grains);
	/// Gives a grain another place, velocity and spin, between two steps.
	void put(std::size_t index, const Grain& grain);
	/// Gives a body and its members another velocity, between two steps.
	void set_velocity(std::size_t body, double vx, double vy, double spin);
	/// Goes on with law, friction, gravity, precision, threads and skin of `wanted`. Springs stay while the kind of law does.
	/// @throws std::invalid_argument as the constructor, and for another physics while energy is tracked
	void change(const Scene& wanted);

	std::vector<Spring> springs() const;
	void set_springs(const std::vector<Spring>& springs);  ///< before the first step
	void forget_springs();                                 ///< all contacts begin anew
	/// @throws std::invalid_argument where it exceeds the critical step
	void set_time_step(double dt);

	/// Adds the wall, or changes the one on its side. @throws std::invalid_argument naming the wall and the rule
	void set_wall(const Wall& wall);
	void remove_wall(Side side);
	void set_wall_springs(const std::vector<WallTouch>& springs);  ///< before the first step
	const std::vector<WallTouch>& wall_springs() const { return state.wall_touches; }
	std::vector<Contact> wall_contacts() const;  ///< `second` is the wall, n is outward, and forces act on the grain

	/// Opens or closes the energy ledger; it costs a plain pass over all contacts at every step.
	void track_energy(bool on);
	const EnergyLedger* energy_ledger() const;  ///< null where energy is not tracked
	EnergyLedger* energy_ledger();

	double kinetic_energy() const;    ///< of free grains, translation and rotation, at the half step [J]
	double kinetic_energy_on_step();  ///< the same with the velocities of the whole step [J]

	const Kernel& kernel_in_use() const { return kernel; }
	long searches_done() const { return state.searches; }
	long selections_done() const { return state.selections; }
	std::size_t pairs_selected() const;
	Guards& guarding() { return state.guards; }
	/// What guards call the grains, by index, and the step that this loop began with; by default indices and 0.
	void speak_of(std::vector<int> names, long first_step) { grain_names = std::move(names), spoken_first_step = first_step; }

private:
	State state;

	// What follows from it.
	Kernel kernel;
	KernelData data{};
	laws::Laws::Any<float> law_in_float;  // of single precision
	std::unique_ptr<ThreadTeam> team;
	std::vector<std::uint32_t> row_of;  // index in Scene::grains -> place in memory
	std::uint32_t n_free = 0, n_grains = 0;
	PairList pairs{ state.candidates };
	CellGrid grid;
	std::vector<std::uint32_t> body_members;  // first member of each body
	std::vector<double> body_reach;           // farthest point of each body from its centre [m]
	double typical_diameter = 0, largest_free_radius = 0;
	std::vector<double> speed;  // bounds at the last selection, by block, then by body [m/s]
	std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;  // those with candidates in common

	// Within a step.
	std::vector<char> thread_beyond;  // by thread: a block went beyond its limit
	std::exception_ptr failure;
	AlignedVector<OutsideForce> outside;  // of damped scenes: by row
	bool body_forces_known = false;
	bool laid_out_since_forces = false;
	double drifted = 0;  // for how long grains have moved since their forces were computed [s]

	std::vector<Spring> given_springs;  // until the first search
	std::vector<int> grain_names;       // for guards; none: indices
	long spoken_first_step = 0;

	void set_up_kernels();
	void arrange_rows();
	void measure_reach();
	void place_members(std::size_t body);
	State snapshot();
	void go_back_to(const State& before);
	void half_step(double spring_time, double drift);
	void resume();
	void advance(int rank, long n);
	bool one_step(int rank, bool early_pairs_done);
	void compute_early_pairs(int rank);
	struct Limit {
		double at = 0;  // of centres [m]
		bool is_set = false;
		std::string by;  // what sets it, for the message
		std::string cause;
	};
	std::array<Limit, 4> limits() const;  // by Side
	Limit given_bound(Side side) const;
	Limit behind_held_grains(Side side) const;
	void check_pairs() const;
	void check_box() const;
	bool is_led(std::uint32_t row) const;
	std::string introduce(std::uint32_t row) const;
	std::string now() const;
	void prepare();
	void search();
	void sort_rows();
	void select();
	void lay_out_pairs();
	void point_at_lists();
	void finish();
	void kick_grain(std::uint32_t at, double force_x, double force_y, double surface_force);
	void push_grains();
	void move_body(std::size_t body);
	void kick(RigidBody& body) const;
	void kick_damped(RigidBody& body) const;
	bool at_contact_point() const;
	void collect_forces(std::size_t body);
	std::uint32_t n_blocks() const { return (n_free + grains_per_block - 1) / grains_per_block; }
	std::uint32_t party_of(std::uint32_t row) const;
	void measure_speeds();
	void find_neighbours();
	void allow_travel();
	double smallest_budget() const;
	void choose_pace(const PairCounts& counts);
	double farthest_before_selection() const;
	void spend_budgets();
	double slipping_bound() const;
	std::vector<Contact> contacts_in_memory() const;
	GrainRow row_before(double time, std::uint32_t at) const;
	double moved_since_forces(std::uint32_t candidate) const;
	double overlap_at_forces(std::uint32_t candidate) const;
	ForceParts parts(const PairForce<double>& force) const;
	bool slips(const ForceParts& force, double remembered) const;

	struct Books {
		EnergyLedger ledger;
		AlignedVector<GrainRow> rows;  // as they were when the forces of the step were computed
		std::vector<RigidBody> bodies;
		std::vector<Wall> walls;
		std::vector<double> slips;  // by candidate
		std::vector<MetContact> met;
	};
	std::unique_ptr<Books> books;  // of the energy ledger
	void remember_for_books();
	SurfaceMotion motion_after(std::uint32_t row) const;
	template <class Other>
	void meet(std::uint64_t key, const Placement& at, const GrainRow& row, const Other& other, const SurfaceMotion& after,
		const SurfaceMotion& after_other, double slip);
	void meet_pairs();
	void meet_walls(LedgerMotion& motion);
	void move_in_books(LedgerMotion& motion);
	void book_energy();

	Placement placement_of(const WallTouch& touch) const;
	Plane force_of_wall(const WallTouch& touch) const;
	void list_wall_touches();
	void compute_wall_forces();
	void add_wall_forces(std::size_t body);
	void hand_outside_forces_over();
	void move_walls();
	void check_walls_while_running() const;
	void append_wall_touches(std::size_t body, std::vector<Touch>& touches) const;
};

}  // namespace graindrive::loop
