/// One step: lists if anything may have come near, forces of early pairs, the sweep, then bodies.
#include "engines/loop/stepper.hpp"

#include "engines/loop/guards.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

Stepper::Stepper(const Scene& scene)
{
	state.scene = scene;
	check_scene(scene);
	check_walls(scene);
	arrange_rows();
	set_up_kernels();
}

/// What follows from the settings alone.
void Stepper::set_up_kernels()
{
	kernel = choose_kernel({ state.scene.law.index(), state.scene.friction, state.scene.precision });
	if (!team || team->size() != state.scene.threads) team = std::make_unique<ThreadTeam>(state.scene.threads);
	data.dt = data.kick = data.drift = state.scene.dt;
	data.gravity_x = state.scene.gravity_x;
	data.gravity_y = state.scene.gravity_y;
	data.spin_response = state.scene.rotation ? state.scene.spin_response : 0;
	law_in_float = laws::converted<float>(state.scene.law);
	const auto address = [](const auto& law) -> const void* { return &law; };
	data.law =
		state.scene.precision == Precision::single ? std::visit(address, law_in_float) : std::visit(address, state.scene.law);
	data.damping = state.scene.damping;
	data.damps_gravity = state.scene.damps_gravity;
	if (state.scene.box.periodic_x) data.inverse_length_x = 1 / (data.length_x = state.scene.box.x_high - state.scene.box.x_low);
	if (state.scene.box.periodic_y) data.inverse_length_y = 1 / (data.length_y = state.scene.box.y_high - state.scene.box.y_low);
	thread_beyond.assign(state.scene.threads, 0);
}

void Stepper::arrange_rows()
{
	n_grains = state.scene.grains.size();
	row_of.resize(n_grains);
	for (std::uint32_t i = 0; i < n_grains; ++i)
		if (state.scene.grains[i].body == free_grain) state.index_of.push_back(i);
	n_free = state.index_of.size();
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		body_members.push_back(state.index_of.size() - n_free);
		const RigidBody& body = state.scene.bodies[b];
		for (std::uint32_t i = 0; i < n_grains; ++i) {
			const Grain& g = state.scene.grains[i];
			if (g.body != static_cast<int>(b)) continue;
			state.index_of.push_back(i);
			const double dx = g.x - body.x, dy = g.y - body.y, c = std::cos(body.angle), s = std::sin(body.angle);
			state.members.push_back({ c * dx + s * dy, c * dy - s * dx, 0, 0, static_cast<int>(b) });
		}
		state.body_fixed.push_back(body.frozen);
	}
	body_members.push_back(state.members.size());
	state.rows.resize(n_grains + 2);
	double sum = 0;
	for (std::uint32_t at = 0; at < n_grains; ++at) {
		const Grain& g = state.scene.grains[state.index_of[at]];
		row_of[state.index_of[at]] = at;
		state.rows[at] = { g.x, g.y, g.vx, g.vy, g.radius, g.radius * g.spin, 1 / g.mass, 0 };
		if (at < n_free) largest_free_radius = std::max(largest_free_radius, g.radius);
		sum += 2 * g.radius;
	}
	typical_diameter = sum / n_grains;
	state.rows[n_grains] = { 0, 0, 0, 0, typical_diameter, 0, 1, 0 };  // a pair that never touches fills up packs
	state.rows[n_grains + 1] = { 10 * typical_diameter, 0, 0, 0, typical_diameter, 0, 1, 0 };
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) place_members(b);
	measure_reach();
}

/// From the members' places in the body, which stay as they are: a restart must find the same numbers wherever the body has gone.
void Stepper::measure_reach()
{
	body_reach.assign(state.scene.bodies.size(), 0);
	for (std::size_t m = 0; m < state.members.size(); ++m) {
		double& reach = body_reach[state.members[m].body];
		reach = std::max(reach, std::hypot(state.members[m].x, state.members[m].y) + state.rows[n_free + m].radius);
	}
}

void Stepper::step(long n)
{
	failure = nullptr;
	team->run([&](int rank) { advance(rank, n); });
	if (failure) std::rethrow_exception(failure);
}

void Stepper::set_time_step(double dt)
{
	if (books)
		throw std::invalid_argument("the time step must stay while energy is tracked; switch trackEnergy off and on again");
	Scene changed = state.scene;
	changed.dt = dt;
	check_scene(changed);
	check_walls(changed);
	state.scene.dt = data.dt = data.kick = data.drift = dt;
}

