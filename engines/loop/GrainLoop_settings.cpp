/// Changes of settings and of the cell while GrainLoop runs; walls and loads as lists of numbers, which O.save can write.
#include <cmath>

#include "engines/loop/GrainLoop.hpp"
#include "engines/loop/yade_cell.hpp"

namespace graindrive {

namespace {

constexpr const char* kept_by_the_loop[] = { "springs", "wallSprings", "wallSettings" };

void append(std::vector<Real>& numbers, const loop::Wall<3>& w)
{
	const Real limit = std::isfinite(w.speed_limit) ? w.speed_limit : 0;  // 0: no limit, since archives cannot hold infinity
	numbers.insert(numbers.end(), { Real(int(w.side)), w.position, w.velocity, w.slide[0], w.slide[1], w.slide[2],
									  Real(w.pressed), w.pressure, w.mass, w.damping, limit });
}

}  // namespace

/// Called when an attribute was set. Attributes that the running loop itself writes for O.save cannot be set while it runs.
void GrainLoop::assigned(const std::string& name)
{
	for (const char* kept : kept_by_the_loop)
		if (mirror_ && name == kept)
			throw std::invalid_argument(
				"GrainLoop." + name +
				" is kept by the running loop and cannot be set; use setWall, or call sync(), set it after "
				"read() and go on");
	settings_changed_ = true;
}

/// Applies settings that Python changed: settings of the kernels are changed in the running loop; settings that decide which
/// grains are bodies need a new reading of the scene.
void GrainLoop::hear_settings()
{
	if (!settings_changed_) return;
	settings_changed_ = false;
	if (dimensions != built_dimensions_)
		throw std::invalid_argument("GrainLoop.dimensions is " + std::to_string(built_dimensions_) +
									" in the running loop and cannot be changed; call sync(), set it, and then read()");
	if (watched != built_watched_ || periods != built_periods_) {
		sync();
		build();
		return;
	}
	mirror_->change_settings();
	mirror_->bring_loads();
	met_engines_.clear();  // `trusted` may have changed
}

/// Checks a cell that has moved or deformed. The loop over disks follows it (yade_cell.hpp), with the cell's length in y as its
/// period.
void GrainLoop::require_cell()
{
	if (!scene->isPeriodic) return;
	const yade::Cell& cell = *scene->cell;
	loop::require_flow(cell, dimensions);
	if (loop::deforms(cell) && periods[1] > 0) periods[1] = cell.hSize(1, 1);
	if (!mirror_ || cell.hSize == built_cell_) return;
	if (built_deforming_) built_periods_[1] = periods[1];
	require_periods();
}

/// Takes over tilt, height and velocity of O.cell if YADE has deformed it since the last step.
void GrainLoop::follow_cell()
{
	if (!scene->isPeriodic || !loop::deforms(*scene->cell)) return;
	if (!built_deforming_) {
		sync();
		build();
		return;
	}
	if (scene->cell->hSize == followed_) return;
	followed_ = scene->cell->hSize;
	mirror_->follow_cell();
}

std::vector<loop::Wall<3>> GrainLoop::kept_walls() const
{
	std::vector<loop::Wall<3>> all;
	for (std::size_t k = 0; k + numbers_per_wall <= wallSettings.size(); k += numbers_per_wall) {
		const Real* n = wallSettings.data() + k;
		loop::Wall<3> wall;
		wall.side = loop::Side(int(n[0]));
		wall.position = n[1], wall.velocity = n[2], wall.slide = { n[3], n[4], n[5] };
		wall.pressed = n[6] != 0;
		wall.pressure = n[7], wall.mass = n[8], wall.damping = n[9];
		if (n[10] > 0) wall.speed_limit = n[10];
		all.push_back(wall);
	}
	return all;
}

void GrainLoop::keep_walls(const std::vector<loop::Wall<3>>& walls)
{
	wallSettings.clear();
	for (const loop::Wall<3>& wall : walls) append(wallSettings, wall);
}

std::vector<loop::Wall<3>> GrainLoop::walls() const
{
	const Turn turn = take_turn();
	return mirror_ ? mirror_->walls() : kept_walls();
}

void GrainLoop::set_wall(const loop::Wall<3>& wall)
{
	const Turn turn = take_turn();
	if (mirror_) return mirror_->set_wall(wall);
	std::vector<loop::Wall<3>> all;
	for (const loop::Wall<3>& other : kept_walls())
		if (other.side != wall.side) all.push_back(other);
	all.push_back(wall);
	keep_walls(all);
}

void GrainLoop::remove_wall(loop::Side side)
{
	const Turn turn = take_turn();
	if (mirror_) return mirror_->remove_wall(side);
	std::vector<loop::Wall<3>> others;
	for (const loop::Wall<3>& wall : kept_walls())
		if (wall.side != side) others.push_back(wall);
	keep_walls(others);
}

loop::Side GrainLoop::side_named(const std::string& name) const
{
	return dimensions == 3 ? loop::side_named<3>(name) : loop::side_named<2>(name);
}

void GrainLoop::set_load(int id, const Vector3r& force)
{
	const Turn turn = take_turn();
	if (!force.allFinite())
		throw std::invalid_argument(
			"GrainLoop.setLoad: the force on body " + std::to_string(id) + " must be finite, got one that is not");
	running();
	if (id < 0 || !scene->bodies->exists(id))
		throw std::invalid_argument(
			"GrainLoop.setLoad: body " + std::to_string(id) + " is not in O.bodies; give the id that O.bodies.append returned");
	mirror_->body_index(id);  // makes a body of a free grain: only bodies take loads
	if (mirror_->map.body_of_id[id] < 0)
		throw std::invalid_argument(
			"GrainLoop.setLoad: body " + std::to_string(id) + " does not move; free one of its directions first");
	if (dimensions == 2 && force[2] != 0)
		throw std::invalid_argument("GrainLoop.setLoad: a load on a disk must lie in the plane, got F_z = " +
									std::to_string(force[2]) + " N; leave it out, or set GrainLoop.dimensions to 3");
	for (std::size_t k = 0; k + 3 < loads.size(); k += 4)
		if (int(loads[k]) == id) {
			loads.erase(loads.begin() + k, loads.begin() + k + 4);
			break;
		}
	loads.insert(loads.end(), { Real(id), force[0], force[1], force[2] });
	mirror_->bring_loads();
}

}  // namespace graindrive
