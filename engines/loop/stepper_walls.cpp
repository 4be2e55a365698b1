/// Flat walls in a step: forces before anything moves, given to the grains after the sweep. Few grains touch a wall, so one thread does it.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engines/loop/guards.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

constexpr double reach_of_list = 0.2;  // how far from a wall grains are listed [d]
constexpr const char* side_names[] = { "x_low", "x_high", "y_low", "y_high" };

void require(bool holds, const Wall& wall, const char* rule, double got)
{
	if (holds) return;
	std::ostringstream message;
	message << "wall " << name_of(wall.side) << ": " << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

const Wall* opposite(const Scene& scene, const Wall& wall)
{
	for (const Wall& other : scene.walls)
		if (other.side != wall.side && other.across_x() == wall.across_x()) return &other;
	return nullptr;
}

/// Length of the box along an axis, 0 where nothing bounds it.
double extent(const Scene& scene, bool along_x)
{
	const Box& box = scene.box;
	if (along_x ? box.periodic_x : box.periodic_y) return along_x ? box.x_high - box.x_low : box.y_high - box.y_low;
	const Wall *low = nullptr, *high = nullptr;
	for (const Wall& wall : scene.walls)
		if (wall.across_x() == along_x) (wall.outward() < 0 ? low : high) = &wall;
	return low && high ? high->position - low->position : 0;
}

/// To the bound of its own pair of grains: a wall is to a grain what a grain of the same size and mass is to one of twice both.
double critical_step_at_walls(Scene scene)
{
	scene.walls.clear();
	for (Grain& g : scene.grains) g.radius *= 2, g.mass *= 2;
	return critical_time_step(scene, 0.05);
}

}  // namespace

const char* name_of(Side side) { return side_names[static_cast<int>(side)]; }

Side side_named(const std::string& name)
{
	for (int s = 0; s < 4; ++s)
		if (name == side_names[s]) return static_cast<Side>(s);
	throw std::invalid_argument("a wall's side must be x_low, x_high, y_low or y_high, got " + name);
}

double wall_length(const Scene& scene, const Wall& wall) { return extent(scene, !wall.across_x()); }

void check_walls(const Scene& scene)
{
	for (const Wall& wall : scene.walls) {
		require(std::isfinite(wall.position), wall, "position must be finite [m]", wall.position);
		require(std::isfinite(wall.velocity) && std::isfinite(wall.slide), wall, "velocity and slide must be finite [m/s]",
			wall.velocity + wall.slide);
		require(!(wall.across_x() ? scene.box.periodic_x : scene.box.periodic_y), wall,
			"the box must not be periodic across it (leave that axis of GrainLoop.periods 0); period [m]",
			extent(scene, wall.across_x()));
		const Wall* facing = opposite(scene, wall);
		require(!facing || (facing->position - wall.position) * wall.outward() < 0, wall,
			"must lie on its side of the one that faces it, at which position [m]", wall.position);
		if (!wall.pressed) continue;
		require(std::isfinite(wall.pressure), wall, "pressure must be finite [N/m]", wall.pressure);
		require(wall.mass > 0 && std::isfinite(wall.mass), wall, "a wall under pressure needs a positive mass [kg]", wall.mass);
		require(wall.damping >= 0, wall, "damping must not be negative [kg/s]", wall.damping);
		require(wall.speed_limit > 0, wall, "speedLimit must be positive [m/s]", wall.speed_limit);
		require(wall_length(scene, wall) > 0, wall,
			"a pressure needs a length that it acts on: a periodic box or two walls along the wall; length [m]",
			wall_length(scene, wall));
	}
	if (scene.walls.empty()) return;
	const auto acts_at_contact_point = [](const auto& law) { return law.acts_at_contact_point; };
	const std::string for_pairs_only = "the laws " + laws::listed(laws::names_where(acts_at_contact_point), " and ") +
	                                   " are for pairs of disks; take frozen disks, or another law; walls";
	require(!std::visit(acts_at_contact_point, scene.law), scene.walls[0], for_pairs_only.c_str(), scene.walls.size());
	const double critical = critical_step_at_walls(scene);
	if (scene.dt > critical) {
		std::ostringstream message;
		message << "time step must not exceed the critical one of a grain at a wall, " << critical << ", got " << scene.dt
				<< "; lower it or take softer grains";
		throw std::invalid_argument(message.str());
	}
}

