/// Handles changes by other code in YADE's bodies and forces: applied at once, or by reading the scene again, or refused.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "engines/loop/mirror_of.hpp"
#include "engines/solids/Solid.hpp"

namespace graindrive::loop {

namespace {

const void* surface_of_solid(const yade::Body& body)
{
	return is_solid(body.shape.get()) ? static_cast<const graindrive::Solid&>(*body.shape).surface().get() : nullptr;
}

}  // namespace

void require_finite(const yade::State& state, int id)
{
	if (state.pos.allFinite() && state.vel.allFinite() && state.angVel.allFinite() && state.ori.coeffs().allFinite() &&
		!state.ori.coeffs().isZero(0))
		return;
	throw std::runtime_error("GrainLoop: position, velocity, spin or orientation of body " + std::to_string(id) +
							 " is not finite, or the orientation is zero; look for what writes it into O.bodies");
}

template <int D>
bool MirrorOf<D>::Written::operator==(const Written& other) const
{
	return std::memcmp(this, &other, sizeof *this) == 0;
}

template <int D>
typename MirrorOf<D>::Written MirrorOf<D>::written_in(const yade::Body& body) const
{
	if (!body.state || !body.shape)
		throw std::runtime_error(
			"GrainLoop: body " + std::to_string(body.id) + " has lost its shape or its state; restore it, or erase the body");
	const yade::State& s = *body.state;
	Written w;
	std::memset(&w, 0, sizeof w);  // padding too, because the bytes are compared
	for (int k = 0; k < 3; ++k)
		w.place[k] = s.pos[k], w.velocity[k] = s.vel[k], w.spin[k] = s.angVel[k], w.inertia[k] = s.inertia[k];
	w.mass = s.mass;
	w.radius = static_cast<const yade::Sphere&>(*body.shape).radius;
	w.blocked = s.blockedDOFs, w.mask = body.groupMask, w.clump = body.clumpId, w.flags = body.flags;
	w.material = body.material.get(), w.damped = s.isDamped;
	return w;
}

template <int D>
bool MirrorOf<D>::is_member_or_body(std::size_t g) const
{
	const int owner = stepper->settings().grains[g].body;
	return owner != free_grain && map.body_id[owner] >= 0;
}

/// Remembers the present contents of O.bodies, to detect later changes by other code.
template <int D>
void MirrorOf<D>::remember_what_is_written()
{
	written.clear();
	written.reserve(map.grain_id.size());
	for (const int id : map.grain_id) {
		Written none;
		std::memset(&none, 0, sizeof none);
		written.push_back(scene().bodies->exists(id) ? written_in(body_of_yade(id)) : none);
	}
	open = true;
}

/// Applies changes that other code has made to grains since all were last written: a changed motion is taken over at once, for
/// any other change the scene is read again.
template <int D>
void MirrorOf<D>::hear_bodies()
{
	if (!open) return;
	bool anew = false;
	std::vector<std::size_t> moved;
	constexpr int first_spin = D == 2 ? 2 : 0;
	for (std::size_t g = 0; g < written.size(); ++g) {
		const int id = map.grain_id[g];
		if (!scene().bodies->exists(id)) continue;  // require_bodies raises the error
		Written now = written_in(body_of_yade(id));
		const Written& then = written[g];
		if (now == then) continue;
		if (now.material != then.material)
			throw std::runtime_error(
				"GrainLoop: body " + std::to_string(id) +
				" was given another material, which does not change its contacts; assign GrainLoop.friction, young, "
				"... if they shall change, and then call read(), or use YADE's loop");
		const bool free = is_free(g);
		if (free || is_member_or_body(g)) std::copy(then.place, then.place + D, now.place);
		std::copy(then.velocity, then.velocity + D, now.velocity);
		std::copy(then.spin + first_spin, then.spin + 3, now.spin + first_spin);
		if (!free) now.blocked = then.blocked;  // handled at every step by follow_bodies or read_anew_what_changed
		if (!(now == then))
			anew = true;
		else if (free)
			moved.push_back(g);
	}
	if (anew) {
		build();
		remember_what_is_written();
		return;
	}
	if (moved.empty()) return;
	stepper->take_back_body_forces();
	for (const std::size_t g : moved) {
		Grain<D> grain = stepper->grain(g);
		const yade::State& state = state_of(map.grain_id[g]);
		require_finite(state, map.grain_id[g]);
		const Vec<D> place = in_loop<D>(state.pos);
		if (!std::equal(place.coordinate, place.coordinate + D, written[g].place)) grain.place = place;
		grain.velocity = in_loop<D>(state.vel), grain.spin = spin_in_loop<D>(state.angVel);
		stepper->put(g, grain);
		written[g] = written_in(body_of_yade(map.grain_id[g]));
	}
}

/// Reads the scene again if a frozen grain was set in motion, which makes it a body of its own, or if the mass, the inertia, the
/// blocked directions, the damping or the surface of a body have changed, which changes its contacts. A frozen grain that is
/// driven keeps an infinite mass. The change acts in this step, whose contacts still use the velocities of the step before, as on
/// YADE's loop.
template <int D>
void MirrorOf<D>::read_anew_what_changed()
{
	if (!set_in_motion() && !counts_otherwise()) return;
	stepper->take_back_body_forces();
	sync();
	std::map<int, RigidBody<D>> before;
	for (std::size_t b = 0; b < map.body_id.size(); ++b) before[map.body_id[b]] = stepper->bodies()[b];
	build();
	for (std::size_t b = 0; b < map.body_id.size(); ++b) {
		const RigidBody<D> was = before[map.body_id[b]];  // zero velocity if it was frozen
		if (map.body_id[b] >= 0) stepper->set_velocity(b, was.velocity, was.spin);
	}
}

template <int D>
bool MirrorOf<D>::set_in_motion() const
{
	const auto moves = [&](int id) { return scene().bodies->exists(id) && !is_frozen(state_of(id)); };
	return std::any_of(map.frozen_id.begin(), map.frozen_id.end(), moves);
}

template <int D>
typename MirrorOf<D>::Counted MirrorOf<D>::counted_now(int id) const
{
	const yade::State& s = state_of(id);
	return { s.mass, { D == 3 ? s.inertia[0] : 0, D == 3 ? s.inertia[1] : 0, s.inertia[2] },
		s.blockedDOFs == yade::State::DOF_ALL, s.isDamped, surface_of_solid(body_of_yade(id)) };
}

template <int D>
bool MirrorOf<D>::counts_otherwise() const
{
	for (std::size_t b = 0; b < counted.size(); ++b) {
		if (map.body_id[b] < 0) continue;
		const Counted now = counted_now(map.body_id[b]), &then = counted[b];
		if (now.mass != then.mass || !std::equal(now.inertia, now.inertia + 3, then.inertia) || now.held != then.held ||
			now.damped != then.damped || now.surface != then.surface)
			return true;
	}
	return false;
}

/// Refuses changed materials: contacts use the loop's own constants, so the change would have no effect.
template <int D>
void MirrorOf<D>::require_materials() const
{
	for (const KnownMaterial& known : materials) {
		const auto& now = static_cast<const yade::FrictMat&>(*known.material);
		if (now.young == known.young && now.poisson == known.poisson && now.frictionAngle == known.friction_angle) continue;
		throw std::runtime_error(
			"GrainLoop: the constants of material " + std::to_string(now.id) + " ('" + now.label +
			"') were changed, which does not change its contacts; assign GrainLoop.friction, young, ... and then "
			"call read(), or use YADE's loop");
	}
}

/// Refuses erased bodies. Those that the loop writes at every step are checked at every step, all others with `all`.
template <int D>
void MirrorOf<D>::require_bodies(bool all) const
{
	const auto require_all = [&](const std::vector<int>& ids) {
		for (const int id : ids)
			if (id >= 0 && !scene().bodies->exists(id))
				throw std::runtime_error("GrainLoop: body " + std::to_string(id) +
										 " was erased from O.bodies; call sync() before such a change and read() after it");
	};
	require_all(map.body_id);
	if (all) require_all(map.grain_id);
}

template <int D>
void MirrorOf<D>::require_spread() const
{
	if (!scene().isPeriodic) return;
	for (int axis = 0; axis < D; ++axis) {
		if (engine.periods[axis] != 0) continue;
		Real low = HUGE_VAL, high = -HUGE_VAL;
		for (std::size_t g = 0; g < stepper->size(); ++g) {
			const Grain<D> grain = stepper->grain(g);
			low = std::min(low, grain.place[axis] - grain.radius), high = std::max(high, grain.place[axis] + grain.radius);
		}
		const Real edge = scene().cell->hSize(axis, axis);
		if (high - low <= edge) continue;
		throw std::invalid_argument(std::string("GrainLoop: ") + (D == 2 ? "disks" : "spheres") + " reach over " +
									std::to_string(high - low) + " m along " + "xyz"[axis] + ", where O.cell has the period " +
									std::to_string(edge) +
									" m and GrainLoop.periods is 0; give that period, or make the cell longer");
	}
}

/// Forces that engines and O.forces have added since the last step act in this one, as in NewtonIntegrator: on free grains, on
/// bodies, and on clumps together with the forces on their members. Then the container is emptied, as by ForceResetter.
template <int D>
void MirrorOf<D>::take_outside_forces()
{
	yade::ForceContainer& forces = scene().forces;
	forces.sync();
	const bool added = forces.syncCount != engine.forces_reset_at;  // another engine may have called sync before
	if (!added && !pushed) return;
	std::vector<Push<D>> pushes;
	for (RigidBody<D>& body : stepper->bodies()) body.push = {}, body.push_torque = {};
	if (added) {
		for (std::size_t id = 0; id < map.grain_of_id.size(); ++id)
			if (scene().bodies->exists(int(id))) push_with(int(id), forces.getForce(int(id)), forces.getTorque(int(id)), pushes);
		forces.reset(scene().iter);
		engine.forces_reset_at = forces.syncCount;
	}
	stepper->set_pushes(std::move(pushes));
	pushed = added;
}

template <>
void MirrorOf<3>::refuse_off_plane(int, const Vector3r&, const Vector3r&) const
{
}

template <>
void MirrorOf<2>::refuse_off_plane(int id, const Vector3r& force, const Vector3r& torque) const
{
	const auto refuse = [&](unsigned free_in, Real part, const char* what) {
		if (part == 0 || (state_of(id).blockedDOFs & free_in)) return;
		throw std::runtime_error(
			"GrainLoop: the external " + std::string(what) + " on body " + std::to_string(id) +
			" would move it out of the plane; block its z, X and Y (blockedDOFs='zXY') or leave that part out");
	};
	refuse(yade::State::DOF_Z, force[2], "force");
	refuse(yade::State::DOF_RX, torque[0], "torque");
	refuse(yade::State::DOF_RY, torque[1], "torque");
}

template <int D>
void MirrorOf<D>::push_with(int id, const Vector3r& force, const Vector3r& torque, std::vector<Push<D>>& pushes)
{
	if (force.isZero(0) && torque.isZero(0)) return;
	if (!force.allFinite() || !torque.allFinite())
		throw std::runtime_error("GrainLoop: the external force on body " + std::to_string(id) +
								 " is not finite; look for the engine or the O.forces call that adds it");
	refuse_off_plane(id, force, torque);
	const int g = map.grain_of_id[id];
	const int owner = g >= 0 ? stepper->settings().grains[g].body : map.body_of_id[id];
	const Vec<D> f = in_loop<D>(force);
	const Spin<D> t = spin_in_loop<D>(torque);
	if (g >= 0 && owner == free_grain) {
		pushes.push_back({ std::uint32_t(g), f, t });
		return;
	}
	if (owner < 0 || map.body_id[owner] < 0) return;  // a frozen grain does not respond to forces
	RigidBody<D>& body = stepper->bodies()[owner];
	body.push += f;
	body.push_torque += t;
	if (g < 0 || map.body_id[owner] == id) return;
	body.push_torque += geometry::cross(stepper->arm(g), f);  // torque of a force on a member of a clump
}

template class MirrorOf<2>;
template class MirrorOf<3>;

}  // namespace graindrive::loop
