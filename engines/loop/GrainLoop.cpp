/// GrainLoop: takes YADE's disks, steps them, and keeps the driven bodies true at every step.
#include "engines/loop/GrainLoop.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive {

const char* const GrainLoop::documentation =
	"Collider, contact law and integrator in one, for disks in the plane z = const: the "
	"same physics as YADE's loop with the Law2_ functor\n"
	"of the same name, many times faster.\n\n"
	"Stands last in O.engines, after measures and drives: O.engines = "
	"[ContactForceBinner(...), OscillationDrive(...), GrainLoop(...)].\n"
	"Clumps, and disks that are driven, partly blocked, large or `watched`, are written "
	"to YADE at every step; all others at the end of\n"
	"O.run, every `syncEvery` steps and by sync(). What Python writes into a free disk "
	"is seen after read(). Orientations of free disks\n"
	"are not kept. Raises ValueError for shapes other than disks, a time step above the "
	"critical one and numbers out of range; a guard\n"
	"stops the run where grains overlap by more than `largestOverlap` of a radius or leave the box (see `bounds`).";

namespace {

constexpr std::size_t numbers_per_wall = 9;
constexpr int no_body = -1;

}  // namespace

void GrainLoop::check() const
{
	require(law == "hertzHistory" || law == "hertzRestitution" || law == "springDashpot",
		"GrainLoop.law must be 'hertzHistory', 'hertzRestitution' or 'springDashpot'", law);
	require(precision == "double" || precision == "single", "GrainLoop.precision must be 'double' or 'single'", precision);
	require(friction >= 0, "GrainLoop.friction must not be negative", friction);
	require(normalStiffness > 0, "GrainLoop.normalStiffness must be positive", normalStiffness);
	require(tangentialStiffness > 0, "GrainLoop.tangentialStiffness must be positive (friction=0 switches tangential forces off)",
		tangentialStiffness);
	require(normalDamping >= 0 && tangentialDamping >= 0, "GrainLoop.normalDamping and tangentialDamping must not be negative",
		std::min(normalDamping, tangentialDamping));
	require(
		gravity.allFinite() && gravity[2] == 0, "GrainLoop.gravity must be finite and in the plane, 0 in z", gravity.transpose());
	require(std::isfinite(normalStiffness + tangentialStiffness + normalDamping + tangentialDamping + friction),
		"GrainLoop's stiffnesses, dampings and friction must be finite", normalStiffness);
	require(std::isfinite(young), "GrainLoop.young must be finite", young);
	require(std::isfinite(skin) && skin >= 0, "GrainLoop.skin must be finite and not negative", skin);
	require(threads >= 1 && threads <= 256, "GrainLoop.threads must lie in 1..256", threads);
	require(periods.allFinite() && periods[0] >= 0 && periods[1] >= 0 && periods[2] == 0,
		"GrainLoop.periods must not be negative, and 0 in z", periods.transpose());
	require(largestOverlap > 0 && largestOverlap <= 1, "GrainLoop.largestOverlap must lie in (0, 1] of the smaller radius",
		largestOverlap);
	require(syncEvery >= 0, "GrainLoop.syncEvery must not be negative", syncEvery);
	require(
		targetAreaFraction >= 0 && targetAreaFraction < 1, "GrainLoop.targetAreaFraction must lie in [0, 1)", targetAreaFraction);
	require(loads.size() % 3 == 0, "GrainLoop.loads must hold three numbers a body", loads.size());
	require(wallSettings.size() % numbers_per_wall == 0, "GrainLoop.wallSettings must hold nine numbers a wall; use setWall",
		wallSettings.size());
	require(wallSprings.size() % 3 == 0, "GrainLoop.wallSprings must hold three numbers a contact", wallSprings.size());
	require(bounds.empty() || bounds.size() == 4, "GrainLoop.bounds must be four numbers, xLow, yLow, xHigh, yHigh, or none",
		bounds.size());
	require(std::all_of(bounds.begin(), bounds.end(), [](Real b) { return std::isfinite(b); }),
		"GrainLoop.bounds must be finite; equal numbers leave an axis without bound", "one that is not");
	require(bounds.empty() || (bounds[0] <= bounds[2] && bounds[1] <= bounds[3]),
		"GrainLoop.bounds must be xLow, yLow, xHigh, yHigh with low <= high", "the other order");
	require(springs.size() % 3 == 0, "GrainLoop.springs must hold three numbers a contact", springs.size());
	contact_law();
	laws::hertz_restitution(young, poisson, restitution, friction);  // their own checks, whatever the law in use
}