double area_fraction(const Scene& scene)
{
	double area = 0;
	for (const Grain& g : scene.grains)
		if (g.body == free_grain || !scene.bodies[g.body].frozen) area += pi * g.radius * g.radius;
	return area / (extent(scene, true) * extent(scene, false));
}

void Stepper::set_wall(const Wall& wall)
{
	Scene changed = state.scene;
	const auto same_side = [&](const Wall& other) { return other.side == wall.side; };
	const auto at = std::find_if(changed.walls.begin(), changed.walls.end(), same_side);
	if (at == changed.walls.end())
		changed.walls.push_back(wall);
	else
		*at = wall;
	check_walls(changed);
	state.scene.walls = changed.walls;
	state.moved_near_walls = HUGE_VAL;
}

void Stepper::remove_wall(Side side)
{
	for (std::uint32_t w = 0; w < state.scene.walls.size(); ++w) {
		if (state.scene.walls[w].side != side) continue;
		state.scene.walls.erase(state.scene.walls.begin() + w);
		std::vector<WallTouch> kept;
		for (WallTouch touch : state.wall_touches) {
			if (touch.wall == w) continue;
			touch.wall -= touch.wall > w;
			kept.push_back(touch);
		}
		state.wall_touches.swap(kept);
		return;
	}
}

void Stepper::set_wall_springs(const std::vector<WallTouch>& springs)
{
	state.wall_touches = springs;
	std::sort(state.wall_touches.begin(), state.wall_touches.end(),
		[](const WallTouch& a, const WallTouch& b) { return a.wall != b.wall ? a.wall < b.wall : a.grain < b.grain; });
}

/// Lists grains near walls anew once something may have come from beyond the list to a wall. The order is that of grains, wherever they lie.
void Stepper::list_wall_touches()
{
	const double reach = reach_of_list * typical_diameter;
	if (state.moved_near_walls <= reach) return;
	std::vector<WallTouch> listed;
	auto known = state.wall_touches.begin();
	for (std::uint32_t w = 0; w < state.scene.walls.size(); ++w) {
		const Wall& wall = state.scene.walls[w];
		for (std::uint32_t g = 0; g < n_grains; ++g) {
			while (known != state.wall_touches.end() && (known->wall < w || (known->wall == w && known->grain < g))) ++known;
			if (state.scene.grains[g].body != free_grain && state.body_fixed[state.scene.grains[g].body]) continue;
			const GrainRow& row = state.rows[row_of[g]];
			if (placement(row, wall).overlap < -reach) continue;
			const bool seen = known != state.wall_touches.end() && known->wall == w && known->grain == g;
			listed.push_back({ w, g, seen ? known->slip : 0 });
		}
	}
	state.wall_touches.swap(listed);
	state.moved_near_walls = 0;
}

Placement Stepper::placement_of(const WallTouch& touch) const
{
	return placement(state.rows[row_of[touch.grain]], state.scene.walls[touch.wall]);
}

/// On the grain [N].
Plane Stepper::force_of_wall(const WallTouch& touch) const
{
	return laws::force_on_first(placement_of(touch).normal, touch.normal, touch.friction);
}

void Stepper::compute_wall_forces()
{
	for (Wall& wall : state.scene.walls) wall.force_x = wall.force_y = 0;
	for (WallTouch& touch : state.wall_touches) {
		Wall& wall = state.scene.walls[touch.wall];
		const auto contact = kinematics(placement_of(touch), state.rows[row_of[touch.grain]], wall, data.dt);
		touch.overlap = contact.overlap;
		touch.normal = touch.friction = 0;
		touch.slip_before = touch.slip;
		if (!(contact.overlap > 0)) {
			touch.slip = 0;
			continue;
		}
		const auto response = std::visit([&](const auto& law) { return law(contact, touch.slip); }, state.scene.law);
		touch.normal = response.normal;
		if (state.scene.friction) touch.friction = response.tangential, touch.slip = response.slip;
		const Plane force = force_of_wall(touch);
		wall.force_x -= force.x;
		wall.force_y -= force.y;
	}
}

