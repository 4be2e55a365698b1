/// Collects the contacts, motions and works of a step for the energy ledger.
#include "engines/loop/books.hpp"

#include <cmath>
#include <utility>

#include "engines/loop/guards.hpp"

namespace graindrive::loop {

namespace {

using geometry::cross;
using geometry::dot;

bool turns_exactly(const RigidBody<2>&) { return true; }
bool turns_exactly(const RigidBody<3>& body)
{
	const Vec<3>& i = body.inertia;
	return !(body.turns[0] && body.turns[1] && body.turns[2]) || (i[0] == i[1] && i[1] == i[2]);
}

double axis_of_spin(double spin, int) { return spin; }
double axis_of_spin(const Vec<3>& spin, int k) { return spin[k]; }

/// Moment of inertia about an axis of the world, of a body that turns about one axis only or whose three moments are equal.
double moment_about(const RigidBody<2>& body, int) { return body.inertia; }
double moment_about(const RigidBody<3>& body, int k)
{
	const Vec<3> axis = body.turn.undo(Vec<3>::along(k));
	double sum = 0;
	for (int q = 0; q < 3; ++q) sum += body.inertia[q] * axis[q] * axis[q];
	return sum;
}

}  // namespace

/// Refuses scenes for which the ledger has no exact entries. YADE's own laws increase their tangential force with another
/// velocity than the one at which this force does work; the loss by non-viscous damping depends on the sum of all forces; the
/// spin of a tumbling body changes without a torque.
template <int D>
void require_explicable(const Scene<D>& scene)
{
	const auto remembers_force = [](const auto& law) { return law.remembers_force; };
	const auto remembers_length = [](const auto& law) { return !law.remembers_force; };
	if (std::visit(remembers_force, scene.law))
		throw std::invalid_argument("the energy ledger has no exact entries for the laws " + laws::laws_that_remember_forces() +
									"; switch trackEnergy off, or take " +
									laws::listed(laws::names_where(remembers_length), " or "));
	if (scene.damping > 0)
		throw std::invalid_argument(
			sentence("the energy ledger needs damping = 0, got ", scene.damping, "; switch trackEnergy off, or damping"));
	for (std::size_t b = 0; b < scene.bodies.size(); ++b)
		if (!turns_exactly(scene.bodies[b]))
			throw std::invalid_argument(sentence("the energy ledger has no exact entries for a body with different moments of "
												 "inertia that turns about all axes, got body ",
				b, "; switch trackEnergy off, or block two of its rotations"));
}

/// Velocity and surface speed of a grain after the step, at the place that it had at the step.
template <int D>
SurfaceMotion<D> Books<D>::motion_after(std::uint32_t at) const
{
	const Row<D>&row = state.rows[at], &before = rows[at];
	if (at < state.n_free) return motion_of(row);
	const Member<D>& member = state.members[at - state.n_free];
	const RigidBody<D>&body = state.scene.bodies[member.body], &was = bodies[member.body];
	const Vec<D> arm = before.x - member.shift - was.place;
	return { body.velocity + cross(body.spin, arm), body.spin * row.radius };
}

/// Enters a contact. `before` is the relative velocity half a step earlier, which the law received; `after` is that half a step
/// later.
template <int D>
void Books<D>::meet(std::uint64_t key, const Placement<D>& at, double radius, double mass, const RelativeMotion<D>& before,
	const RelativeMotion<D>& after, const Tangent<D>& slip, const Vec<D>& image_before, const Vec<D>& image_after)
{
	met.push_back({ key, at.overlap, radius, mass, at.normal, before.normal, after.normal, before.tangential, after.tangential,
		slip, image_before, image_after });
}

template <int D>
void Books<D>::meet_pairs()
{
	for (auto [i, j, slip] : selected) {
		if constexpr (D == 3)  // a search may swap i and j, but the ledger remembers vectors that act on the first
			if (state.index_of[i] > state.index_of[j]) std::swap(i, j), slip = -slip;
		const Row<D>&a = rows[i], &b = rows[j];
		const Placement<D> at = placement<D>(a, b, state.scene.cell);
		if (!(at.overlap > 0)) continue;
		const Cell<D>& cell = state.scene.cell;
		const double layers = cell.sheared() ? -cell.nearest(b.x - a.x).periods[cell.across] : 0;
		const Vec<D> image_before = layers * cell.image_velocity(), image_after = layers * state.flow.image_velocity;
		SurfaceMotion<D> b_before = motion_of(b), b_after = motion_after(j);
		b_before.velocity += image_before, b_after.velocity += image_after;
		const std::uint64_t one = std::min(state.index_of[i], state.index_of[j]),
							other = std::max(state.index_of[i], state.index_of[j]);
		const double mass = [&] {
			if constexpr (D == 2) return laws::effective_mass(a.inverse_mass + b.inverse_mass);
			return laws::effective_mass(state.inverse_mass(i) + state.inverse_mass(j));
		}();
		meet(one << 32 | other, at, laws::effective_radius(a.radius, b.radius), mass,
			relative_motion(at.normal, motion_of(a), b_before), relative_motion(at.normal, motion_after(i), b_after), slip,
			image_before, image_after);
	}
}

template <int D>
void Books<D>::meet_surface(const SurfaceTouch<D>& touch)
{
	constexpr std::uint64_t last = 0xffffffff;
	const std::uint32_t at = state.row_of[touch.grain];
	const Row<D>& row = rows[at];
	const Placement<D> place{ touch.normal, touch.overlap };
	SurfaceMotion<D> before, after;
	std::uint64_t side = 0;
	if (surfaces.is_wall(touch.surface)) {
		const Wall<D>&was = walls[touch.surface], &is = state.scene.walls[touch.surface];
		before = { was.surface_velocity(), {} }, after = { is.surface_velocity(), {} };
		side = last - std::uint64_t(was.side);
	} else {
		const int b = surfaces.solid(touch.surface).body;
		const RigidBody<D>&was = bodies[b], &is = state.scene.bodies[b];
		const Vec<D> arm =
			surfaces.seen_from_solid(touch.surface, was, row.x) - was.place + (row.radius - touch.overlap / 2) * touch.normal;
		before = { was.velocity + cross(was.spin, arm), {} }, after = { is.velocity + cross(is.spin, arm), {} };
		side = last - 2 * D - (touch.surface - walls.size());
	}
	meet(std::uint64_t(touch.grain) << 32 | side, place, row.radius, surfaces.effective_mass_at(touch),
		relative_motion(touch.normal, motion_of(row), before), relative_motion(touch.normal, motion_after(at), after),
		touch.slip_before);
}

template <int D>
void Books<D>::meet_surfaces(LedgerMotion& motion)
{
	const double half = state.scene.dt / 2;
	for (const SurfaceTouch<D>& touch : state.touches)
		if (touch.overlap > 0) meet_surface(touch);
	for (std::size_t w = 0; w < walls.size(); ++w) {
		const Vec<D>& force = state.scene.walls[w].force;
		motion.walls.before -= dot(force, walls[w].surface_velocity()) * half;
		motion.walls.after -= dot(force, state.scene.walls[w].surface_velocity()) * half;
	}
}

template <int D>
void Books<D>::weigh(LedgerMotion& motion, double mass, const Vec<D>& place, const Vec<D>& v, const Vec<D>& v_after,
	const std::array<bool, D>& along) const
{
	const double half = state.scene.dt / 2;
	for (int k = 0; k < D; ++k) {
		if (!along[k]) continue;
		const double g = state.scene.gravity[k];
		if (state.scene.cell.periodic[k])  // a height is not defined: the work of gravity is added up instead
			motion.falling.before -= mass * g * v[k] * half, motion.falling.after -= mass * g * v_after[k] * half;
		else
			motion.potential -= mass * g * place[k];
	}
}

template <int D>
void Books<D>::move_grains(LedgerMotion& motion) const
{
	const double half = state.scene.dt / 2;
	std::array<bool, D> all_axes;
	all_axes.fill(true);
	for (std::uint32_t g = 0; g < state.n; ++g) {
		const std::uint32_t at = state.row_of[g];
		if (at >= state.n_free) continue;
		const Row<D>&was = rows[at], &is = state.rows[at];
		const double mass = 1 / state.inverse_mass(at);
		motion.translation += 0.5 * mass * dot(was.v, is.v);
		if (state.scene.rotation) motion.rotation += 0.5 * mass * inner(was.surface, is.surface) / state.scene.spin_response;
		weigh(motion, mass, was.x, was.v, is.v, all_axes);
	}
	for (const Push<D>& push : state.pushes) {
		const Row<D>&was = rows[state.row_of[push.grain]], &is = state.rows[state.row_of[push.grain]];
		const Spin<D> surface_force = push.torque / is.radius;
		motion.loads.before += (dot(push.force, was.v) + inner(surface_force, was.surface)) * half;
		motion.loads.after += (dot(push.force, is.v) + inner(surface_force, is.surface)) * half;
	}
}

template <int D>
void Books<D>::move_bodies(LedgerMotion& motion) const
{
	const double half = state.scene.dt / 2;
	motion.bodies.resize(bodies.size());
	for (std::size_t b = 0; b < bodies.size(); ++b) {
		if (state.body_fixed[b]) continue;
		const RigidBody<D>&was = bodies[b], &is = state.scene.bodies[b];
		const auto axis = [&](bool responds, double inertia, double force, double load, double v, double v_after,
							  double& kinetic) {
			if (responds) {
				kinetic += 0.5 * inertia * v * v_after;
				motion.loads.before += load * v * half, motion.loads.after += load * v_after * half;
			} else {
				motion.bodies[b].before -= force * v * half, motion.bodies[b].after -= force * v_after * half;
			}
		};
		for (int k = 0; k < D; ++k)
			axis(is.responds[k], is.mass, is.force[k], is.load[k] + is.push[k], was.velocity[k], is.velocity[k],
				motion.translation);
		for (int k = 0; k < spin_axes(D); ++k)
			axis(is.turns[k], moment_about(is, k), axis_of_spin(is.torque, k), axis_of_spin(is.push_torque, k),
				axis_of_spin(was.spin, k), axis_of_spin(is.spin, k), motion.rotation);
		weigh(motion, is.mass, was.place, was.velocity, is.velocity, is.responds);
	}
}

template <int D>
void Books<D>::deform_cell(LedgerMotion& motion) const
{
	if (!changes_flow(state)) return;
	for (std::uint32_t at = 0; at < state.n_free; ++at) {
		const Row<D>&was = rows[at], &is = state.rows[at];
		const double half_mass = 0.5 / state.inverse_mass(at);
		const Vec<D> kick = flow_kick(state, was.x);
		motion.cell.before += half_mass * dot(kick, was.v), motion.cell.after += half_mass * dot(kick, is.v);
		if (!state.scene.rotation) continue;
		const Spin<D> turn = state.flow.spin * (was.radius / state.scene.spin_response);
		motion.cell.before += half_mass * inner(turn, was.surface), motion.cell.after += half_mass * inner(turn, is.surface);
	}
}

template <int D>
void Books<D>::book()
{
	met.clear();
	LedgerMotion motion;
	meet_pairs();
	meet_surfaces(motion);
	move_grains(motion);
	move_bodies(motion);
	deform_cell(motion);
	ledger.book(met, motion);
}

template void require_explicable(const Scene<2>&);
template void require_explicable(const Scene<3>&);
template class Books<2>;
template class Books<3>;

}  // namespace graindrive::loop
