/// Builds the running loop from YADE's bodies and writes it back: driven bodies at every step, all bodies before other code may
/// read them.
#include <algorithm>
#include <cmath>

#include "engines/loop/mirror_of.hpp"
#include "engines/loop/yade_cell.hpp"

namespace graindrive::loop {

template <int D>
Scene<D> MirrorOf<D>::settings_of(const GrainLoop& engine)
{
	Scene<D> s;
	s.law = engine.contact_law();
	s.friction = engine.friction > 0;
	s.gravity = in_loop<D>(engine.gravity);
	s.damping = engine.damping, s.damps_gravity = engine.dampGravity;
	s.dt = engine.scene->dt;
	s.precision = engine.precision == "single" ? Precision::single : Precision::double_;
	s.threads = engine.threads;
	s.skin = engine.skin;
	for (int k = 0; k < D; ++k) s.cell.high[k] = engine.periods[k], s.cell.periodic[k] = engine.periods[k] > 0;
	if constexpr (D == 2)
		if (engine.scene->isPeriodic && deforms(*engine.scene->cell)) read_flow(*engine.scene->cell, s.cell);
	return s;
}

template <int D>
MirrorOf<D>::MirrorOf(GrainLoop& of) : engine(of)
{
	build();
}

template <int D>
void MirrorOf<D>::build()
{
	Scene<D> s = settings_of(engine);
	for (const Wall<3>& wall : engine.kept_walls()) s.walls.push_back(in_dimension<D>(wall));
	s.target_fraction = engine.targetAreaFraction;
	map = read_yade(scene(), engine.watched, s);
	Guards<D> guards;
	guards.largest_overlap = engine.largestOverlap;
	stepper = std::make_unique<Stepper<D>>(s, guards);
	stepper->set_springs(kept_springs());
	stepper->track_energy(engine.trackEnergy);
	bring_surface_springs();
	bring_loads();
	stepper->speak_of(map.grain_id, scene().iter);
	note_what_was_built();
	require_spread();
}

template <int D>
void MirrorOf<D>::note_what_was_built()
{
	pushed = open = false;
	written.clear();
	counted.clear();
	for (const int id : map.body_id) counted.push_back(id < 0 ? Counted{} : counted_now(id));
	materials.clear();
	for (const int id : map.grain_id) {
		const auto& material = body_of_yade(id).material;
		const auto* known = dynamic_cast<const yade::FrictMat*>(material.get());
		const auto same = [&](const KnownMaterial& one) { return one.material == material; };
		if (known && std::none_of(materials.begin(), materials.end(), same))
			materials.push_back({ material, known->young, known->poisson, known->frictionAngle });
	}
}

template <int D>
void MirrorOf<D>::go_on_from_checkpoint()
{
	note_what_was_built();
	stepper->speak_of(map.grain_id, scene().iter - stepper->steps_done());
}

template <int D>
void MirrorOf<D>::bring_settings_of_step()
{
	Guards<D>& guards = stepper->guarding();
	const std::vector<Real>& bounds = engine.bounds;
	const bool other_overlap = guards.largest_overlap != engine.largestOverlap;
	guards.largest_overlap = engine.largestOverlap;
	guards.bounded = !bounds.empty();
	for (int k = 0; k < D && guards.bounded; ++k) guards.low[k] = bounds[k], guards.high[k] = bounds[D + k];
	stepper->target_fraction() = engine.targetAreaFraction;
	if (!stepper->step_under_way()) stepper->track_energy(engine.trackEnergy);
	if (stepper->settings().dt != scene().dt || other_overlap) stepper->set_time_step(scene().dt);
}

/// Does the work; if a guard raises an error, writes all bodies first, so that O.bodies shows what went wrong.
template <int D>
template <class Work>
void MirrorOf<D>::guarded(Work work)
{
	try {
		work();
	} catch (...) {
		write_bodies();
		sync();
		throw;
	}
}

template <int D>
void MirrorOf<D>::compute_body_forces()
{
	guarded([&] { stepper->compute_body_forces(); });
}

template <>
void MirrorOf<3>::follow_cell()
{
}

template <>
void MirrorOf<2>::follow_cell()
{
	Cell<2> cell = stepper->settings().cell;
	read_flow(*scene().cell, cell);
	stepper->follow_cell(cell);
}

template <>
void MirrorOf<3>::take_next_flow()
{
}

template <>
void MirrorOf<2>::take_next_flow()
{
	if (stepper->settings().cell.sheared()) stepper->set_flow(loop::take_next_flow(*scene().cell));
}

template <int D>
void MirrorOf<D>::step()
{
	guarded([&] { stepper->step(1); });
}

/// Drives and Python move bodies by writing into YADE's bodies: position, velocity, rotation and freedoms are read at every step.
template <int D>
void MirrorOf<D>::follow_bodies()
{
	for (std::size_t b = 0; b < map.body_id.size(); ++b) {
		if (map.body_id[b] < 0) continue;
		const yade::State& state = state_of(map.body_id[b]);
		require_finite(state, map.body_id[b]);
		RigidBody<D>& body = stepper->bodies()[b];
		read_state(state, body);
		body.place = in_loop<D>(state.pos);
		follow_orientation(state, map.turned[b], map.body_id[b], body);
	}
}

template <int D>
void MirrorOf<D>::write_bodies()
{
	for (std::size_t b = 0; b < map.body_id.size(); ++b)
		if (map.body_id[b] >= 0) write_state(stepper->bodies()[b], map.turned[b], state_of(map.body_id[b]));
}

template <int D>
void MirrorOf<D>::sync()
{
	stepper->take_back_body_forces();  // these forces have already advanced the springs that are written here
	for (std::size_t g = 0; g < map.grain_id.size(); ++g)
		if (scene().bodies->exists(map.grain_id[g])) write_grain(g);
	keep_walls();
	const std::vector<Spring<D>> springs = stepper->springs();
	engine.springs.clear();
	engine.springs.reserve(springs.size() * (D == 2 ? 3 : 5));
	for (const Spring<D>& s : springs) {
		engine.springs.insert(engine.springs.end(), { Real(map.grain_id[s.first]), Real(map.grain_id[s.second]) });
		if constexpr (D == 2)
			engine.springs.push_back(s.slip);
		else
			engine.springs.insert(engine.springs.end(), s.slip.coordinate, s.slip.coordinate + 3);
	}
	remember_what_is_written();
}

/// Writes a grain in the periodic image that is nearest to its last place in YADE. Displacements are not summed over syncs,
/// because results must not depend on the number of syncs.
template <int D>
void MirrorOf<D>::write_grain(std::size_t g)
{
	const Grain<D> now = stepper->grain(g);
	yade::State& state = state_of(map.grain_id[g]);
	if (now.body != free_grain && (map.body_id[now.body] < 0 || map.body_id[now.body] == map.grain_id[g])) return;
	Vec<D> place;
	if (now.body != free_grain) {  // in the same image as its clump, as in YADE
		place = stepper->bodies()[now.body].place + stepper->arm(g);
	} else {
		const bool sheared = stepper->settings().cell.sheared();  // images then differ in velocity, so the loop's own is written
		for (int k = 0; k < D; ++k) {
			const Real period = sheared ? 0 : engine.periods[k];
			place[k] = period > 0 ? now.place[k] + period * std::nearbyint((state.pos[k] - now.place[k]) / period) : now.place[k];
		}
	}
	write_motion<D>(place, now.velocity, now.spin, state);
}

/// The springs of the last sync whose two grains still exist.
template <int D>
std::vector<Spring<D>> MirrorOf<D>::kept_springs() const
{
	constexpr std::size_t width = D == 2 ? 3 : 5;
	const std::vector<Real>& springs = engine.springs;
	const auto grain_of = [&](Real id) { return id >= 0 && id < map.grain_of_id.size() ? map.grain_of_id[std::size_t(id)] : -1; };
	std::vector<Spring<D>> kept;
	for (std::size_t k = 0; k + width <= springs.size(); k += width) {
		const int a = grain_of(springs[k]), b = grain_of(springs[k + 1]);
		if (a < 0 || b < 0) continue;
		if constexpr (D == 2)
			kept.push_back({ std::uint32_t(a), std::uint32_t(b), springs[k + 2] });
		else
			kept.push_back({ std::uint32_t(a), std::uint32_t(b), { springs[k + 2], springs[k + 3], springs[k + 4] } });
	}
	return kept;
}

template <int D>
const Energies* MirrorOf<D>::energies() const
{
	const EnergyLedger<D>* ledger = stepper->energy_ledger();
	return ledger ? &ledger->energies() : nullptr;
}

std::unique_ptr<Mirror> mirror_of(GrainLoop& engine)
{
	if (engine.dimensions == 3) return std::make_unique<MirrorOf<3>>(engine);
	return std::make_unique<MirrorOf<2>>(engine);
}

namespace {

template <int D>
std::unique_ptr<Mirror> restored(GrainLoop& engine, const std::string& path, std::string& companion)
{
	auto stepper = Stepper<D>::restore(path, engine.threads, &companion);
	return std::make_unique<MirrorOf<D>>(engine, std::move(stepper));
}

template <int D>
void require_readable_in(GrainLoop& engine)
{
	Scene<D> read;
	read_yade(*engine.scene, engine.watched, read);
}

}  // namespace

std::unique_ptr<Mirror> mirror_from(GrainLoop& engine, const std::string& path, std::string& companion)
{
	return engine.dimensions == 3 ? restored<3>(engine, path, companion) : restored<2>(engine, path, companion);
}

void require_readable(GrainLoop& engine)
{
	engine.dimensions == 3 ? require_readable_in<3>(engine) : require_readable_in<2>(engine);
}

template class MirrorOf<2>;
template class MirrorOf<3>;

}  // namespace graindrive::loop
