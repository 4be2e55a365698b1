/// Python binding of GrainLoop: grains and contacts as NumPy arrays.
#include <boost/python/numpy.hpp>

#include "engines/loop/GrainLoop.hpp"
#include "engines/loop/checkpoint.hpp"
#include "engines/seam/numpy_array.hpp"

namespace graindrive {
namespace {

namespace py = boost::python;
namespace np = boost::python::numpy;

using seam::array_of;

/// YADE tells an engine its scene at every step; a call from Python may come before the first one.
loop::Stepper& running(GrainLoop& loop)
{
	loop.scene = py::extract<yade::Scene*>(py::import("yade").attr("O").attr("_sceneObj"));
	return loop.stepper();
}

np::ndarray ids(GrainLoop& loop)
{
	running(loop);
	return array_of(loop.bodies().grain_id);
}

py::object bytes(const std::string& text)
{
	return py::object(py::handle<>(PyBytes_FromStringAndSize(text.data(), Py_ssize_t(text.size()))));
}

std::string text_of(const py::object& bytes)
{
	char* start = nullptr;
	Py_ssize_t size = 0;
	if (PyBytes_AsStringAndSize(bytes.ptr(), &start, &size) != 0) py::throw_error_already_set();
	return { start, std::size_t(size) };
}

void checkpoint(GrainLoop& loop, const std::string& path, const py::object& saved_scene)
{
	running(loop);
	loop.save_checkpoint(path, text_of(saved_scene));
}

py::object saved_scene(const std::string& path)
{
	const bool by_yade = loop::contents_of(path) == loop::Contents::yade_scene;
	return bytes(by_yade ? loop::read_checkpoint(path, loop::Contents::yade_scene) : GrainLoop::saved_scene(path));
}

void seal_scene(const std::string& path, const py::object& saved_scene)
{
	loop::write_checkpoint(path, text_of(saved_scene), loop::Contents::yade_scene);
}

void restore(GrainLoop& loop, const std::string& path)
{
	loop.scene = py::extract<yade::Scene*>(py::import("yade").attr("O").attr("_sceneObj"));
	loop.restore_checkpoint(path);
}

np::ndarray positions(GrainLoop& loop)
{
	std::vector<Real> xy(2 * running(loop).size());
	running(loop).positions(xy.data());
	return array_of(xy, 2);
}

np::ndarray velocities(GrainLoop& loop)
{
	std::vector<Real> xy(2 * running(loop).size());
	running(loop).velocities(xy.data());
	return array_of(xy, 2);
}

np::ndarray spins(GrainLoop& loop)
{
	std::vector<Real> spin(running(loop).size());
	running(loop).spins(spin.data());
	return array_of(spin);
}

/// The same columns as `contact_table`; forces act on j, as YADE's on body 2.
py::dict contacts(GrainLoop& loop)
{
	std::vector<int> i, j, slipping;
	std::vector<Real> point, normal, normal_force, tangential_force, overlap, slip;
	for (const loop::Contact& c : running(loop).contacts()) {
		i.push_back(loop.bodies().grain_id[c.first]), j.push_back(loop.bodies().grain_id[c.second]);
		slipping.push_back(c.slipping), overlap.push_back(c.overlap), slip.push_back(c.slip);
		point.insert(point.end(), { c.point_x, c.point_y, 0 });
		normal.insert(normal.end(), { c.n_x, c.n_y, 0 });
		normal_force.insert(normal_force.end(), { c.normal * c.n_x, c.normal * c.n_y, 0 });
		tangential_force.insert(tangential_force.end(), { c.friction * c.n_y, -c.friction * c.n_x, 0 });
	}
	py::dict table;
	table["i"] = array_of(i), table["j"] = array_of(j), table["slipping"] = array_of(slipping);
	table["overlap"] = array_of(overlap), table["slip"] = array_of(slip);
	table["point"] = array_of(point, 3), table["normal"] = array_of(normal, 3);
	table["normal_force"] = array_of(normal_force, 3), table["tangential_force"] = array_of(tangential_force, 3);
	return table;
}

Real kinetic_energy(GrainLoop& loop) { return running(loop).kinetic_energy(); }
Real kinetic_energy_on_step(GrainLoop& loop) { return running(loop).kinetic_energy_on_step(); }
void begin_on_step(GrainLoop& loop)
{
	running(loop);
	loop.begin_on_step();
}
long searches(GrainLoop& loop) { return running(loop).searches_done(); }

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
	const loop::Scene& scene = running(loop).settings();
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
	const loop::Stepper& stepper = running(loop);
	std::vector<int> i, slipping;
	py::list side;
	std::vector<Real> point, normal, normal_force, tangential_force, overlap, slip;
	for (const loop::Contact& c : stepper.wall_contacts()) {
		i.push_back(loop.bodies().grain_id[c.first]), slipping.push_back(c.slipping);
		side.append(std::string(loop::name_of(stepper.settings().walls[c.second].side)));
		overlap.push_back(c.overlap), slip.push_back(c.slip);
		point.insert(point.end(), { c.point_x, c.point_y, 0 });
		normal.insert(normal.end(), { c.n_x, c.n_y, 0 });
		normal_force.insert(normal_force.end(), { c.normal * c.n_x, c.normal * c.n_y, 0 });
		tangential_force.insert(tangential_force.end(), { c.friction * c.n_y, -c.friction * c.n_x, 0 });
	}
	py::dict table;
	table["i"] = array_of(i), table["side"] = side, table["slipping"] = array_of(slipping);
	table["overlap"] = array_of(overlap), table["slip"] = array_of(slip);
	table["point"] = array_of(point, 3), table["normal"] = array_of(normal, 3);
	table["normal_force"] = array_of(normal_force, 3), table["tangential_force"] = array_of(tangential_force, 3);
	return table;
}

Real area_fraction(GrainLoop& loop) { return loop::area_fraction(running(loop).settings()); }

void set_load(GrainLoop& loop, int body, const Vector3r& force)
{
	running(loop);
	loop.set_load(body, force);
}

py::dict energy(GrainLoop& loop)
{
	const loop::EnergyLedger* ledger = running(loop).energy_ledger();
	if (!ledger)
		throw std::runtime_error("GrainLoop.energy is kept while trackEnergy is True; set it before the steps that count");
	const loop::Energies& e = ledger->energies();
	py::dict all, by_body;
	all["kineticTranslation"] = e.translation, all["kineticRotation"] = e.rotation;
	all["elasticNormal"] = e.elastic_normal, all["elasticTangential"] = e.elastic_tangential, all["potential"] = e.potential;
	all["normalDamping"] = e.normal_damping, all["tangentialDamping"] = e.tangential_damping;
	all["friction"] = e.friction, all["opening"] = e.opening, all["stiffening"] = e.stiffening;
	all["workOfBodies"] = e.work_of_bodies, all["workOfWalls"] = e.work_of_walls, all["workOfLoads"] = e.work_of_loads;
	for (std::size_t b = 0; b < ledger->work_by_body().size(); ++b)
		if (loop.bodies().body_id[b] >= 0) by_body[loop.bodies().body_id[b]] = ledger->work_by_body()[b];
	all["workByBody"] = by_body;
	all["timeStep"] = e.time_step, all["initial"] = e.initial, all["turnover"] = e.turnover;
	all["residual"] = e.residual(), all["closure"] = e.turnover > 0 ? std::abs(e.residual()) / e.turnover : 0.0;
	return all;
}

std::string processor(GrainLoop& loop)
{
	switch (running(loop).kernel_in_use().processor) {
	case loop::Processor::avx512:
		return "avx512";
	case loop::Processor::avx2:
		return "avx2";
	default:
		return "portable";
	}
}

}  // namespace

