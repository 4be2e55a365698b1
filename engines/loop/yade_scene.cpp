/// Moves a YADE scene of disks or spheres into the loop and back.
#include "engines/loop/yade_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engines/loop/checkpoint.hpp"
#include "engines/loop/guards.hpp"
#include "engines/solids/Solid.hpp"

namespace graindrive::loop {

namespace {

constexpr double large = 1.5;  // over the median radius: larger grains would widen every cell of the search

double median_radius(const yade::BodyContainer& bodies)
{
	std::vector<double> radii;
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id)))
			if (const auto* disk = dynamic_cast<const yade::Sphere*>(bodies[id]->shape.get())) radii.push_back(disk->radius);
	if (radii.empty()) throw std::invalid_argument("GrainLoop needs at least one disk or sphere in O.bodies, got none");
	std::nth_element(radii.begin(), radii.begin() + radii.size() / 2, radii.end());
	return radii[radii.size() / 2];
}

/// The word "disk" or "sphere".
template <int D>
constexpr const char* grain_word = D == 2 ? "disk" : "sphere";

template <int D>
RigidBody<D> rigid(const yade::State& state)
{
	RigidBody<D> body;
	body.place = in_loop<D>(state.pos);
	body.mass = state.mass, body.inertia = spin_in_loop<D>(state.inertia);
	if constexpr (D == 3) body.turn = Turn<3>{ state.ori.w(), { state.ori.x(), state.ori.y(), state.ori.z() } }.normalised();
	read_state(state, body);
	return body;
}

template <int D>
Grain<D> grain(const yade::Body& body, double radius, double mass, int owner)
{
	const yade::State& s = *body.state;
	return { in_loop<D>(s.pos), in_loop<D>(s.vel), spin_in_loop<D>(s.angVel), radius, mass, owner };
}

}  // namespace

bool is_frozen(const yade::State& state)
{
	return state.blockedDOFs == yade::State::DOF_ALL && state.vel.isZero(0) && state.angVel.isZero(0);
}

template <int D>
void read_state(const yade::State& state, RigidBody<D>& body)
{
	constexpr unsigned places[] = { yade::State::DOF_X, yade::State::DOF_Y, yade::State::DOF_Z };
	constexpr unsigned spins[] = { yade::State::DOF_RX, yade::State::DOF_RY, yade::State::DOF_RZ };
	body.velocity = in_loop<D>(state.vel), body.spin = spin_in_loop<D>(state.angVel);
	for (int k = 0; k < D; ++k) body.responds[k] = body.mass > 0 && !(state.blockedDOFs & places[k]);
	const bool may_turn = is_positive(body.inertia);
	for (int k = 0; k < spin_axes(D); ++k) body.turns[k] = may_turn && !(state.blockedDOFs & spins[D == 2 ? 2 : k]);
}

Quaternionr orientation(const RigidBody<2>& body, const YadeBodies::Turned& turned)
{
	const Real half = (body.turn.angle - turned.angle) / 2;
	return Quaternionr(std::cos(half), 0, 0, std::sin(half)) * Quaternionr(turned.w, turned.x, turned.y, turned.z);
}

Quaternionr orientation(const RigidBody<3>& body, const YadeBodies::Turned&)
{
	return { body.turn.w, body.turn.u[0], body.turn.u[1], body.turn.u[2] };
}

void follow_orientation(const yade::State& state, const YadeBodies::Turned& turned, int id, RigidBody<2>& body)
{
	const Quaternionr shown = orientation(body, turned);
	if (state.ori.coeffs() == shown.coeffs()) return;
	const Quaternionr turn = state.ori * shown.conjugate();
	if (std::hypot(turn.x(), turn.y()) > 1e-9)
		throw std::runtime_error("GrainLoop: body " + std::to_string(id) +
								 " was turned out of the plane; with dimensions=2 GrainLoop turns bodies only about z");
	body.turn.angle += 2 * std::atan2(turn.z() * (turn.w() < 0 ? -1 : 1), std::abs(turn.w()));
}