loop::ContactLaw GrainLoop::contact_law() const
{
	if (law == "springDashpot") return laws::spring_dashpot(normalStiffness, tangentialStiffness, restitution, friction);
	if (law == "hertzRestitution") return laws::hertz_restitution(young, poisson, restitution, friction);
	return laws::HertzHistory<Real>{ normalStiffness, tangentialStiffness, normalDamping, tangentialDamping, friction };
}

loop::Scene GrainLoop::settings() const
{
	loop::Scene s;
	s.law = contact_law();
	s.friction = friction > 0;
	s.gravity_x = gravity[0], s.gravity_y = gravity[1];
	s.dt = scene->dt;
	s.precision = precision == "single" ? loop::Precision::single : loop::Precision::double_;
	s.threads = threads;
	s.skin = skin;
	s.box = { 0, periods[0], 0, periods[1], periods[0] > 0, periods[1] > 0 };
	return s;
}

void GrainLoop::build()
{
	loop::Scene s = settings();
	require_periods();
	require_alone();
	s.walls = walls();
	s.target_area_fraction = targetAreaFraction;
	map_ = loop::read_yade(*scene, watched, s);
	std::vector<loop::Spring> carried;
	for (std::size_t k = 0; k + 2 < springs.size(); k += 3) {
		const auto grain_of = [&](Real id) {
			return id >= 0 && id < map_.grain_of_id.size() ? map_.grain_of_id[std::size_t(id)] : -1;
		};
		const int a = grain_of(springs[k]), b = grain_of(springs[k + 1]);
		if (a >= 0 && b >= 0) carried.push_back({ std::uint32_t(a), std::uint32_t(b), springs[k + 2] });
	}
	stepper_ = std::make_unique<loop::Stepper>(s);
	stepper_->set_springs(carried);
	stepper_->track_energy(trackEnergy);
	bring_walls();
	read_from_ = scene;
	stepper_->speak_of(map_.grain_id, scene->iter);
}

/// A cell that is long on purpose leaves an axis free; one that repeats must do so with YADE's own length.
void GrainLoop::require_periods() const
{
	if (!scene->isPeriodic) return;
	if (periods.isZero(0))
		throw std::invalid_argument("GrainLoop: O.periodic is set but GrainLoop.periods are 0; give the period in x (and y), "
									"e.g. periods=(O.cell.size[0], 0, 0)");
	for (int axis = 0; axis < 2; ++axis) {
		const Real period = periods[axis], edge = scene->cell->hSize(axis, axis);
		if (period == 0 || std::abs(period - edge) <= 1e-12 * edge) continue;
		throw std::invalid_argument(std::string("GrainLoop: the period in ") + "xy"[axis] + " is " + std::to_string(period) +
									", O.cell repeats after " + std::to_string(edge) +
									"; make them equal (O.cell.setBox, or periods), or 0 for an axis that does not repeat");
	}
}

void GrainLoop::bring_guards()
{
	loop::Guards& guards = stepper_->guarding();
	guards.largest_overlap = largestOverlap;
	guards.bounded = !bounds.empty();
	if (guards.bounded) guards.x_low = bounds[0], guards.y_low = bounds[1], guards.x_high = bounds[2], guards.y_high = bounds[3];
}