void bind_loop()
{
	np::initialize();
	auto cls = seam::bind<GrainLoop>(GrainLoop::documentation);
	cls.def("sync", &GrainLoop::sync, "Write positions, velocities and spins of all disks into O.bodies.");
	cls.def("read", &GrainLoop::read,
		"Take the scene anew from O.bodies at the next step; springs of contacts that stay are those of the last sync.");
	cls.def("contacts", contacts,
		"Contacts of the last step as arrays: i, j, slipping, overlap [m], slip [m], shape (n,); point [m], normal from i to j,\n"
		"normal_force and tangential_force on j [N], shape (n, 3).");
	cls.def("checkpoint", checkpoint, (py::arg("path"), py::arg("saved_scene") = bytes("")),
		"Write loop, bodies, drives and measures into one file; a run restored from it goes on to the last bit. Other engines\n"
		"(PyRunner, recorders) are named in it, no more. saved_scene: bytes that O.save wrote, to go along; "
		"graindrive.scene.save\n"
		"does that. Raises RuntimeError with the system's reason if it cannot be written; an older file then stays.");
	cls.def("restore", restore, (py::arg("path")),
		"Go on from a checkpoint in the same scene, built anew or loaded: positions, velocities, O.iter and the state of drives "
		"and\n"
		"measures come from the file; threads, syncEvery, largestOverlap and bounds stay. Raises RuntimeError with the reason, "
		"and\n"
		"changes nothing, for a file that is damaged, cut, foreign or of another version, and for a scene with other bodies, "
		"engines,\n"
		"time step or law.");
	py::def("saved_scene", saved_scene, (py::arg("path")),
		"What O.save wrote when a checkpoint was made, as bytes; empty if nothing. Raises RuntimeError as GrainLoop.restore.");
	py::def("seal_scene", seal_scene, (py::arg("path"), py::arg("saved_scene")),
		"Write bytes that O.save made into a checkpoint of a scene on YADE's own loop: atomic, with checksum and version.");
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
	cls.add_property("energy", energy,
		"the energy ledger [J] since trackEnergy was set, at the last step: kineticTranslation, kineticRotation, elasticNormal,\n"
		"elasticTangential, potential; dissipated: normalDamping, tangentialDamping, friction, opening; given: stiffening, "
		"workOfBodies\n"
		"(workByBody: id -> J), workOfWalls, workOfLoads, timeStep; initial; residual, turnover (sum of |changes|), closure = "
		"|residual|/turnover");
	cls.add_property("ids", ids, "ids of the disks, in the order of positions, velocities and spins, shape (n,)");
	cls.add_property("positions", positions, "centres [m], shape (n, 2); inside the periodic box");
	cls.add_property("velocities", velocities, "velocities, half a step behind [m/s], shape (n, 2)");
	cls.add_property("spins", spins, "angular velocities [rad/s], shape (n,)");
	cls.def("beginOnStep", begin_on_step,
		"For velocities of O.bodies that belong to the step itself, not half a step behind (LAMMPS): takes one step with half a "
		"kick.");
	cls.def("kineticEnergyOnStep", kinetic_energy_on_step, "Kinetic energy with the velocities of the whole step [J].");
	cls.add_property("kineticEnergy", kinetic_energy, "of the free disks, translation and rotation [J]");
	cls.add_property("searches", searches, "searches for neighbours so far");
	cls.add_property("processor", processor, "instructions in use: 'avx512', 'avx2' or 'portable'");
}

}  // namespace graindrive
