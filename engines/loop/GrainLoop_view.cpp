/// What GrainLoop shows of grains and contacts, all or one body's: those at the present positions, before the step moves anything.
#include "engines/loop/GrainLoop.hpp"
#include "engines/seam/scene_grains.hpp"

namespace graindrive {

namespace {

constexpr int no_body = -1;

}  // namespace

void GrainLoop::look(SceneView& view, bool with_contacts)
{
	const Turn turn = take_turn();
	view.grains.clear();
	view.contacts.clear();
	view.periods = periods;
	stepper();
	add_grains(view);
	if (!with_contacts) return;
	const auto force_on_second = [](const loop::Contact& c) -> Vector3r {
		return c.normal * Vector3r(c.n_x, c.n_y, 0) - c.friction * Vector3r(-c.n_y, c.n_x, 0);
	};
	for (const loop::Contact& c : stepper_->present_contacts())
		view.contacts.push_back({ int(c.first), int(c.second), { c.n_x, c.n_y, 0 }, c.overlap, force_on_second(c) });
	for (const loop::Contact& c : stepper_->wall_contacts())
		view.contacts.push_back({ int(c.first), no_grain, { c.n_x, c.n_y, 0 }, c.overlap, force_on_second(c) });
}

/// What the loop moves as a body may be a grain all the same (a large disk, a watched one): YADE's state tells.
void GrainLoop::add_grains(SceneView& view) const
{
	const loop::Scene& known = stepper_->settings();
	for (std::size_t g = 0; g < map_.grain_id.size(); ++g) {
		const loop::Grain now = stepper_->grain(g);
		const int id = map_.grain_id[g];
		bool free = true;
		Real mass = now.mass;
		if (known.grains[g].body != loop::free_grain) {
			const yade::Body& body = *(*scene->bodies)[id];
			free = is_free_grain(body);
			mass = body.state->mass;
		}
		view.grains.push_back({ id, free, { now.x, now.y, 0 }, { now.vx, now.vy, 0 }, { 0, 0, now.spin }, now.radius, mass });
	}
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
	const Turn turn = take_turn();
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
	const Turn turn = take_turn();
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
