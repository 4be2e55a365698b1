/// Changes between two steps: settings, walls, moved grains, the state as a whole.
#include <algorithm>
#include <cmath>

#include "engines/loop/checkpoint.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

template <int D>
void Stepper<D>::set_pushes(std::vector<Push<D>> on_grains)
{
	for (const Push<D>& push : on_grains)
		if (push.grain >= state.n || !state.is_free(push.grain))
			throw std::invalid_argument(sentence("a push must act on a free grain, got grain ", push.grain));
	state.pushes = std::move(on_grains);
	if (body_forces_known) hand_outside_forces_over();
}

template <int D>
void Stepper<D>::put(std::size_t index, const Grain<D>& grain)
{
	Row<D>& row = state.rows[state.row_of[index]];
	const bool elsewhere = row.x != grain.place;
	row.x = grain.place, row.v = grain.velocity;
	row.surface = grain.spin * grain.radius;
	if (!elsewhere) return;
	state.searched_at.assign(state.searched_at.size(), HUGE_VAL);  // earlier neighbours are no longer valid
	surfaces.forget_list();
	state.selection_due = moved_since_look = true;
}

template <int D>
void Stepper<D>::set_velocity(std::size_t body, const Vec<D>& velocity, const Spin<D>& spin)
{
	rigid.set_velocity(body, velocity, spin);
}

/// Takes over YADE's cell. The loop's own differs from it by round-off, or because other code has moved its sides; the difference
/// counts as a displacement of the images.
template <int D>
void Stepper<D>::follow_cell(const Cell<D>& cell)
{
	Cell<D>& own = state.scene.cell;
	if (!own.sheared() || body_forces_known) return;
	Vec<D> way = cell.high - own.high;
	way[own.along] = std::remainder(cell.offset - own.offset, own.length(own.along));
	own = cell;
	budgets.spend_on_images(length(way));
}

template <int D>
void Stepper<D>::change(const Scene<D>& wanted)
{
	Scene<D> changed = state.scene;
	changed.law = wanted.law, changed.friction = wanted.friction, changed.precision = wanted.precision;
	changed.gravity = wanted.gravity;
	changed.threads = wanted.threads, changed.skin = wanted.skin;
	changed.damping = wanted.damping, changed.damps_gravity = wanted.damps_gravity;
	const bool other_physics = !same(changed.law, state.scene.law) || changed.friction != state.scene.friction ||
	                           changed.gravity != state.scene.gravity || changed.damping != state.scene.damping;
	if (books && other_physics)
		throw std::invalid_argument(
			"law, friction, gravity and damping must stay while energy is tracked; switch trackEnergy off and on again");
	check_scene(changed, state.guards.largest_overlap);
	check_surfaces(changed);
	take_back_body_forces();
	if (state.selections > 0) pairs.keep_springs();
	const bool other_springs = !changed.friction || changed.law.index() != state.scene.law.index();
	state.scene = std::move(changed);
	if (other_springs) forget_springs();
	set_up();
	if (state.selections == 0) return;
	pairs.lay_out();
	laid_out_since_forces = state.steps > 0;
}

template <int D>
std::vector<Spring<D>> Stepper<D>::springs() const
{
	std::vector<Spring<D>> found;
	found.reserve(pairs.counts().selected);
	const auto add = [&](std::uint32_t a, std::uint32_t b, const Tangent<D>& slip) {
		if (slip != Tangent<D>{}) found.push_back({ state.index_of[a], state.index_of[b], slip });
	};
	if constexpr (D == 2)
		for (const Candidate& pair : state.pairs.candidates)
			add(pair.first, pair.second, pairs.spring(&pair - state.pairs.candidates.data()));
	else
		pairs.each_spring(add);
	return found;
}

template <int D>
void Stepper<D>::set_springs(const std::vector<Spring<D>>& springs)
{
	given_springs = springs;
}

template <int D>
void Stepper<D>::forget_springs()
{
	pairs.forget_springs();
	for (SurfaceTouch<D>& touch : state.touches) touch.slip = {};
}

template <int D>
void Stepper<D>::set_time_step(double dt)
{
	if (books)
		throw std::invalid_argument("the time step must stay while energy is tracked; switch trackEnergy off and on again");
	Scene<D> changed = state.scene;
	changed.dt = dt;
	check_scene(changed, state.guards.largest_overlap);
	check_surfaces(changed);
	state.scene.dt = dt;
	use_whole_steps();
	if (D == 2) return;
	state.selection_due = true;  // the horizon assumes that all steps until the next selection have one length
	surfaces.forget_list();
}

template <int D>
void Stepper<D>::set_wall(const Wall<D>& wall)
{
	Scene<D> changed = state.scene;
	const auto same_side = [&](const Wall<D>& other) { return other.side == wall.side; };
	const auto at = std::find_if(changed.walls.begin(), changed.walls.end(), same_side);
	const bool is_new = at == changed.walls.end();
	is_new ? changed.walls.push_back(wall) : void(*at = wall);
	check_surfaces(changed);
	if (is_new)
		for (SurfaceTouch<D>& touch : state.touches) touch.surface += touch.surface >= state.scene.walls.size();  // solids
	state.scene.walls = changed.walls;
	surfaces.forget_list();
}

