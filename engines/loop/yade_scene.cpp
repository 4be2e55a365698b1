/// Moves a YADE scene of disks into the loop and back.
#include "engines/loop/yade_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace graindrive::loop {

namespace {

constexpr double large = 1.5;  // times the median radius: such a disk would widen every cell of the search

using yade::State;

double median_radius(const yade::BodyContainer& bodies)
{
	std::vector<double> radii;
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id)))
			if (const auto* disk = dynamic_cast<const yade::Sphere*>(bodies[id]->shape.get())) radii.push_back(disk->radius);
	if (radii.empty()) throw std::invalid_argument("GrainLoop needs at least one disk in O.bodies, got none");
	std::nth_element(radii.begin(), radii.begin() + radii.size() / 2, radii.end());
	return radii[radii.size() / 2];
}

RigidBody rigid(const State& state)
{
	RigidBody body;
	body.x = state.pos[0], body.y = state.pos[1];
	body.mass = state.mass, body.inertia = state.inertia[2];
	read_state(state, body);
	return body;
}

Grain grain(const yade::Body& body, double radius, double mass, int owner)
{
	const State& s = *body.state;
	Grain g;
	g.x = s.pos[0], g.y = s.pos[1], g.vx = s.vel[0], g.vy = s.vel[1], g.spin = s.angVel[2];
	g.radius = radius, g.mass = mass, g.body = owner;
	return g;
}

}  // namespace

bool is_frozen(const State& state)
{
	return state.blockedDOFs == State::DOF_ALL && state.vel.isZero(0) && state.angVel.isZero(0);
}

void read_state(const State& state, RigidBody& body)
{
	body.vx = state.vel[0], body.vy = state.vel[1], body.spin = state.angVel[2];
	body.responds_x = !(state.blockedDOFs & State::DOF_X);
	body.responds_y = !(state.blockedDOFs & State::DOF_Y);
	body.responds_spin = !(state.blockedDOFs & State::DOF_RZ) && body.inertia > 0;
}

Quaternionr orientation(const RigidBody& body, const YadeBodies::Turned& turned)
{
	const Real half = (body.angle - turned.angle) / 2;
	return Quaternionr(std::cos(half), 0, 0, std::sin(half)) * Quaternionr(turned.w, turned.x, turned.y, turned.z);
}

void write_state(const RigidBody& body, const YadeBodies::Turned& turned, State& state)
{
	state.pos[0] = body.x, state.pos[1] = body.y;
	state.vel[0] = body.vx, state.vel[1] = body.vy;
	state.angVel[2] = body.spin;
	state.angMom[2] = body.spin * state.inertia[2];
	state.ori = orientation(body, turned);
}

namespace {

/// One plane and one ratio m R^2/I for all free disks: what the loop's equations of motion take for granted.
void require_plane_disks(const yade::BodyContainer& bodies, const YadeBodies& map, Scene& scene)
{
	bool first = true;
	Real z = 0;
	for (std::size_t g = 0; g < map.grain_id.size(); ++g) {
		const std::string name = "body " + std::to_string(map.grain_id[g]);
		const State& state = *bodies[map.grain_id[g]]->state;
		if (g == 0) z = state.pos[2];
		if (std::abs(state.pos[2] - z) > 1e-9 * scene.grains[g].radius)
			throw std::invalid_argument("GrainLoop moves disks in one plane z = const; " + name + " lies in another than body " +
										std::to_string(map.grain_id[0]));
		if (scene.grains[g].body != free_grain) continue;
		const Real ratio = state.mass * scene.grains[g].radius * scene.grains[g].radius / state.inertia[2];
		if (!(ratio > 0) || !std::isfinite(ratio))
			throw std::invalid_argument(
				"GrainLoop: mass and inertia of " + name + " must be positive; a disk has m R^2/2 about z");
		if (first) scene.spin_response = ratio;
		first = false;
		if (std::abs(ratio - scene.spin_response) > 1e-6 * scene.spin_response)
			throw std::invalid_argument(
				"GrainLoop: free grains must share one m R^2/I (2 for disks, 2.5 for spheres); that of " + name + " differs");
	}
}

/// Two groups of bodies that do not see each other in YADE's collider: they share no bit of their masks.
void require_one_crowd(const yade::BodyContainer& bodies)
{
	std::map<int, int> first_with;  // mask -> id
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id)) && !bodies[id]->isClump()) first_with.insert({ bodies[id]->groupMask, int(id) });
	for (auto one = first_with.begin(); one != first_with.end(); ++one)
		for (auto other = one; other != first_with.end(); ++other)
			if (!(one->first & other->first))
				throw std::invalid_argument("GrainLoop lets all disks meet, but the masks of bodies " +
											std::to_string(one->second) + " and " + std::to_string(other->second) + ", " +
											std::to_string(one->first) + " and " + std::to_string(other->first) +
											", share no bit, so YADE's would not; give them one, or use YADE's loop");
}

