/// What passes between GrainLoop and YADE's bodies: driven bodies at every step, all of them where anyone can look.
#include <cmath>

#include "engines/loop/GrainLoop.hpp"

namespace graindrive {

/// Drives and Python move bodies by writing into YADE's: place, velocity, turn and freedoms are heard at every step.
void GrainLoop::follow_bodies()
{
	for (std::size_t b = 0; b < map_.body_id.size(); ++b) {
		if (map_.body_id[b] < 0) continue;
		const yade::State& state = *(*scene->bodies)[map_.body_id[b]]->state;
		loop::RigidBody& body = stepper_->bodies()[b];
		loop::read_state(state, body);
		body.x = state.pos[0], body.y = state.pos[1];
		const Quaternionr shown = loop::orientation(body, map_.turned[b]);
		if (state.ori.coeffs() != shown.coeffs()) body.angle += turn_in_plane(shown, state.ori, map_.body_id[b]);
	}
}

/// The angle about z from one orientation to another [rad].
Real GrainLoop::turn_in_plane(const Quaternionr& from, const Quaternionr& to, int id)
{
	const Quaternionr turn = to * from.conjugate();
	if (std::hypot(turn.x(), turn.y()) > 1e-9)
		throw std::runtime_error(
			"GrainLoop: body " + std::to_string(id) + " was turned out of the plane; GrainLoop turns bodies about z alone");
	return 2 * std::atan2(turn.z() * (turn.w() < 0 ? -1 : 1), std::abs(turn.w()));
}

void GrainLoop::write_bodies()
{
	for (std::size_t b = 0; b < map_.body_id.size(); ++b)
		if (map_.body_id[b] >= 0)
			loop::write_state(stepper_->bodies()[b], map_.turned[b], *(*scene->bodies)[map_.body_id[b]]->state);
}

void GrainLoop::show_bodies()
{
	const Turn turn = take_turn();
	if (!open_) sync();
}

void GrainLoop::sync()
{
	const Turn turn = take_turn();
	if (!stepper_ || !scene || read_from_ != scene) return;
	stepper_->take_back_body_forces();  // they have moved springs that are shown here
	// YADE counts the windings of a periodic box. No sum over syncs: results must not depend on how often somebody looks.
	const auto unwound = [](Real now, Real before, Real period) {
		return period > 0 ? now + period * std::nearbyint((before - now) / period) : now;
	};
	for (std::size_t g = 0; g < map_.grain_id.size(); ++g) {
		if (!scene->bodies->exists(map_.grain_id[g])) continue;
		const loop::Grain now = stepper_->grain(g);
		yade::State& state = *(*scene->bodies)[map_.grain_id[g]]->state;
		if (now.body != loop::free_grain && (map_.body_id[now.body] < 0 || map_.body_id[now.body] == map_.grain_id[g])) continue;
		if (now.body == loop::free_grain) {
			state.pos[0] = unwound(now.x, state.pos[0], periods[0]);
			state.pos[1] = unwound(now.y, state.pos[1], periods[1]);
		} else {  // beside its clump, as YADE has it
			const Vector2r arm = stepper_->arm(g);
			state.pos[0] = stepper_->bodies()[now.body].x + arm[0];
			state.pos[1] = stepper_->bodies()[now.body].y + arm[1];
		}
		state.vel[0] = now.vx, state.vel[1] = now.vy;
		state.angVel[2] = now.spin;
		state.angMom[2] = now.spin * state.inertia[2];
	}
	keep_walls();
	springs.clear();
	for (const loop::Spring& s : stepper_->springs())
		springs.insert(springs.end(), { Real(map_.grain_id[s.first]), Real(map_.grain_id[s.second]), s.slip });
	remember_what_is_written();
}

void GrainLoop::read()
{
	const Turn turn = take_turn();
	keep_walls();
	stepper_.reset();
	open_ = false;
}

void GrainLoop::begin_on_step()
{
	const Turn turn = take_turn();
	stepper().begin_on_step();
	open_ = false;
	write_bodies();
}

/// The springs of the last sync between disks that are there still.
std::vector<loop::Spring> GrainLoop::kept_springs() const
{
	const auto grain_of = [&](Real id) {
		return id >= 0 && id < map_.grain_of_id.size() ? map_.grain_of_id[std::size_t(id)] : -1;
	};
	std::vector<loop::Spring> kept;
	for (std::size_t k = 0; k + 2 < springs.size(); k += 3) {
		const int a = grain_of(springs[k]), b = grain_of(springs[k + 1]);
		if (a >= 0 && b >= 0) kept.push_back({ std::uint32_t(a), std::uint32_t(b), springs[k + 2] });
	}
	return kept;
}

}  // namespace graindrive