template <int D>
void Stepper<D>::remove_wall(Side side)
{
	for (std::uint32_t w = 0; w < state.scene.walls.size(); ++w) {
		if (state.scene.walls[w].side != side) continue;
		state.scene.walls.erase(state.scene.walls.begin() + w);
		std::vector<SurfaceTouch<D>> kept;
		for (SurfaceTouch<D> touch : state.touches) {
			if (touch.surface == w) continue;
			touch.surface -= touch.surface > w;
			kept.push_back(touch);
		}
		state.touches.swap(kept);
		surfaces.forget_list();
		return;
	}
}

template <int D>
void Stepper<D>::set_surface_springs(const std::vector<SurfaceTouch<D>>& springs)
{
	state.touches = springs;
	std::sort(state.touches.begin(), state.touches.end(), [](const SurfaceTouch<D>& a, const SurfaceTouch<D>& b) {
		return a.surface != b.surface ? a.surface < b.surface : a.grain < b.grain;
	});
}

template <int D>
void Stepper<D>::track_energy(bool on)
{
	if (on == bool(books)) return;
	if (body_forces_known)
		throw std::runtime_error("the energy ledger must be opened and closed between steps, got one in a step");
	books.reset();
	if (!on) return;
	require_explicable(state.scene);
	books = std::make_unique<Books<D>>(state, surfaces);
}

/// The state between steps, including springs.
template <int D>
State<D> Stepper<D>::snapshot()
{
	if (state.selections > 0) pairs.keep_springs();
	return state;
}

/// Restores an earlier state that has the same selection.
template <int D>
void Stepper<D>::go_back_to(const State<D>& before)
{
	state = before;
	handed_over.clear();
	pairs.return_to_state();
	surfaces.forget_list();
	body_forces_known = false;
}

/// Rebuilds what follows from a state that has replaced another.
template <int D>
void Stepper<D>::resume()
{
	state.derive();
	surfaces.forget_list();
	if (state.selections == 0) return;
	pairs.lay_out();
	laid_out_since_forces = state.steps > 0;
	budgets.find_neighbours(pairs);
}

/// A trial step with half a kick, after which the state is restored, also if a guard raises an error.
template <int D>
double Stepper<D>::kinetic_energy_on_step()
{
	take_back_body_forces();
	if (state.selection_due) run([&](int rank) { update_lists(rank); });  // a search's sorting is not undone
	const State<D> before = snapshot();
	std::unique_ptr<Books<D>> aside(nullptr);
	aside.swap(books);  // the ledger must not enter the trial step
	std::exception_ptr refusal;
	try {
		half_step(state.scene.dt, 0);
	} catch (...) {
		refusal = std::current_exception();
	}
	const double energy = kinetic_energy();
	go_back_to(before);
	books.swap(aside);
	if (refusal) std::rethrow_exception(refusal);
	return energy;
}

template <int D>
void Stepper<D>::begin_on_step()
{
	if (books) throw std::runtime_error("call begin_on_step first, then track energy");
	half_step(0, state.scene.dt);
}

/// A step with half a kick, in which springs grow for the time `spring_time` and grains move for the time `drift`.
template <int D>
void Stepper<D>::half_step(double spring_time, double drift)
{
	StepMotion<D>& motion = pairs.motion();
	motion.dt = spring_time;
	motion.kick = 0.5 * state.scene.dt;
	motion.drift = drift;
	try {
		step(1);
	} catch (...) {
		use_whole_steps();
		throw;
	}
	use_whole_steps();
}

template <int D>
void Stepper<D>::save(const std::string& path, const std::string& companion)
{
	if (body_forces_known) throw std::runtime_error("checkpoint " + path + ": a step is under way; save between steps");
	Packer pack;
	pack(companion), pack(D);
	const State<D> now = snapshot();
	visit_state(pack, now);
	pack(bool(books));
	if (books) books->ledger.visit(pack);
	write_checkpoint(path, pack.bytes);
}

template <int D>
std::unique_ptr<Stepper<D>> Stepper<D>::restore(const std::string& path, int threads, std::string* companion)
{
	const std::string body = read_checkpoint(path);
	Unpacker unpack(body);
	std::string words;
	int dimensions = 0;
	unpack(words), unpack(dimensions);
	if (dimensions != D)
		throw std::runtime_error(sentence("checkpoint ", path, ": holds a loop of ", dimensions, " dimensions, but one of ", D,
			" is needed; build the scene that it was saved from"));
	if (companion) *companion = words;
	State<D> saved;
	visit_state(unpack, saved);
	saved.scene.threads = threads;
	auto stepper = std::make_unique<Stepper>(saved.scene, saved.guards);
	stepper->state = std::move(saved);
	stepper->resume();
	bool tracked = false;
	unpack(tracked);
	stepper->track_energy(tracked);
	if (tracked) stepper->books->ledger.visit(unpack);
	return stepper;
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace graindrive::loop