void Stepper::set_springs(const std::vector<Spring>& springs) { given_springs = springs; }

void Stepper::forget_springs()
{
	for (Candidate& pair : state.candidates) pair.slip = 0;
	pairs.put_back_slips();
	for (WallTouch& touch : state.wall_touches) touch.slip = 0;
}

void Stepper::compute_body_forces()
{
	if (body_forces_known) return;
	failure = nullptr;
	prepare();
	if (failure) std::rethrow_exception(failure);
	pairs.keep_early_pairs();
	team->run([&](int rank) { compute_early_pairs(rank); });
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b)
		if (!state.body_fixed[b]) collect_forces(b);
	body_forces_known = true;
}

void Stepper::advance(int rank, long n)
{
	const bool known = body_forces_known;
	team->barrier();  // everyone has read it before the first step changes it
	for (long k = 0; k < n; ++k)
		if (!one_step(rank, k == 0 && known)) return;
}

/// False if the lists could not be made; every thread learns it behind the same barrier.
bool Stepper::one_step(int rank, bool early_pairs_done)
{
	if (!early_pairs_done) {
		if (rank == 0) prepare();
		team->barrier();
		if (failure) return false;
		compute_early_pairs(rank);
		team->barrier();
	}
	const SweepRange& mine = pairs.sweeps[rank];
	thread_beyond[rank] = kernel.sweep(data, mine.block_begin, mine.block_end, n_free, mine.pair_begin);
	team->barrier();
	if (rank == 0) finish();
	team->barrier();
	return true;
}

void Stepper::compute_early_pairs(int rank)
{
	const std::uint32_t packs = (pairs.early_end - pairs.early_begin) / pack_alignment;
	const auto share = [&](int r) {
		return pairs.early_begin + std::uint32_t(std::uint64_t(packs) * r / state.scene.threads) * pack_alignment;
	};
	kernel.pairs(data, share(rank), share(rank + 1), true);
}

void Stepper::prepare()
{
	try {
		if (state.selection_due) select();
		if (!state.scene.walls.empty()) list_wall_touches();
		if (state.guards.every > 0 && state.steps % state.guards.every == 0) {
			check_box();
			check_pairs();
			check_walls_while_running();
		}
		if (!state.scene.walls.empty()) compute_wall_forces();
		hand_outside_forces_over();
		if (books) remember_for_books();
	} catch (...) {
		failure = std::current_exception();
	}
}

void Stepper::finish()
{
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		if (!body_forces_known) collect_forces(b);
		move_body(b);
	}
	if (!state.scene.walls.empty()) move_walls();
	if (!state.pushes.empty()) push_grains();
	if (books) book_energy();
	spend_budgets();
	++state.steps;
	body_forces_known = false;
	drifted = data.drift;
	laid_out_since_forces = false;
}

void Stepper::select()
{
	if (state.selections > 0) pairs.keep_slips();
	measure_speeds();
	allow_travel();
	if (state.searches == 0 || !(2 * farthest_before_selection() <= state.skin)) {
		search();
		measure_speeds();
		find_neighbours();
		allow_travel();
	}
	std::vector<Reach> reach(n_grains);
	for (std::uint32_t i = 0; i < n_grains; ++i) {
		const double budget = state.allowed[party_of(i)];
		reach[i] = { state.rows[i].radius + budget,
			state.rows[i].radius + std::max(budget / 2, std::min(budget, smallest_budget())) };
	}
	choose_pace(pairs.select(state.rows.data(), state.scene.box, reach));
	lay_out_pairs();
	std::fill(state.travelled.begin(), state.travelled.end(), 0);
	state.selection_due = false;
	++state.selections;
}

void Stepper::lay_out_pairs()
{
	laid_out_since_forces = state.steps > 0;
	pairs.lay_out(state.rows.data(), n_free, n_grains, state.scene.threads, state.scene.precision, n_grains);
	point_at_lists();
}

std::size_t Stepper::pairs_selected() const
{
	return std::count_if(pairs.place.begin(), pairs.place.end(), [](std::uint32_t at) { return at != 0; });
}

}  // namespace graindrive::loop