/// What walls do to a body of grains.
void Stepper::add_wall_forces(std::size_t b)
{
	RigidBody& body = state.scene.bodies[b];
	for (const WallTouch& touch : state.wall_touches) {
		if (state.scene.grains[touch.grain].body != static_cast<int>(b) || !(touch.overlap > 0)) continue;
		const auto [x, y] = force_of_wall(touch);
		const std::uint32_t at = row_of[touch.grain];
		const GrainRow& row = state.rows[at];
		const Member& member = state.members[at - n_free];
		body.force_x += x;
		body.force_y += y;
		body.torque +=
			(row.x - member.shift_x - body.x) * y - (row.y - member.shift_y - body.y) * x + row.radius * touch.friction;
	}
}

/// Kicks the free grains at walls, unless the sweep has done it, then moves the walls.
void Stepper::move_walls()
{
	for (const WallTouch& touch : state.wall_touches) {
		if (data.outside) break;
		if (!(touch.overlap > 0) || state.scene.grains[touch.grain].body != free_grain) continue;
		const Plane force = force_of_wall(touch);
		kick_grain(row_of[touch.grain], force.x, force.y, touch.friction);
	}
	double fastest_wall = 0;
	for (Wall& wall : state.scene.walls) {
		wall.move(wall_length(state.scene, wall), data.kick, data.drift);
		fastest_wall = std::max(fastest_wall, std::abs(wall.velocity));
	}
	double fastest = 0;  // squared
	for (std::uint32_t i = 0; i < n_free; ++i)
		fastest = std::max(fastest, state.rows[i].vx * state.rows[i].vx + state.rows[i].vy * state.rows[i].vy);
	double fastest_body = 0;
	for (std::size_t b = 0; b < state.scene.bodies.size(); ++b)
		fastest_body = std::max(fastest_body, std::hypot(state.scene.bodies[b].vx, state.scene.bodies[b].vy) +
												  std::abs(state.scene.bodies[b].spin) * body_reach[b]);
	state.moved_near_walls += (std::max(std::sqrt(fastest), fastest_body) + fastest_wall) * data.drift;
	if (state.scene.target_area_fraction > 0 && area_fraction(state.scene) >= state.scene.target_area_fraction)
		for (Wall& wall : state.scene.walls) wall.velocity = 0, wall.pressed = false;
}

void Stepper::check_walls_while_running() const
{
	for (const WallTouch& touch : state.wall_touches) {
		const GrainRow& row = state.rows[row_of[touch.grain]];
		const int owner = state.scene.grains[touch.grain].body;
		const bool led = owner != free_grain && !state.scene.bodies[owner].responds_x && !state.scene.bodies[owner].responds_y;
		const double overlap = placement_of(touch).overlap;
		if (led || !(overlap > state.guards.largest_overlap * row.radius)) continue;
		std::ostringstream message;
		message << now() << introduce(row_of[touch.grain]) << " overlaps wall " << name_of(state.scene.walls[touch.wall].side)
				<< " by " << overlap / row.radius << " of its radius, more than " << state.guards.largest_overlap
				<< "; likely grains too soft for their speed or load, a wall too fast or light, or grains that began beyond it";
		throw std::runtime_error(message.str());
	}
}

std::vector<Contact> Stepper::wall_contacts() const
{
	std::vector<Contact> found;
	const double bound = slipping_bound();
	for (const WallTouch& touch : state.wall_touches) {
		if (!(touch.overlap > 0)) continue;
		const Plane n = placement_of(touch).normal;
		const GrainRow row = row_before(body_forces_known ? 0 : drifted, row_of[touch.grain]);
		found.push_back({ touch.grain, touch.wall, n.x, n.y, row.x + row.radius * n.x, row.y + row.radius * n.y, touch.normal,
			touch.friction, touch.overlap, touch.slip, std::abs(touch.friction) >= bound * std::abs(touch.normal) });
	}
	return found;
}

void Stepper::append_wall_touches(std::size_t b, std::vector<Touch>& touches) const
{
	const RigidBody& body = state.scene.bodies[b];
	for (const Contact& c : wall_contacts()) {
		if (state.scene.grains[c.first].body != static_cast<int>(b)) continue;
		const Member& member = state.members[row_of[c.first] - n_free];
		touches.push_back({ c.first, std::uint32_t(size()) + c.second, c.point_x - member.shift_x - body.x,
			c.point_y - member.shift_y - body.y, c.n_x, c.n_y, c.normal, c.friction, c.slipping });
	}
}

}  // namespace graindrive::loop
