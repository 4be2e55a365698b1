/// One step: new lists if a grain may have come near another, forces of early pairs and surfaces, the sweep, then bodies and
/// walls.
#include "engines/loop/stepper.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

template <int D>
Stepper<D>::Stepper(const Scene<D>& scene, const Guards<D>& guards)
{
	state.scene = scene;
	state.guards = guards;
	check_scene(scene, guards.largest_overlap);
	check_surfaces(scene);
	state.flow.image_velocity = scene.cell.image_velocity();
	arrange_rows();
	set_up();
}

/// Sets up what follows from the settings alone.
template <int D>
void Stepper<D>::set_up()
{
	const Scene<D>& scene = state.scene;
	if (!team || team->size() != scene.threads) team = std::make_unique<ThreadTeam>(scene.threads);
	thread_beyond.assign(scene.threads, 0);
	StepMotion<D>& motion = pairs.motion();
	use_whole_steps();
	motion.gravity = scene.gravity;
	motion.spin_response = scene.rotation ? scene.spin_response : 0;
	motion.damping = scene.damping;
	motion.damps_gravity = scene.damps_gravity;
	pairs.set_up();
}

template <int D>
void Stepper<D>::use_whole_steps()
{
	StepMotion<D>& motion = pairs.motion();
	motion.dt = motion.kick = motion.drift = state.scene.dt;
}

/// Places free grains in the first rows, in their order, then members, body by body.
template <int D>
void Stepper<D>::arrange_rows()
{
	const std::vector<Grain<D>>& grains = state.scene.grains;
	std::vector<std::vector<std::uint32_t>> members_of(state.scene.bodies.size());
	for (std::uint32_t i = 0; i < grains.size(); ++i)
		grains[i].body == free_grain ? state.index_of.push_back(i) : members_of[grains[i].body].push_back(i);
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		const RigidBody<D>& body = state.scene.bodies[b];
		for (const std::uint32_t i : members_of[b]) {
			state.index_of.push_back(i);
			state.members.push_back({ body.to_frame(grains[i].place), {}, static_cast<int>(b) });
		}
		state.body_fixed.push_back(body.frozen);
	}
	state.derive();
	state.rows.resize(state.n);
	if (D == 3) state.inverse_masses.resize(state.n);
	for (std::uint32_t at = 0; at < state.n; ++at) {
		const Grain<D>& g = grains[state.index_of[at]];
		Row<D>& row = state.rows[at] = Row<D>{};
		row.x = g.place, row.v = g.velocity, row.radius = g.radius, row.surface = g.radius * g.spin;
		if constexpr (D == 2)
			row.inverse_mass = 1 / g.mass;
		else
			state.inverse_masses[at] = 1 / g.mass;
	}
	pairs.make_dummies();
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) rigid.place_members(b);
}

template <int D>
void Stepper<D>::run(const std::function<void(int)>& work)
{
	failure = nullptr;
	team->run(work);
	if (failure) std::rethrow_exception(failure);
}

template <int D>
void Stepper<D>::step(long n)
{
	const bool known = body_forces_known;
	run([&](int rank) {
		for (long k = 0; k < n; ++k)
			if (!one_step(rank, k == 0 && known)) return;
	});
}

template <int D>
void Stepper<D>::compute_body_forces()
{
	if (body_forces_known) return;
	run([&](int rank) {
		if (!prepare(rank)) return;
		if (rank == 0) pairs.keep_early();
		team->barrier();
		pairs.early(rank);
	});
	gather_body_forces();
	body_forces_known = true;
}

/// Puts springs and forces of the early pairs back to their values before `compute_body_forces`, so that these pairs can be
/// computed again.
template <int D>
void Stepper<D>::take_back_body_forces()
{
	if (!body_forces_known) return;
	pairs.put_back_early();
	surfaces.take_back();
	take_back_outside_forces();
	body_forces_known = false;
}

template <int D>
void Stepper<D>::gather_body_forces()
{
	pairs.gather_for_members();
	rigid.collect(pairs);
	surfaces.add_to_bodies();
}

/// False if the step could not begin; all threads return the same value.
template <int D>
bool Stepper<D>::one_step(int rank, bool early_pairs_done)
{
	if (!early_pairs_done) {
		if (!prepare(rank)) return false;
		pairs.early(rank);
		team->barrier();
	}
	thread_beyond[rank] = pairs.sweep(rank);
	team->barrier();
	if (rank == 0) finish();
	team->barrier();
	return true;
}

/// Does all that comes before the forces of pairs. False if a guard has raised an error.
template <int D>
bool Stepper<D>::prepare(int rank)
{
	if (state.selection_due && !update_lists(rank)) return false;
	if (rank == 0) look_before();
	team->barrier();
	return !failure;
}

template <int D>
void Stepper<D>::look_before()
{
	try {
		double to_come = 0;
		for (std::size_t p = 0; p < state.allowed.size() && surfaces.any(); ++p)
			to_come = std::max(to_come, budgets.way_to_come(p));
		moved_since_look |= surfaces.moved_by_hand();
		surfaces.list(to_come);
		if (state.guards.every > 0 && (moved_since_look || state.steps % state.guards.every == 0)) guards.check(pairs, surfaces);
		moved_since_look = false;
		surfaces.compute_forces();
		if (state.scene.cell.sheared()) pairs.see_cell();
		hand_outside_forces_over();
		if (books) books->remember(pairs);
	} catch (...) {
		take_back_outside_forces();
		failure = std::current_exception();
	}
}