void follow_orientation(const yade::State& state, const YadeBodies::Turned& turned, int, RigidBody<3>& body)
{
	if (state.ori.coeffs() == orientation(body, turned).coeffs()) return;
	body.turn = Turn<3>{ state.ori.w(), { state.ori.x(), state.ori.y(), state.ori.z() } }.normalised();
}

template <int D>
void write_motion(const Vec<D>& place, const Vec<D>& velocity, const Spin<D>& spin, yade::State& state)
{
	for (int k = 0; k < D; ++k) state.pos[k] = place[k], state.vel[k] = velocity[k];
	const Vector3r about = spin_in_yade(spin);
	for (int k = D == 2 ? 2 : 0; k < 3; ++k) {
		state.angVel[k] = about[k];
		state.angMom[k] = about[k] * state.inertia[k];
	}
}

template <int D>
void write_state(const RigidBody<D>& body, const YadeBodies::Turned& turned, yade::State& state)
{
	write_motion<D>(body.place, body.velocity, body.spin, state);
	state.ori = orientation(body, turned);
	if constexpr (D == 3) {  // angular momentum is not parallel to the spin if the moments differ
		const bool tumbles = body.turns_somewhere() && body.spin == body.spin_of_momentum;
		const Vector3r in_body = state.ori.conjugate() * state.angVel;
		state.angMom = tumbles ? in_yade<3>(body.momentum) : state.ori * Vector3r(state.inertia.cwiseProduct(in_body));
	}
}

namespace {

/// Requires one plane and one ratio m R^2/I for all free grains, as the loop's equations of motion assume.
template <int D>
void require_alike(const yade::BodyContainer& bodies, const YadeBodies& map, Scene<D>& scene)
{
	bool first = true;
	Real z = 0;
	for (std::size_t g = 0; g < map.grain_id.size(); ++g) {
		const std::string name = "body " + std::to_string(map.grain_id[g]);
		const yade::State& state = *bodies[map.grain_id[g]]->state;
		if (g == 0) z = state.pos[2];
		if (D == 2 && std::abs(state.pos[2] - z) > 1e-9 * scene.grains[g].radius)
			throw std::invalid_argument("GrainLoop moves disks in one plane z = const; " + name +
										" lies in a different one from body " + std::to_string(map.grain_id[0]) +
										"; set GrainLoop.dimensions=3 for spheres in space");
		if (scene.grains[g].body != free_grain) continue;
		const Real ratio = state.mass * scene.grains[g].radius * scene.grains[g].radius / state.inertia[2];
		if (!(ratio > 0) || !std::isfinite(ratio))
			throw std::invalid_argument("GrainLoop: mass and inertia of " + name + " must be positive; a " +
										(D == 2 ? "disk has m R^2/2 about z" : "sphere has 2/5 m R^2 about each axis"));
		if (D == 3 && (state.inertia[0] != state.inertia[2] || state.inertia[1] != state.inertia[2]))
			throw std::invalid_argument("GrainLoop: a free sphere must have one moment of inertia about all axes; those of " +
										name + " differ: set state.inertia to 2/5 m R^2");
		if (first) scene.spin_response = ratio;
		first = false;
		if (std::abs(ratio - scene.spin_response) > 1e-6 * scene.spin_response)
			throw std::invalid_argument(
				"GrainLoop: free grains must have the same m R^2/I (2 for disks, 2.5 for spheres); " + name + " differs");
	}
}

/// Refuses two groups of bodies whose masks share no bit: YADE's collider would find no contacts between them, GrainLoop would.
void require_one_crowd(const yade::BodyContainer& bodies)
{
	std::map<int, int> first_with;  // mask -> id
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id)) && !bodies[id]->isClump()) first_with.insert({ bodies[id]->groupMask, int(id) });
	for (auto one = first_with.begin(); one != first_with.end(); ++one)
		for (auto other = one; other != first_with.end(); ++other)
			if (!(one->first & other->first))
				throw std::invalid_argument(
					"GrainLoop lets all grains have contacts, but the masks of bodies " + std::to_string(one->second) + " and " +
					std::to_string(other->second) + ", " + std::to_string(one->first) + " and " + std::to_string(other->first) +
					", share no bit, so on YADE's loop they have none; give them one, or use YADE's loop");
}