loop::Stepper& GrainLoop::stepper()
{
	if (!scene) throw std::runtime_error("GrainLoop is in no scene yet; put it into O.engines and run a step first");
	if (!stepper_ || read_from_ != scene) build();
	if (map_.known_bodies != scene->bodies->size())
		throw std::runtime_error(
			"GrainLoop: bodies were added to or removed from O.bodies; call sync() before and read() after such a change");
	bring_guards();
	stepper_->target_area_fraction() = targetAreaFraction;
	if (!stepper_->step_under_way()) stepper_->track_energy(trackEnergy);
	if (stepper_->settings().dt != scene->dt) stepper_->set_time_step(scene->dt);
	return *stepper_;
}

/// Bodies may be erased while the loop does not look; the few that it writes at every step are checked at every step.
void GrainLoop::require_bodies(bool all) const
{
	const auto require_all = [&](const std::vector<int>& ids) {
		for (const int id : ids)
			if (id >= 0 && !scene->bodies->exists(id))
				throw std::runtime_error("GrainLoop: body " + std::to_string(id) +
										 " was erased from O.bodies; call sync() before such a change and read() after it");
	};
	require_all(map_.body_id);
	if (all) require_all(map_.grain_id);
}

/// Two integrators would move everything twice.
void GrainLoop::require_alone() const
{
	for (const auto& engine : scene->engines) {
		const std::string name = engine->getClassName();
		const bool rival =
			(name == class_name && engine.get() != this) || name == "NewtonIntegrator" || name == "InteractionLoop";
		if (rival && !engine->dead)
			throw std::runtime_error(
				"GrainLoop takes the place of collider, InteractionLoop and NewtonIntegrator; O.engines also holds " + name +
				": remove it");
	}
}

/// Does the work; if a guard trips, everyone can see in O.bodies what went wrong.
template <class Work>
void GrainLoop::guarded(Work work)
{
	try {
		work();
	} catch (...) {
		write_bodies();
		sync();
		throw;
	}
}

void GrainLoop::compute_body_forces()
{
	guarded([&] { stepper_->compute_body_forces(); });
}

void GrainLoop::action()
{
	stepper();
	const bool look_at_all = scene->stopAtIter != run_end_ || scene->iter % 100 == 0;
	require_bodies(look_at_all);
	compute_body_forces();
	if (look_at_all) release_what_moves();
	run_end_ = scene->stopAtIter;
	follow_bodies();
	guarded([&] { stepper().step(1); });
	write_bodies();
	if (last_step_of_run() || (syncEvery > 0 && (scene->iter + 1) % syncEvery == 0)) sync();
}

bool GrainLoop::last_step_of_run() const { return scene->stopAtIter > 0 && scene->iter + 1 >= scene->stopAtIter; }

/// A frozen disk that someone has set in motion becomes a body of its own.
void GrainLoop::release_what_moves()
{
	bool moves = false;
	for (std::size_t g = 0; g < map_.grain_id.size() && !moves; ++g) {
		const int owner = stepper_->settings().grains[g].body;
		if (owner != loop::free_grain && map_.body_id[owner] < 0)
			moves = !loop::is_frozen(*(*scene->bodies)[map_.grain_id[g]]->state);
	}
	if (!moves) return;
	sync();
	build();
	compute_body_forces();
}

void GrainLoop::follow_bodies()
{
	for (std::size_t b = 0; b < map_.body_id.size(); ++b) {
		if (map_.body_id[b] < 0) continue;
		const yade::State& state = *(*scene->bodies)[map_.body_id[b]]->state;
		loop::RigidBody& body = stepper_->bodies()[b];
		loop::read_state(state, body);
		body.x = state.pos[0], body.y = state.pos[1];
	}
}

void GrainLoop::write_bodies()
{
	for (std::size_t b = 0; b < map_.body_id.size(); ++b)
		if (map_.body_id[b] >= 0) loop::write_state(stepper_->bodies()[b], *(*scene->bodies)[map_.body_id[b]]->state);
}

