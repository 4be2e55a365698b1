/// What the energy ledger is told of a step: remembered before anything moves, booked when all has moved.
#include <cmath>
#include <stdexcept>

#include "engines/loop/guards.hpp"
#include "engines/loop/pair_geometry.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

/// YADE's own laws lengthen what they remember by another velocity than the one that their force works on, and what damping takes depends
/// on the sum of all forces: neither has entries that are exact.
void require_explicable(const Scene& scene)
{
	const auto remembers_force = [](const auto& law) { return law.remembers_force; };
	const auto remembers_length = [](const auto& law) { return !law.remembers_force; };
	if (std::visit(remembers_force, scene.law))
		throw std::invalid_argument("the energy ledger knows no exact entries for the laws " + laws::laws_that_remember_forces() +
									"; switch trackEnergy off, or take " +
									laws::listed(laws::names_where(remembers_length), " or "));
	if (scene.damping > 0)
		throw std::invalid_argument(
			sentence("the energy ledger needs damping = 0, got ", scene.damping, "; switch trackEnergy off, or damping"));
}

}  // namespace

void Stepper::track_energy(bool on)
{
	if (on == bool(books)) return;
	if (body_forces_known) throw std::runtime_error("the energy ledger opens and closes between steps, and a step is under way");
	books.reset();
	if (on) require_explicable(state.scene);
	if (on) books.reset(new Books{ EnergyLedger(state.scene.law, state.scene.friction, state.scene.dt), {}, {}, {}, {}, {} });
}

const EnergyLedger* Stepper::energy_ledger() const { return books ? &books->ledger : nullptr; }
EnergyLedger* Stepper::energy_ledger() { return books ? &books->ledger : nullptr; }

void Stepper::remember_for_books()
{
	books->rows = state.rows;
	books->bodies = state.scene.bodies;
	books->walls = state.scene.walls;
	books->slips.resize(pairs.place.size());
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) books->slips[c] = pairs.place[c] ? pairs.slip(c) : 0;
}

/// Velocity and surface speed of a grain after the step, where it was at the step.
SurfaceMotion Stepper::motion_after(std::uint32_t at) const
{
	const GrainRow &row = state.rows[at], &before = books->rows[at];
	if (at < n_free) return motion_of(row);
	const Member& member = state.members[at - n_free];
	const RigidBody &body = state.scene.bodies[member.body], &was = books->bodies[member.body];
	const double arm_x = before.x - member.shift_x - was.x, arm_y = before.y - member.shift_y - was.y;
	return { body.vx - body.spin * arm_y, body.vy + body.spin * arm_x, body.spin * row.radius };
}

/// A contact at a step: `before` is what the law was told, the rest of the velocities belong to the half step after it.
template <class Other>
void Stepper::meet(std::uint64_t key, const Placement& at, const GrainRow& row, const Other& other, const SurfaceMotion& after,
	const SurfaceMotion& after_other, double slip)
{
	const auto before = kinematics(at, row, other, state.scene.dt);
	const auto then = relative_motion(at.normal, after, after_other);
	books->met.push_back({ key, before.overlap, before.effective_radius, before.effective_mass, before.normal_velocity,
		then.normal, before.tangential_velocity, then.tangential, slip });
}

void Stepper::meet_pairs()
{
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) {
		if (!pairs.place[c]) continue;
		const std::uint32_t i = state.candidates[c].first, j = state.candidates[c].second;
		const GrainRow &a = books->rows[i], &b = books->rows[j];
		const Placement at = placement(a, b, state.scene.box);
		if (!(at.overlap > 0)) continue;
		const std::uint64_t one = std::min(state.index_of[i], state.index_of[j]),
							other = std::max(state.index_of[i], state.index_of[j]);
		meet(one << 32 | other, at, a, b, motion_after(i), motion_after(j), books->slips[c]);
	}
}