/// Refuses settings of a body that YADE's collider or integrator uses and the loop does not.
template <int D>
void require_plain(const yade::Body& body, bool damping)
{
	const std::string name = "GrainLoop: body " + std::to_string(body.id);
	if (!body.isClump() && !(body.flags & yade::Body::FLAG_BOUNDED))
		throw std::invalid_argument(name +
									" is not bounded, so YADE's collider would not see it; set O.bodies[...].bounded=True, or "
									"use YADE's loop");
	const yade::State& state = *body.state;
	if (damping && !state.isDamped && !body.isClumpMember())
		throw std::invalid_argument(name + " has state.isDamped=False, and GrainLoop damps all bodies alike; set it to True, or "
										   "GrainLoop.damping to 0");
	const bool leaves_plane =
		D == 2 && (state.vel[2] != 0 || state.angVel[0] != 0 || state.angVel[1] != 0) && !body.isClumpMember();
	if (leaves_plane)
		throw std::invalid_argument(
			name + " moves along z or turns about x or y; GrainLoop moves disks in their plane: set those to zero, or "
				   "GrainLoop.dimensions to 3");
}

/// True if forces move the grain in all directions.
template <int D>
bool moves_freely(const yade::State& state)
{
	constexpr unsigned needed =
		D == 2 ? yade::State::DOF_X | yade::State::DOF_Y | yade::State::DOF_RZ : unsigned(yade::State::DOF_ALL);
	return !(state.blockedDOFs & needed);
}

/// Reads bodies one by one into a scene.
template <int D>
struct Reader {
	const yade::BodyContainer& bodies;
	const std::vector<int>& watched;
	Scene<D>& scene;
	YadeBodies map;
	double largest = 0;
	int frozen = -1;

	int new_body(int id, const RigidBody<D>& body)
	{
		const Quaternionr ori = id < 0 ? Quaternionr::Identity() : bodies[id]->state->ori;
		scene.bodies.push_back(body);
		map.body_id.push_back(id);
		Real angle = 0;
		if constexpr (D == 2) angle = body.turn.angle;
		map.turned.push_back({ ori.x(), ori.y(), ori.z(), ori.w(), angle });
		return int(scene.bodies.size()) - 1;
	}

	int the_frozen_body()
	{
		if (frozen >= 0) return frozen;
		RigidBody<D> wall;
		wall.frozen = true;
		return frozen = new_body(-1, wall);
	}

	void read_clump(int id) { map.body_of_id[id] = new_body(id, rigid<D>(*bodies[id]->state)); }

	/// The z of the disks.
	Real plane() const
	{
		for (std::size_t id = 0; id < bodies.size(); ++id)
			if (bodies.exists(int(id)) && dynamic_cast<const yade::Sphere*>(bodies[id]->shape.get()))
				return bodies[id]->state->pos[2];
		return 0;
	}

	/// A solid becomes a body of its own. In the plane its section at the present orientation is used, and the recipe describes
	/// this section.
	void read_solid(int id)
	{
		const yade::Body& body = *bodies[id];
		const auto& shape = static_cast<const graindrive::Solid&>(*body.shape);
		const std::string name = "GrainLoop: the Solid of body " + std::to_string(id);
		if (body.isClumpMember())
			throw std::invalid_argument(name + " is a member of a clump, which GrainLoop does not move; unite surfaces instead "
											   "(graindrive.solids.surfaces: a | b), or use YADE's own loop");
		if (!shape.surface()) throw std::invalid_argument(name + " has no surface; give it one: Solid(surfaces.ball(...))");
		constexpr unsigned translations = yade::State::DOF_X | yade::State::DOF_Y | (D == 3 ? yade::State::DOF_Z : 0);
		if (!(body.state->mass > 0) && (body.state->blockedDOFs & translations) != translations)
			throw std::invalid_argument(name + " may move and has no mass; give it one (state.mass), or block its x, y and z");
		const int owner = map.body_of_id[id] = new_body(id, rigid<D>(*body.state));
		std::string recipe = shape.recipe;
		if (D == 2) {
			const Quaternionr& q = body.state->ori;
			recipe = "placed 0 0 " + solids::number_text(body.state->pos[2] - plane()) + " " + solids::number_text(q.w()) + " " +
			         solids::number_text(q.x()) + " " + solids::number_text(q.y()) + " " + solids::number_text(q.z()) + " " +
			         recipe;
		}
		scene.solids.push_back({ owner, surface_of<D>(recipe), recipe });
	}

