/// The loop over spheres: search, pair forces and motion of a scene, step after step, the same bits on any number of threads.
#pragma once
#include <exception>
#include <memory>

#include "engines/loop/spheres/sphere_pairs.hpp"
#include "engines/loop/thread_team.hpp"

namespace graindrive::loop {

/// A pair that carries a tangential spring.
struct SphereContact {
	std::uint32_t first, second;  ///< indices in SphereScene::spheres
	Vector3r spring;              ///< of first's surface against second's [m]
};

class SphereLoop {
public:
	/// @throws std::invalid_argument for a scene that cannot be run: says which number, the rule and the way out
	explicit SphereLoop(const SphereScene& scene);

	/// Goes n steps on.
	void step(long n = 1);
	/// For velocities given on the step, not half a step behind: a step whose kick is half a one (springs are left as they are).
	void begin_on_step();

	std::size_t size() const { return scene.spheres.size(); }
	Sphere sphere(std::size_t index) const;
	/// Force of the contacts on a held sphere in the last step [N], and their torque about its centre [N m].
	Vector3r force_on_held(std::size_t index) const;
	Vector3r torque_on_held(std::size_t index) const;
	/// The pairs that carry a tangential spring.
	std::vector<SphereContact> springs() const;

	double kinetic_energy() const;    ///< of free spheres, translation and rotation, at the half step [J]
	double kinetic_energy_on_step();  ///< the same with the velocities of the whole step [J]

	/// What decides how the run goes on, with the springs brought in; give it back to go on elsewhere.
	const SphereState& keep_state();
	void take_state(const SphereState& kept);

	const SphereKernel& kernel_in_use() const { return kernel; }
	long steps_done() const { return state.steps; }
	long searches_done() const { return state.searches; }
	long selections_done() const { return state.selections; }
	std::size_t pairs_selected() const { return selected; }

private:
	SphereScene scene;
	SphereKernel kernel;
	SphereState state;

	// Made from the scene and the state.
	SphereStep data{};
	std::unique_ptr<ThreadTeam> team;
	std::vector<SpherePairs> shares;                        // by thread
	std::vector<std::vector<const ForceLine*>> incoming;    // by thread, and last for held spheres: early forces on partners
	std::vector<std::vector<std::uint32_t>> incoming_rows;  // and their rows' offsets
	std::vector<std::uint32_t> row_of;                      // index in SphereScene::spheres -> row
	std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;  // parties with candidates in common
	std::vector<double> speed, displaced;  // by party: bound on the speed [m/s], farthest from its place at the search [m]
	std::vector<char> thread_beyond;
	std::vector<PairCounts3> counts;  // by thread
	std::size_t selected = 0;
	double typical_diameter = 0, largest_free_radius = 0;
	std::exception_ptr failure;

	// For the time of a search.
	SphereGrid grid;
	SphereSearch finder;
	KeptPairs kept;
	bool searching = false;
	std::vector<std::vector<Partner>> found;  // by thread
	std::vector<std::uint32_t> found_cells;   // by thread: first cell, and the end

	void arrange_rows();
	void set_up_kernels();
	void advance(int rank, long n);
	bool one_step(int rank);
	void finish();
	void move_held();
	void add_incoming(int rank);
	void collect_incoming(int rank);

	bool update_lists(int rank);
	void measure_motion(int rank);
	void plan_lists();
	void begin_search();
	void wrap_into_box();
	void keep_pairs(const std::vector<std::uint32_t>& new_row);
	void lay_candidates_out();
	void share_out();
	void take_candidates(int rank);
	void find_neighbours();
	void allow_travel();
	void finish_lists();
	void point_at_state();
	void lay_listed_pairs_out();
	SpherePairs::Source source(int rank, bool as_listed);
	void choose_pace();
	double smallest_budget() const;
	std::vector<std::uint32_t> share_begin;  // by thread: first block, and the end
};

/// @throws std::invalid_argument for a scene that cannot be run
void check_scene(const SphereScene& scene);

}  // namespace graindrive::loop
