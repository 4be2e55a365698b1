/// Rigid bodies in a step: forces of their members added in a fixed order, leapfrog for what responds, members carried along.
#pragma once
#include "engines/loop/views.hpp"

namespace graindrive::loop {

template <int D>
class RigidBodies {
public:
	RigidBodies(State<D>& of, const StepMotion<D>& in) : state(of), motion(in) {}

	/// Forces and torque by the contacts of its members; those of surfaces are added by `Surfaces`.
	template <class Neighbours>
	void collect(const Neighbours& pairs);
	void move();
	void set_velocity(std::size_t body, const Vec<D>& velocity, const Spin<D>& spin);
	/// r_i = X + R b_i,  v_i = V + w x (r_i - X)
	void place_members(std::size_t body);
	/// A member where its body was that long ago, within the last step.
	Row<D> member_before(double time, std::uint32_t row) const;
	/// From the body's place, in the world [m].
	Vec<D> arm(std::uint32_t row) const;

private:
	State<D>& state;
	const StepMotion<D>& motion;

	void kick(RigidBody<D>& body) const;
	void turn(RigidBody<D>& body) const;
};

template <int D>
template <class Neighbours>
void RigidBodies<D>::collect(const Neighbours& pairs)
{
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		RigidBody<D>& body = state.scene.bodies[b];
		body.force = {}, body.torque = {};
		for (std::uint32_t m = state.first_member[b]; m < state.first_member[b + 1]; ++m) {
			const Row<D>& row = state.rows[state.n_free + m];
			const MemberForce<D> on = pairs.force_on_member(m);
			const Vec<D> arm = row.x - state.members[m].shift - body.place;
			body.force += on.force;
			body.torque += geometry::cross(arm, on.force) + row.radius * on.turning;
			if constexpr (D == 2) body.torque -= on.shorter;
		}
	}
}

}  // namespace graindrive::loop
