/// Rigid bodies: forces of their members added in a fixed order, leapfrog for what responds, members carried along.
#include <cmath>

#include "engines/loop/damping.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

void Stepper::collect_forces(std::size_t b)
{
	RigidBody& body = state.scene.bodies[b];
	body.force_x = body.force_y = body.torque = 0;
	for (std::uint32_t m = body_members[b]; m < body_members[b + 1]; ++m) {
		const GrainRow& row = state.rows[n_free + m];
		double x = 0, y = 0, friction = 0, less = 0;
		for (std::uint32_t s = pairs.member_begin[m]; s < pairs.member_begin[m + 1]; ++s) {
			const PairForce<double> force = pairs.force(pairs.member_shares[s].candidate);
			const double side = pairs.member_shares[s].partner ? -1 : 1;
			x += side * force.x;
			y += side * force.y;
			friction += force.friction;
			less += force.normal;
		}
		const double arm_x = row.x - state.members[m].shift_x - body.x, arm_y = row.y - state.members[m].shift_y - body.y;
		body.force_x += x;
		body.force_y += y;
		body.torque += arm_x * y - arm_y * x + row.radius * friction;
		if (at_contact_point()) body.torque -= less;
	}
	if (!state.wall_touches.empty()) add_wall_forces(b);
}

/// What responds, with damping.
void Stepper::kick_damped(RigidBody& body) const
{
	const double force_x = body.force_x + body.load_x + body.push_x, force_y = body.force_y + body.load_y + body.push_y;
	if (body.responds_x) body.vx = kicked(body.vx, force_x / body.mass, data.gravity_x, data);
	if (body.responds_y) body.vy = kicked(body.vy, force_y / body.mass, data.gravity_y, data);
	if (body.responds_spin) body.spin = kicked(body.spin, (body.torque + body.push_torque) / body.inertia, 0, data);
}

void Stepper::kick(RigidBody& body) const
{
	const double force_x = body.force_x + body.load_x + body.push_x, force_y = body.force_y + body.load_y + body.push_y;
	if (body.responds_x) body.vx += (force_x / body.mass + data.gravity_x) * data.kick;
	if (body.responds_y) body.vy += (force_y / body.mass + data.gravity_y) * data.kick;
	if (body.responds_spin) body.spin += (body.torque + body.push_torque) / body.inertia * data.kick;
}

void Stepper::move_body(std::size_t b)
{
	RigidBody& body = state.scene.bodies[b];
	data.damping != 0 ? kick_damped(body) : kick(body);
	body.x += body.vx * data.drift;
	body.y += body.vy * data.drift;
	body.angle += body.spin * data.drift;
	place_members(b);
}

void Stepper::set_velocity(std::size_t b, double vx, double vy, double spin)
{
	RigidBody& body = state.scene.bodies[b];
	body.vx = vx, body.vy = vy, body.spin = spin;
	place_members(b);
}

/// r_i = X + R(angle) b_i,  v_i = V + w x (r_i - X)
void Stepper::place_members(std::size_t b)
{
	const RigidBody& body = state.scene.bodies[b];
	const double c = std::cos(body.angle), s = std::sin(body.angle);
	for (std::uint32_t m = body_members[b]; m < body_members[b + 1]; ++m) {
		const Member& member = state.members[m];
		GrainRow& row = state.rows[n_free + m];
		const double arm_x = c * member.x - s * member.y, arm_y = s * member.x + c * member.y;
		row.x = body.x + arm_x + member.shift_x;
		row.y = body.y + arm_y + member.shift_y;
		row.vx = body.vx - body.spin * arm_y;
		row.vy = body.vy + body.spin * arm_x;
		row.surface_speed = body.spin * row.radius;
	}
}

}  // namespace graindrive::loop
