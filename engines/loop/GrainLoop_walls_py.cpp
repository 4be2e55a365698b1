/// Python binding of GrainLoop: flat walls, their contacts, and loads on bodies.
#include "engines/loop/GrainLoop_py.hpp"

namespace graindrive {
namespace {

/// setWall(side, position=..., velocity=... | pressure=..., mass=..., ...): what is not said stays as it is.
py::object set_wall(const py::tuple& arguments, const py::dict& keywords)
{
	GrainLoop& loop = py::extract<GrainLoop&>(arguments[0]);
	if (py::len(arguments) != 2)
		throw std::invalid_argument("GrainLoop.setWall takes a side, then keywords: setWall('y_low', position=0)");
	loop::Wall wall;
	wall.side = loop::side_named(py::extract<std::string>(arguments[1]));
	bool known = false;
	for (const loop::Wall& other : loop.walls())
		if (other.side == wall.side) wall = other, known = true;
	if (!known && !keywords.has_key("position"))
		throw std::invalid_argument(
			std::string("GrainLoop.setWall: a new wall needs a position [m], got none for ") + loop::name_of(wall.side));
	if (keywords.has_key("velocity") && keywords.has_key("pressure"))
		throw std::invalid_argument("GrainLoop.setWall: a wall has a velocity or a pressure, got both");
	const py::list items = keywords.items();
	for (long k = 0; k < py::len(items); ++k) {
		const std::string key = py::extract<std::string>(items[k][0]);
		const Real value = py::extract<Real>(items[k][1]);
		if (key == "position")
			wall.position = value;
		else if (key == "velocity")
			wall.velocity = value, wall.pressed = false;
		else if (key == "slide")
			wall.slide = value;
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

void remove_wall(GrainLoop& loop, const std::string& side) { loop.remove_wall(loop::side_named(side)); }

py::dict walls(GrainLoop& loop)
{
	const Running stepper(loop);
	const loop::Scene& scene = stepper->settings();
	py::dict all;
	for (const loop::Wall& w : scene.walls) {
		const Real length = loop::wall_length(scene, w);
		py::dict wall;
		wall["position"] = w.position, wall["velocity"] = w.velocity, wall["slide"] = w.slide;
		wall["force"] = py::make_tuple(w.force_x, w.force_y);
		wall["length"] = length;
		wall["measuredPressure"] = length > 0 ? w.outward() * w.force() / length : NAN;
		wall["pressure"] = w.pressed ? py::object(w.pressure) : py::object();
		wall["mass"] = w.mass, wall["damping"] = w.damping, wall["speedLimit"] = w.speed_limit;
		all[loop::name_of(w.side)] = wall;
	}
	return all;
}

py::dict wall_contacts(GrainLoop& loop)
{
	const Running stepper(loop);
	const std::vector<loop::Contact> all = stepper->wall_contacts();
	py::dict table = contact_table(all, loop.bodies().grain_id);
	py::list side;
	for (const loop::Contact& c : all) side.append(std::string(loop::name_of(stepper->settings().walls[c.second].side)));
	table["side"] = side;
	return table;
}

Real area_fraction(GrainLoop& loop) { return loop::area_fraction(Running(loop)->settings()); }

void set_load(GrainLoop& loop, int body, const Vector3r& force)
{
	const Running stepper(loop);
	loop.set_load(body, force);
}

}  // namespace

void bind_walls(GrainLoopClass& cls)
{
	cls.def("setWall", py::raw_function(set_wall, 2),
		"setWall(side, position=, velocity= or pressure=, slide=, mass=, damping=, speedLimit=): a flat wall on the side "
		"'x_low', 'x_high',\n"
		"'y_low' or 'y_high'; what is not said stays as it is. Grains meet it as a frozen grain of infinite radius and mass.\n"
		"position [m], velocity along its axis and slide along itself [m/s]; or pressure inwards [N/m], under which it moves as\n"
		"mass [kg] dv/dt = F - pressure length - damping [kg/s] v with |v| <= speedLimit [m/s].\n"
		"Raises ValueError with the rule for what cannot be.");
	cls.def("removeWall", remove_wall, (py::arg("side")), "Take the wall on this side away.");
	cls.add_property("walls", walls,
		"side -> position [m], velocity, slide [m/s], force of the grains (x, y) [N], length [m], measuredPressure [N/m], and "
		"what setWall set");
	cls.def("wallContacts", wall_contacts,
		"Contacts with walls as arrays, as contacts() with the wall's side in place of j; normal outwards, forces on the wall.");
	cls.add_property("areaFraction", area_fraction,
		"areas of all disks that are not frozen over the area between walls or periodic sides [-]; overlapping beads count "
		"twice");
	cls.def("setLoad", set_load, (py::arg("body"), py::arg("force")),
		"A constant force [N] on the free directions of a clump or disk: a wall of frozen disks under a pressure is a clump, "
		"free along one axis.");
}

}  // namespace graindrive
