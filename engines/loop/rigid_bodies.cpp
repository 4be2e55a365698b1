/// Motion of rigid bodies and their members.
#include "engines/loop/rigid_bodies.hpp"

#include <cmath>

#include "engines/loop/damping.hpp"

namespace graindrive::loop {

namespace {

using geometry::cross;
using geometry::dot;

bool is_ball(const Vec<3>& inertia) { return inertia[0] == inertia[1] && inertia[1] == inertia[2]; }

/// R I R^T v, or R I^-1 R^T v.
Vec<3> by_inertia(const RigidBody<3>& body, const Turn<3>& turn, Vec<3> v, bool inverse)
{
	v = turn.undo(v);
	for (int k = 0; k < 3; ++k) v[k] = inverse ? v[k] / body.inertia[k] : v[k] * body.inertia[k];
	return turn.apply(v);
}

bool all_of(const std::array<bool, 3>& axes) { return axes[0] && axes[1] && axes[2]; }

/// A body that turns freely keeps its angular momentum L, not its spin:
///
///   L_{n+1/2} = L_{n-1/2} + T dt,  w_{n+1/2} = R I^-1 R^T L_{n+1/2} with the orientation R half a step further, q_{n+1} = exp(w dt) q_n
///
/// (Fincham 1992; second order in dt, |L| kept to round-off without torque).
void turn_freely(RigidBody<3>& body, const Vec<3>& torque, const StepMotion<3>& motion)
{
	if (body.spin != body.spin_of_momentum) body.momentum = by_inertia(body, body.turn, body.spin, false);
	const Vec<3> at_step = body.momentum + (motion.kick / 2) * torque;
	body.momentum += motion.kick * torque;
	const Turn<3> halfway = body.turn.advanced(by_inertia(body, body.turn, at_step, true), motion.drift / 2);
	body.spin = body.spin_of_momentum = by_inertia(body, halfway, body.momentum, true);
}

}  // namespace

template <>
void RigidBodies<2>::turn(RigidBody<2>& body) const
{
	if (!body.turns[0]) return;
	if (motion.damping != 0)
		body.spin = kicked(body.spin, (body.torque + body.push_torque) / body.inertia, 0, motion);
	else
		body.spin += (body.torque + body.push_torque) / body.inertia * motion.kick;
}

/// With all axes free the angular momentum is integrated; about one free axis, or with three equal moments, the spin is.
template <>
void RigidBodies<3>::turn(RigidBody<3>& body) const
{
	const Vec<3> torque = body.torque + body.push_torque;
	if (all_of(body.turns) && !is_ball(body.inertia)) return turn_freely(body, torque, motion);
	for (int k = 0; k < 3; ++k) {
		if (!body.turns[k]) continue;
		const Vec<3> axis = Vec<3>::along(k);
		const double inertia = is_ball(body.inertia) ? body.inertia[0] : dot(axis, by_inertia(body, body.turn, axis, false));
		body.spin[k] += torque[k] / inertia * motion.kick;
	}
}

template <int D>
void RigidBodies<D>::kick(RigidBody<D>& body) const
{
	const Vec<D> force = body.force + body.load + body.push;
	for (int k = 0; k < D; ++k) {
		if (!body.responds[k]) continue;
		if (motion.damping != 0)
			body.velocity[k] = kicked(body.velocity[k], force[k] / body.mass, motion.gravity[k], motion);
		else
			body.velocity[k] += (force[k] / body.mass + motion.gravity[k]) * motion.kick;
	}
	turn(body);
}

template <int D>
void RigidBodies<D>::move()
{
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		RigidBody<D>& body = state.scene.bodies[b];
		kick(body);
		body.advance(motion.drift);
		place_members(b);
	}
}

template <int D>
void RigidBodies<D>::set_velocity(std::size_t b, const Vec<D>& velocity, const Spin<D>& spin)
{
	state.scene.bodies[b].velocity = velocity, state.scene.bodies[b].spin = spin;
	place_members(b);
}

template <int D>
void RigidBodies<D>::place_members(std::size_t b)
{
	const RigidBody<D>& body = state.scene.bodies[b];
	const auto turn = body.turn.fixed();
	for (std::uint32_t m = state.first_member[b]; m < state.first_member[b + 1]; ++m) {
		Row<D>& row = state.rows[state.n_free + m];
		const Vec<D> arm = turn.apply(state.members[m].at);
		row.x = body.place + arm + state.members[m].shift;
		row.v = body.velocity + cross(body.spin, arm);
		row.surface = body.spin * row.radius;
	}
}

template <int D>
Row<D> RigidBodies<D>::member_before(double time, std::uint32_t at) const
{
	Row<D> row = state.rows[at];
	const Member<D>& member = state.members[at - state.n_free];
	const RigidBody<D>& body = state.scene.bodies[member.body];
	if (state.body_fixed[member.body]) return row;
	row.x = body.place - body.velocity * time + body.turn.advanced(body.spin, -time).apply(member.at) + member.shift;
	return row;
}

template <int D>
Vec<D> RigidBodies<D>::arm(std::uint32_t at) const
{
	const Member<D>& member = state.members.at(at - state.n_free);
	return state.scene.bodies[member.body].turn.apply(member.at);
}

template class RigidBodies<2>;
template class RigidBodies<3>;

}  // namespace graindrive::loop