	void read_grain(int id)
	{
		const yade::Body& body = *bodies[id];
		if (is_solid(body.shape.get())) return read_solid(id);
		const auto* sphere = dynamic_cast<const yade::Sphere*>(body.shape.get());
		if (!sphere)
			throw std::invalid_argument(std::string("GrainLoop moves ") + grain_word<D> + "s, clumps of " + grain_word<D> +
										"s and Solids only; body " + std::to_string(id) +
										" has another shape: remove it, make it a Solid, or use YADE's own loop");
		const yade::State& state = *body.state;
		const bool watch = std::count(watched.begin(), watched.end(), id) > 0;
		int owner = free_grain;
		double mass = state.mass;
		if (body.isClumpMember()) {
			owner = map.body_of_id[body.clumpId];
			mass = is_frozen(*bodies[body.clumpId]->state) ? HUGE_VAL : scene.bodies[owner].mass;
		} else if (is_frozen(state) && !watch) {
			owner = the_frozen_body();
			mass = HUGE_VAL;
			map.frozen_id.push_back(id);
		} else if (watch || !moves_freely<D>(state) || sphere->radius > largest) {
			owner = map.body_of_id[id] = new_body(id, rigid<D>(state));
			if (is_frozen(state)) mass = HUGE_VAL;
		}
		if (owner != free_grain && std::visit([](const auto& law) { return law.weighs_members_alone; }, scene.law))
			mass = state.blockedDOFs == yade::State::DOF_ALL ? HUGE_VAL : state.mass;  // as in YADE's law
		map.grain_of_id[id] = int(scene.grains.size());
		map.grain_id.push_back(id);
		scene.grains.push_back(grain<D>(body, sphere->radius, mass, owner));
	}
};

}  // namespace

template <int D>
YadeBodies read_yade(const yade::Scene& yade_scene, const std::vector<int>& watched, Scene<D>& scene)
{
	const yade::BodyContainer& bodies = *yade_scene.bodies;
	Reader<D> reader{ bodies, watched, scene, {} };
	reader.map.known_bodies = bodies.size();
	reader.map.grain_of_id.assign(bodies.size(), -1);
	reader.map.body_of_id.assign(bodies.size(), -1);
	reader.largest = large * median_radius(bodies);
	require_one_crowd(bodies);
	const auto each = [&](bool clumps, auto&& visit) {
		for (std::size_t id = 0; id < bodies.size(); ++id)
			if (bodies.exists(int(id)) && bodies[id]->isClump() == clumps) visit(int(id));
	};
	for (std::size_t id = 0; id < bodies.size(); ++id)
		if (bodies.exists(int(id))) require_plain<D>(*bodies[id], scene.damping > 0);
	each(true, [&](int id) { reader.read_clump(id); });
	each(false, [&](int id) { reader.read_grain(id); });
	require_alike(bodies, reader.map, scene);
	return reader.map;
}

template YadeBodies read_yade(const yade::Scene&, const std::vector<int>&, Scene<2>&);
template YadeBodies read_yade(const yade::Scene&, const std::vector<int>&, Scene<3>&);
template void read_state(const yade::State&, RigidBody<2>&);
template void read_state(const yade::State&, RigidBody<3>&);
template void write_state(const RigidBody<2>&, const YadeBodies::Turned&, yade::State&);
template void write_state(const RigidBody<3>&, const YadeBodies::Turned&, yade::State&);
template void write_motion(const Vec<2>&, const Vec<2>&, const double&, yade::State&);
template void write_motion(const Vec<3>&, const Vec<3>&, const Vec<3>&, yade::State&);

}  // namespace graindrive::loop
