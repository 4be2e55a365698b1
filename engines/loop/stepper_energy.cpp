/// What the energy ledger is told of a step: remembered before anything moves, booked when all has moved.
#include <cmath>
#include <stdexcept>

#include "engines/loop/guards.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

/// YADE's own laws lengthen what they remember by another velocity than the one that their force works on, and what damping takes depends
/// on the sum of all forces: neither has entries that are exact.
void require_explicable(const Scene& scene)
{
	if (std::visit([](const auto& law) { return law.remembers_force; }, scene.law))
		throw std::invalid_argument(
			"the energy ledger knows no exact entries for the laws cundallStrack and hertzMindlin; switch "
			"trackEnergy off, or take hertzHistory, hertzRestitution or springDashpot");
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
Stepper::Motion Stepper::motion_after(std::uint32_t at) const
{
	const GrainRow &row = state.rows[at], &before = books->rows[at];
	if (at < n_free) return { row.vx, row.vy, row.surface_speed };
	const Member& member = state.members[at - n_free];
	const RigidBody &body = state.scene.bodies[member.body], &was = books->bodies[member.body];
	const double arm_x = before.x - member.shift_x - was.x, arm_y = before.y - member.shift_y - was.y;
	return { body.vx - body.spin * arm_y, body.vy + body.spin * arm_x, body.spin * row.radius };
}

void Stepper::meet_pairs()
{
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) {
		if (!pairs.place[c]) continue;
		const std::uint32_t i = state.candidates[c].first, j = state.candidates[c].second;
		const GrainRow &a = books->rows[i], &b = books->rows[j];
		const Separation d = separation(a, b, state.scene.box);
		const double r = std::hypot(d.x, d.y), overlap = a.radius + b.radius - r;
		if (!(overlap > 0)) continue;
		const double n_x = d.x / r, n_y = d.y / r, inverse_mass = a.inverse_mass + b.inverse_mass;
		const Motion after_a = motion_after(i), after_b = motion_after(j);
		const auto normal = [&](double dvx, double dvy) { return dvx * n_x + dvy * n_y; };
		const auto tangential = [&](double dvx, double dvy) { return dvx * n_y - dvy * n_x; };
		const std::uint64_t one = std::min(state.index_of[i], state.index_of[j]),
							other = std::max(state.index_of[i], state.index_of[j]);
		books->met.push_back(
			{ one << 32 | other, overlap, a.radius * b.radius / (a.radius + b.radius), inverse_mass > 0 ? 1 / inverse_mass : 0,
				normal(b.vx - a.vx, b.vy - a.vy), normal(after_b.vx - after_a.vx, after_b.vy - after_a.vy),
				a.surface_speed + b.surface_speed + tangential(b.vx - a.vx, b.vy - a.vy),
				after_a.surface_speed + after_b.surface_speed + tangential(after_b.vx - after_a.vx, after_b.vy - after_a.vy),
				books->slips[c] });
	}
}

void Stepper::meet_walls(LedgerMotion& motion)
{
	const double half = state.scene.dt / 2;
	for (const WallTouch& touch : state.wall_touches) {
		if (!(touch.overlap > 0)) continue;
		const Wall &was = books->walls[touch.wall], &is = state.scene.walls[touch.wall];
		const double n_x = was.across_x() ? was.outward() : 0, n_y = was.across_x() ? 0 : was.outward();
		const std::uint32_t at = row_of[touch.grain];
		const GrainRow& row = books->rows[at];
		const Motion after = motion_after(at);
		const auto normal = [&](double dvx, double dvy) { return dvx * n_x + dvy * n_y; };
		const auto tangential = [&](double dvx, double dvy) { return dvx * n_y - dvy * n_x; };
		const std::uint64_t one = touch.grain, side = 0xffffffff - static_cast<int>(was.side);
		books->met.push_back({ one << 32 | side, touch.overlap, row.radius, row.inverse_mass > 0 ? 1 / row.inverse_mass : 0,
			normal(was.velocity_x() - row.vx, was.velocity_y() - row.vy),
			normal(is.velocity_x() - after.vx, is.velocity_y() - after.vy),
			row.surface_speed + tangential(was.velocity_x() - row.vx, was.velocity_y() - row.vy),
			after.surface_speed + tangential(is.velocity_x() - after.vx, is.velocity_y() - after.vy), touch.slip_before });
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
