/// Walls and loads of GrainLoop: kept as plain numbers for O.save, brought into the running loop.
#include <cmath>

#include "engines/loop/GrainLoop.hpp"

namespace graindrive {

namespace {

void append(std::vector<Real>& numbers, const loop::Wall& w)
{
	const Real limit = std::isfinite(w.speed_limit) ? w.speed_limit : 0;  // archives hold no infinity
	numbers.insert(numbers.end(),
		{ Real(int(w.side)), w.position, w.velocity, w.slide, Real(w.pressed), w.pressure, w.mass, w.damping, limit });
}

}  // namespace

std::vector<loop::Wall> GrainLoop::walls() const
{
	const Turn turn = take_turn();
	if (stepper_) return stepper_->settings().walls;
	std::vector<loop::Wall> all;
	for (std::size_t k = 0; k + 8 < wallSettings.size(); k += 9) {
		const Real* n = wallSettings.data() + k;
		loop::Wall wall;
		wall.side = loop::Side(int(n[0]));
		wall.position = n[1], wall.velocity = n[2], wall.slide = n[3];
		wall.pressed = n[4] != 0;
		wall.pressure = n[5], wall.mass = n[6], wall.damping = n[7];
		if (n[8] > 0) wall.speed_limit = n[8];
		all.push_back(wall);
	}
	return all;
}

/// From the running loop into the attributes.
void GrainLoop::keep_walls()
{
	if (!stepper_) return;
	wallSettings.clear();
	wallSprings.clear();
	const auto& walls = stepper_->settings().walls;
	for (const loop::Wall& w : walls) append(wallSettings, w);
	for (const loop::WallTouch& t : stepper_->wall_springs())
		if (t.slip != 0)
			wallSprings.insert(wallSprings.end(), { Real(int(walls[t.wall].side)), Real(map_.grain_id[t.grain]), t.slip });
}

/// Springs of walls and loads from the attributes into a loop that was just built.
void GrainLoop::bring_walls()
{
	std::vector<loop::WallTouch> touches;
	const auto& walls = stepper_->settings().walls;
	for (std::size_t k = 0; k + 2 < wallSprings.size(); k += 3) {
		const auto id = std::size_t(wallSprings[k + 1]);
		if (id >= map_.grain_of_id.size() || map_.grain_of_id[id] < 0) continue;
		for (std::uint32_t w = 0; w < walls.size(); ++w)
			if (int(walls[w].side) == int(wallSprings[k]))
				touches.push_back(loop::WallTouch{ w, std::uint32_t(map_.grain_of_id[id]), wallSprings[k + 2] });
	}
	stepper_->set_wall_springs(touches);
	bring_loads();
}

void GrainLoop::bring_loads()
{
	for (std::size_t k = 0; k + 2 < loads.size(); k += 3) {
		const auto id = std::size_t(loads[k]);
		if (id >= map_.body_of_id.size() || map_.body_of_id[id] < 0) continue;
		loop::RigidBody& body = stepper_->bodies()[map_.body_of_id[id]];
		body.load_x = loads[k + 1], body.load_y = loads[k + 2];
	}
}

void GrainLoop::set_wall(const loop::Wall& wall)
{
	const Turn turn = take_turn();
	if (stepper_) {
		stepper_->set_wall(wall);
		keep_walls();
		return;
	}
	std::vector<Real> others;
	for (std::size_t k = 0; k + 8 < wallSettings.size(); k += 9)
		if (int(wallSettings[k]) != int(wall.side))
			others.insert(others.end(), wallSettings.begin() + k, wallSettings.begin() + k + 9);
	append(others, wall);
	wallSettings = others;
}

void GrainLoop::remove_wall(loop::Side side)
{
	const Turn turn = take_turn();
	if (stepper_) {
		stepper_->remove_wall(side);
		keep_walls();
		return;
	}
	for (std::size_t k = 0; k + 8 < wallSettings.size(); k += 9)
		if (int(wallSettings[k]) == int(side)) {
			wallSettings.erase(wallSettings.begin() + k, wallSettings.begin() + k + 9);
			return;
		}
}

void GrainLoop::set_load(int id, const Vector3r& force)
{
	const Turn turn = take_turn();
	body_index(id);  // a free disk becomes a body
	if (map_.body_of_id[id] < 0)
		throw std::invalid_argument(
			"GrainLoop.setLoad: body " + std::to_string(id) + " does not move; free one of its directions first");
	for (std::size_t k = 0; k + 2 < loads.size(); k += 3)
		if (int(loads[k]) == id) {
			loads.erase(loads.begin() + k, loads.begin() + k + 3);
			break;
		}
	loads.insert(loads.end(), { Real(id), force[0], force[1] });
	bring_loads();
}

}  // namespace graindrive