/// Leapfrog is linear in the force, so a kick that comes after the sweep's own moves a grain as if all forces had been added
/// first.
template <int D>
void Stepper<D>::finish()
{
	if (!body_forces_known) gather_body_forces();
	moved_since_look |= surfaces.moved_by_hand();  // other code may have moved solids since the forces were computed
	rigid.move();
	bool sweep_has_done_it = true;
	if constexpr (D == 2) sweep_has_done_it = pairs.sweep_knows_outside();
	handed_over.clear();
	if (!sweep_has_done_it)
		surfaces.kick_grains(
			[&](std::uint32_t row, const Vec<D>& force, const Spin<D>& turning) { kick_grain(row, force, turning); });
	if (surfaces.any()) surfaces.move();
	surfaces.remember_places();
	if (!sweep_has_done_it)
		for (const Push<D>& push : state.pushes) {
			const std::uint32_t row = state.row_of[push.grain];
			kick_grain(row, push.force, push.torque / state.rows[row].radius);
		}
	change_flow();
	if (books) books->book();
	if (state.scene.cell.sheared()) {
		state.scene.cell.set_image_velocity(state.flow.image_velocity);
		state.scene.cell.advance(pairs.motion().drift);
		state.flow.spin = {};
	}
	for (const char beyond : thread_beyond) state.selection_due |= beyond != 0;
	budgets.spend(pairs.motion().drift);
	++state.steps;
	body_forces_known = false;
	drifted = pairs.motion().drift;
	laid_out_since_forces = false;
}

/// Applies a change of the mean flow like a force that acts in this step only; in a half step, which moves nothing, half of it.
template <int D>
void Stepper<D>::change_flow()
{
	if (!changes_flow(state)) return;
	const StepMotion<D>& motion = pairs.motion();
	const double part = motion.drift > 0 ? 1 : 0.5;
	double farthest = 0;
	for (std::uint32_t at = 0; at < state.n_free; ++at) {
		Row<D>& row = state.rows[at];
		const Vec<D> kick = part * flow_kick<D>(state, row.x - row.v * motion.drift);
		row.v += kick, row.x += kick * motion.drift;
		if (state.scene.rotation) row.surface += state.flow.spin * (part * row.radius);
		farthest = std::max(farthest, length(kick) * motion.drift);
	}
	for (std::uint32_t block = 0; block < state.n_blocks(); ++block) {
		state.travelled[block] += farthest;
		state.selection_due |= state.travelled[block] > state.allowed[block];
	}
}

/// Adds a force to a free grain after the sweep; `turning` is torque over radius [N].
template <int D>
void Stepper<D>::kick_grain(std::uint32_t at, const Vec<D>& force, const Spin<D>& turning)
{
	const StepMotion<D>& motion = pairs.motion();
	Row<D>& row = state.rows[at];
	const double response = state.inverse_mass(at) * motion.kick;
	const Vec<D> kick = force * response;
	row.v += kick;
	row.x += kick * motion.drift;
	row.surface += turning * response * motion.spin_response;
	const std::uint32_t block = state.party_of(at);
	state.travelled[block] += length(kick) * motion.drift;  // the sweep has counted the rest
	state.selection_due |= state.travelled[block] > state.allowed[block];
}

template <>
void Stepper<2>::hand_outside_forces_over()
{
	std::vector<OutsideForce>* outside = pairs.outside_of_sweep();
	if (!outside) return;
	surfaces.kick_grains([&](std::uint32_t row, const Vec<2>& force, double turning) {
		(*outside)[row].force += force;
		(*outside)[row].turning += turning;
	});
	for (const Push<2>& push : state.pushes) {
		const std::uint32_t row = state.row_of[push.grain];
		(*outside)[row].force += push.force;
		(*outside)[row].turning += push.torque / state.rows[row].radius;
	}
}

/// In space forces of surfaces and pushes are added to rows before the sweep. After the sweep they would first let a grain that
/// is pressed on a surface move far into it and then move it back, and both ways would count against the budget of its block.
template <>
void Stepper<3>::hand_outside_forces_over()
{
	take_back_outside_forces();
	const auto add = [&](std::uint32_t row, const Vec<3>& force, const Vec<3>& turning) {
		state.rows[row].force += force;
		state.rows[row].turn += turning;
		handed_over.push_back(row);
	};
	surfaces.kick_grains(add);
	for (const Push<3>& push : state.pushes) {
		const std::uint32_t row = state.row_of[push.grain];
		add(row, push.force, push.torque / state.rows[row].radius);
	}
}

template <int D>
void Stepper<D>::take_back_outside_forces()
{
	if constexpr (D == 3)
		for (const std::uint32_t row : handed_over) state.rows[row].force = state.rows[row].turn = {};
	handed_over.clear();
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace graindrive::loop