/// What YADE's collider and integrator heed and the loop does not.
void require_plain(const yade::Body& body, bool damping)
{
	const std::string name = "GrainLoop: body " + std::to_string(body.id);
	if (!body.isClump() && !(body.flags & yade::Body::FLAG_BOUNDED))
		throw std::invalid_argument(name +
									" is not bounded, so YADE's collider would not see it; set O.bodies[...].bounded=True, or "
									"use YADE's loop");
	const State& state = *body.state;
	if (damping && !state.isDamped && !body.isClumpMember())
		throw std::invalid_argument(name + " has state.isDamped=False, and GrainLoop damps all bodies alike; set it to True, or "
										   "GrainLoop.damping to 0");
	const bool leaves_plane = (state.vel[2] != 0 || state.angVel[0] != 0 || state.angVel[1] != 0) && !body.isClumpMember();
	if (leaves_plane)
		throw std::invalid_argument(
			name + " moves along z or turns about x or y; GrainLoop moves disks in their plane: set those to zero");
}

}  // namespace

YadeBodies read_yade(const yade::Scene& yade_scene, const std::vector<int>& watched, Scene& scene)
{
	const yade::BodyContainer& bodies = *yade_scene.bodies;
	YadeBodies map;
	map.known_bodies = bodies.size();
	map.grain_of_id.assign(bodies.size(), -1);
	map.body_of_id.assign(bodies.size(), -1);
	const double largest = large * median_radius(bodies);
	require_one_crowd(bodies);
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id))) require_plain(*bodies[id], scene.damping > 0);
	int frozen = -1;
	const auto new_body = [&](int id, const RigidBody& body) {
		const Quaternionr ori = id < 0 ? Quaternionr::Identity() : bodies[id]->state->ori;
		scene.bodies.push_back(body);
		map.body_id.push_back(id);
		map.turned.push_back({ ori.x(), ori.y(), ori.z(), ori.w(), body.angle });
		return int(scene.bodies.size()) - 1;
	};
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id)) && bodies[id]->isClump()) map.body_of_id[id] = new_body(int(id), rigid(*bodies[id]->state));
	for (std::size_t id = 0; id < bodies.size(); ++id) {
		if (!bodies.exists(int(id)) || bodies[id]->isClump()) continue;
		const yade::Body& body = *bodies[id];
		const auto* disk = dynamic_cast<const yade::Sphere*>(body.shape.get());
		if (!disk)
			throw std::invalid_argument("GrainLoop moves disks and clumps of disks only; body " + std::to_string(id) +
										" has another shape: remove it, or use YADE's own loop");
		const State& state = *body.state;
		const bool watch = std::count(watched.begin(), watched.end(), int(id)) > 0;
		int owner = free_grain;
		double mass = state.mass;
		if (body.isClumpMember()) {
			owner = map.body_of_id[body.clumpId];
			mass = is_frozen(*bodies[body.clumpId]->state) ? HUGE_VAL : scene.bodies[owner].mass;
		} else if (is_frozen(state) && !watch) {
			if (frozen < 0) {
				RigidBody wall;
				wall.frozen = true;
				frozen = new_body(-1, wall);
			}
			owner = frozen;
			mass = HUGE_VAL;
			map.frozen_id.push_back(int(id));
		} else if (watch || (state.blockedDOFs & (State::DOF_X | State::DOF_Y | State::DOF_RZ)) || disk->radius > largest) {
			owner = map.body_of_id[id] = new_body(int(id), rigid(state));
			if (is_frozen(state)) mass = HUGE_VAL;
		}
		if (owner != free_grain && std::visit([](const auto& law) { return law.weighs_members_alone; }, scene.law))
			mass = state.blockedDOFs == State::DOF_ALL ? HUGE_VAL : state.mass;  // as YADE's law sees it
		map.grain_of_id[id] = int(scene.grains.size());
		map.grain_id.push_back(int(id));
		scene.grains.push_back(grain(body, disk->radius, mass, owner));
	}
	require_plane_disks(bodies, map, scene);
	return map;
}

}  // namespace graindrive::loop
