/// Python binding of GrainLoop: flat walls, their contacts, and loads on bodies.
#include "engines/loop/GrainLoop_py.hpp"

namespace graindrive {
namespace {

/// Of a disk's wall a number, along its other axis; of a sphere's wall a vector.
geometry::Vec<3> slide_of(const py::object& given, loop::Side side, int dimensions)
{
	geometry::Vec<3> slide;
	if (dimensions == 2) {
		slide[1 - loop::axis_of(side)] = py::extract<Real>(given);
		return slide;
	}
	const py::extract<Vector3r> vector(given);
	if (!vector.check() && !(PySequence_Check(given.ptr()) && py::len(given) == 3))
		throw std::invalid_argument("GrainLoop.setWall: slide of a wall for spheres must be a vector (x, y, z) [m/s]");
	for (int k = 0; k < 3; ++k) slide[k] = py::extract<Real>(given[k]);
	return slide;
}

/// setWall(side, position=..., velocity=... | pressure=..., mass=..., ...): omitted values do not change.
py::object set_wall(const py::tuple& arguments, const py::dict& keywords)
{
	GrainLoop& loop = py::extract<GrainLoop&>(arguments[0]);
	if (py::len(arguments) != 2)
		throw std::invalid_argument("GrainLoop.setWall needs a side, then keywords: setWall('y_low', position=0)");
	loop::Wall<3> wall;
	wall.side = loop.side_named(py::extract<std::string>(arguments[1]));
	bool known = false;
	for (const loop::Wall<3>& other : loop.walls())
		if (other.side == wall.side) wall = other, known = true;
	if (!known && !keywords.has_key("position"))
		throw std::invalid_argument(
			"GrainLoop.setWall: a new wall needs a position [m], got none for " + loop::name_of(wall.side));
	if (keywords.has_key("velocity") && keywords.has_key("pressure"))
		throw std::invalid_argument("GrainLoop.setWall: a wall must have either a velocity or a pressure, got both");
	const py::list items = keywords.items();
	for (long k = 0; k < py::len(items); ++k) {
		const std::string key = py::extract<std::string>(items[k][0]);
		if (key == "slide") {
			wall.slide = slide_of(items[k][1], wall.side, loop.dimensions);
			continue;
		}
		const Real value = py::extract<Real>(items[k][1]);
		if (key == "position")
			wall.position = value;
		else if (key == "velocity")
			wall.velocity = value, wall.pressed = false;
		else if (key == "pressure")
			wall.pressure = value, wall.pressed = true;
		else if (key == "mass")
			wall.mass = value;
		else if (key == "damping")
			wall.damping = value;
		else if (key == "speedLimit")
			wall.speed_limit = value;
		else
			throw std::invalid_argument(
				"GrainLoop.setWall: keywords are position, velocity, slide, pressure, mass, damping, speedLimit, got " + key);
	}
	loop.set_wall(wall);
	return {};
}

void remove_wall(GrainLoop& loop, const std::string& side) { loop.remove_wall(loop.side_named(side)); }

py::dict walls(GrainLoop& loop)
{
	const Running running(loop);
	const bool plane = loop.dimensions == 2;
	py::dict all;
	for (const loop::Wall<3>& w : running->walls()) {
		const Real extent = running->extent_of(w);
		py::dict wall;
		wall["position"] = w.position, wall["velocity"] = w.velocity;
		wall["slide"] = plane ? py::object(w.slide[1 - w.axis()]) : py::make_tuple(w.slide[0], w.slide[1], w.slide[2]);
		wall["force"] = plane ? py::make_tuple(w.force[0], w.force[1]) : py::make_tuple(w.force[0], w.force[1], w.force[2]);
		wall[plane ? "length" : "area"] = extent;
		wall["measuredPressure"] = extent > 0 ? w.outward() * w.force[w.axis()] / extent : NAN;
		wall["pressure"] = w.pressed ? py::object(w.pressure) : py::object();
		wall["mass"] = w.mass, wall["damping"] = w.damping, wall["speedLimit"] = w.speed_limit;
		all[loop::name_of(w.side)] = wall;
	}
	return all;
}

/// Those with flat walls: solids stand among presentContacts.
py::dict wall_contacts(GrainLoop& loop)
{
	const Running running(loop);
	std::vector<loop::SeenContact> at_walls;
	py::list side;
	for (const loop::SeenContact& c : running->surface_contacts()) {
		if (c.j >= 0) continue;
		at_walls.push_back(c);
		side.append(loop::name_of(loop::Side(-2 - c.j)));
	}
	py::dict table = contact_table(at_walls, loop.dimensions);
	py::delitem(table, py::object("j"));
	table["side"] = side;
	return table;
}

Real filled_fraction(GrainLoop& loop) { return Running(loop)->filled_fraction(); }

void set_load(GrainLoop& loop, int body, const Vector3r& force)
{
	const Running running(loop);
	loop.set_load(body, force);
}

}  // namespace

void bind_walls(GrainLoopClass& cls)
{
	cls.def("setWall", py::raw_function(set_wall, 2),
		"setWall(side, position=, velocity= or pressure=, slide=, mass=, damping=, speedLimit=): set a flat wall on the side\n"
		"'x_low', 'x_high', 'y_low', 'y_high', for spheres also 'z_low' or 'z_high'; omitted values do not change. In contacts\n"
		"the wall counts as a frozen grain of infinite radius and mass.\n"
		"position [m], velocity along the wall's axis and slide along the wall [m/s] (for spheres a vector); or pressure\n"
		"inwards [N/m] ([N/m^2] for spheres), with the motion mass [kg] dv/dt = F - pressure length - damping [kg/s] v with\n"
		"|v| <= speedLimit [m/s]. Raises ValueError with the rule for bad input.");
	cls.def("removeWall", remove_wall, (py::arg("side")), "Remove the wall on this side.");
	cls.add_property("walls", walls,
		"side -> position [m], velocity, slide [m/s], force of the grains [N], length [m] (area [m^2]), measuredPressure [N/m] "
		"([N/m^2]), and "
		"the settings of setWall");
	cls.def("wallContacts", wall_contacts,
		"Contacts with walls, like contacts(), with the wall's side in place of j; normal outwards, forces on the wall.");
	cls.add_property("areaFraction", filled_fraction,
		"area of all disks (volume of all spheres) that are not frozen, over that of the box between walls or periodic sides\n"
		"[-]; overlapping beads count twice");
	cls.def("setLoad", set_load, (py::arg("body"), py::arg("force")),
		"Apply a constant force [N] to the free directions of a clump or disk, for example to a wall under pressure, which is a\n"
		"clump of frozen disks that is free along one axis.");
}

}  // namespace graindrive