void GrainLoop::sync()
{
	if (!stepper_ || !scene || read_from_ != scene) return;
	const auto nearest = [](Real d, Real period) { return period > 0 ? d - period * std::nearbyint(d / period) : d; };
	for (std::size_t g = 0; g < map_.grain_id.size(); ++g) {
		if (!scene->bodies->exists(map_.grain_id[g])) continue;
		const loop::Grain now = stepper_->grain(g);
		yade::State& state = *(*scene->bodies)[map_.grain_id[g]]->state;
		if (now.body != loop::free_grain && (map_.body_id[now.body] < 0 || map_.body_id[now.body] == map_.grain_id[g])) continue;
		state.pos[0] += nearest(now.x - state.pos[0], periods[0]);  // YADE counts the windings of a periodic box
		state.pos[1] += nearest(now.y - state.pos[1], periods[1]);
		state.vel[0] = now.vx, state.vel[1] = now.vy;
		state.angVel[2] = now.spin;
		state.angMom[2] = now.spin * state.inertia[2];
	}
	keep_walls();
	springs.clear();
	for (const loop::Spring& s : stepper_->springs())
		springs.insert(springs.end(), { Real(map_.grain_id[s.first]), Real(map_.grain_id[s.second]), s.slip });
}

void GrainLoop::begin_on_step()
{
	stepper().begin_on_step();
	write_bodies();
}

void GrainLoop::read()
{
	keep_walls();
	stepper_.reset();
}

/// The rigid body that a YADE body is, or is part of; a free disk that someone asks for becomes one.
int GrainLoop::body_index(int id)
{
	stepper();
	if (id < 0 || id >= int(map_.body_of_id.size()) || (map_.body_of_id[id] < 0 && map_.grain_of_id[id] < 0))
		throw std::runtime_error("GrainLoop: contacts asked for body " + std::to_string(id) +
								 ", which is not in O.bodies; give the id that O.bodies.append returned");
	if (map_.body_of_id[id] < 0 && stepper_->settings().grains[map_.grain_of_id[id]].body == loop::free_grain) {
		watched.push_back(id);
		sync();
		build();
	}
	compute_body_forces();
	return map_.body_of_id[id] >= 0 ? map_.body_of_id[id] : stepper_->settings().grains[map_.grain_of_id[id]].body;
}

void GrainLoop::contacts_on(int id, std::vector<BodyContact>& contacts)
{
	const int b = body_index(id);
	const bool one_of_many = map_.body_id[b] != id;
	const Vector3r centre = one_of_many ? (*scene->bodies)[id]->state->pos : Vector3r::Zero();
	touches_.clear();
	stepper_->touches_on(b, touches_);
	for (const loop::Touch& t : touches_) {
		const int member = map_.grain_id[t.member];
		const int partner = t.partner < map_.grain_id.size() ? map_.grain_id[t.partner] : no_body;  // a wall
		if (one_of_many && member != id) continue;
		const Vector3r n(t.n_x, t.n_y, 0), along(-t.n_y, t.n_x, 0);
		const loop::RigidBody& body = stepper_->bodies()[b];
		const Vector3r lever =
			one_of_many ? Vector3r(body.x + t.arm_x - centre[0], body.y + t.arm_y - centre[1], 0) : Vector3r(t.arm_x, t.arm_y, 0);
		contacts.push_back({ member, partner, lever, -t.normal * n, t.friction * along, t.slipping });
	}
}

Wrench GrainLoop::wrench_on(int id)
{
	const int b = body_index(id);
	Wrench sum;
	if (map_.body_id[b] == id) {
		const loop::RigidBody& body = stepper_->bodies()[b];
		sum.force = { body.force_x, body.force_y, 0 };
		sum.torque = { 0, 0, body.torque };
		return sum;
	}
	std::vector<BodyContact> contacts;
	contacts_on(id, contacts);
	for (const BodyContact& c : contacts) {
		sum.force += c.normal_force + c.tangential_force;
		sum.torque += c.lever.cross(c.normal_force + c.tangential_force);
	}
	return sum;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::GrainLoop, "GrainLoop")