void Stepper::meet_walls(LedgerMotion& motion)
{
	const double half = state.scene.dt / 2;
	for (const WallTouch& touch : state.wall_touches) {
		if (!(touch.overlap > 0)) continue;
		const Wall &was = books->walls[touch.wall], &is = state.scene.walls[touch.wall];
		const std::uint32_t at = row_of[touch.grain];
		const GrainRow& row = books->rows[at];
		const std::uint64_t one = touch.grain, side = 0xffffffff - static_cast<int>(was.side);
		meet(one << 32 | side, placement(row, was), row, was, motion_after(at), motion_of(is), touch.slip_before);
	}
	for (std::size_t w = 0; w < state.scene.walls.size(); ++w) {
		const Wall &was = books->walls[w], &is = state.scene.walls[w];
		motion.walls.before -= (is.force_x * was.velocity_x() + is.force_y * was.velocity_y()) * half;
		motion.walls.after -= (is.force_x * is.velocity_x() + is.force_y * is.velocity_y()) * half;
	}
}

void Stepper::move_in_books(LedgerMotion& motion)
{
	const double half = state.scene.dt / 2, g_x = state.scene.gravity_x, g_y = state.scene.gravity_y;
	const auto weigh = [&](double mass, double g, bool periodic, double at, double v, double v_after) {
		if (periodic)  // there is no height: what falls is added up
			motion.falling.before -= mass * g * v * half, motion.falling.after -= mass * g * v_after * half;
		else
			motion.potential -= mass * g * at;
	};
	for (std::uint32_t g = 0; g < n_grains; ++g) {
		const std::uint32_t at = row_of[g];
		if (at >= n_free) continue;
		const GrainRow &was = books->rows[at], &is = state.rows[at];
		const double mass = 1 / was.inverse_mass;
		motion.translation += 0.5 * mass * (was.vx * is.vx + was.vy * is.vy);
		if (state.scene.rotation)
			motion.rotation += 0.5 * mass * was.surface_speed * is.surface_speed / state.scene.spin_response;
		weigh(mass, g_x, state.scene.box.periodic_x, was.x, was.vx, is.vx);
		weigh(mass, g_y, state.scene.box.periodic_y, was.y, was.vy, is.vy);
	}
	for (const Push& push : state.pushes) {
		const GrainRow &was = books->rows[row_of[push.grain]], &is = state.rows[row_of[push.grain]];
		const double surface_force = push.torque / is.radius;
		motion.loads.before += (push.x * was.vx + push.y * was.vy + surface_force * was.surface_speed) * half;
		motion.loads.after += (push.x * is.vx + push.y * is.vy + surface_force * is.surface_speed) * half;
	}
	motion.bodies.resize(state.scene.bodies.size());
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		const RigidBody &was = books->bodies[b], &is = state.scene.bodies[b];
		const auto axis = [&](bool responds, double inertia, double force, double load, double v, double v_after,
							  double& kinetic) {
			if (responds) {
				kinetic += 0.5 * inertia * v * v_after;
				motion.loads.before += load * v * half, motion.loads.after += load * v_after * half;
			} else {
				motion.bodies[b].before -= force * v * half, motion.bodies[b].after -= force * v_after * half;
			}
		};
		axis(is.responds_x, is.mass, is.force_x, is.load_x + is.push_x, was.vx, is.vx, motion.translation);
		axis(is.responds_y, is.mass, is.force_y, is.load_y + is.push_y, was.vy, is.vy, motion.translation);
		axis(is.responds_spin, is.inertia, is.torque, is.push_torque, was.spin, is.spin, motion.rotation);
		if (is.responds_x) weigh(is.mass, g_x, state.scene.box.periodic_x, was.x, was.vx, is.vx);
		if (is.responds_y) weigh(is.mass, g_y, state.scene.box.periodic_y, was.y, was.vy, is.vy);
	}
}

void Stepper::book_energy()
{
	books->met.clear();
	LedgerMotion motion;
	meet_pairs();
	meet_walls(motion);
	move_in_books(motion);
	books->ledger.book(books->met, motion);
}

}  // namespace graindrive::loop
