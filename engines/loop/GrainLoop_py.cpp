/// Python binding of GrainLoop: its attributes, and grains and contacts as NumPy arrays.
#include "engines/loop/GrainLoop_py.hpp"

#include <algorithm>

namespace graindrive {

yade::Scene* scene_of_yade() { return py::extract<yade::Scene*>(py::import("yade").attr("O").attr("_sceneObj")); }

namespace {

/// YADE's scene, which must contain this loop: a loop of another scene does not move the bodies of this one.
yade::Scene* scene_with(const GrainLoop& loop)
{
	yade::Scene* scene = scene_of_yade();
	const auto is_it = [&](const auto& engine) { return engine.get() == &loop; };
	if (std::none_of(scene->engines.begin(), scene->engines.end(), is_it))
		throw std::runtime_error(
			"this GrainLoop does not stand in O.engines (O.load, O.reset and O.switchToScene replace it); use "
			"the one that is there, e.g. O.engines[-1]");
	return scene;
}

}  // namespace

Running::Running(GrainLoop& loop) : turn(loop.take_turn()), mirror((loop.scene = scene_with(loop), loop.running())) {}

py::dict contact_table(const std::vector<loop::SeenContact>& contacts, int dimensions)
{
	std::vector<int> i, j, slipping;
	std::vector<Real> point, normal, normal_force, tangential_force, overlap, slip;
	const auto append = [](std::vector<Real>& to, const Vector3r& v) { to.insert(to.end(), v.data(), v.data() + 3); };
	for (const loop::SeenContact& c : contacts) {
		i.push_back(c.i), j.push_back(c.j), slipping.push_back(c.slipping), overlap.push_back(c.overlap);
		dimensions == 2 ? slip.push_back(c.slip[0]) : append(slip, c.slip);
		append(point, c.point), append(normal, c.normal);
		append(normal_force, c.normal_force), append(tangential_force, c.tangential_force);
	}
	py::dict table;
	table["i"] = array_of(i), table["j"] = array_of(j), table["slipping"] = array_of(slipping);
	table["overlap"] = array_of(overlap), table["slip"] = dimensions == 2 ? array_of(slip) : array_of(slip, 3);
	table["point"] = array_of(point, 3), table["normal"] = array_of(normal, 3);
	table["normal_force"] = array_of(normal_force, 3), table["tangential_force"] = array_of(tangential_force, 3);
	return table;
}

namespace {

np::ndarray array_of_table(const loop::Table& table)
{
	return table.columns == 1 ? array_of(table.numbers) : array_of(table.numbers, table.columns);
}

np::ndarray ids(GrainLoop& loop) { return array_of(Running(loop)->map.grain_id); }
np::ndarray positions(GrainLoop& loop) { return array_of_table(Running(loop)->positions()); }
np::ndarray velocities(GrainLoop& loop) { return array_of_table(Running(loop)->velocities()); }
np::ndarray spins(GrainLoop& loop) { return array_of_table(Running(loop)->spins()); }

/// The same columns as `contact_table` of YADE's loop; forces act on j, as YADE's on body 2.
py::dict contacts(GrainLoop& loop) { return contact_table(Running(loop)->contacts(), loop.dimensions); }

/// Those at the present positions, walls included: the wall of side s stands as j = -2 - s.
py::dict present_contacts(GrainLoop& loop) { return contact_table(Running(loop)->present_contacts(), loop.dimensions); }

Real kinetic_energy(GrainLoop& loop) { return Running(loop)->kinetic_energy(); }
Real kinetic_energy_on_step(GrainLoop& loop) { return Running(loop)->kinetic_energy_on_step(); }
void begin_on_step(GrainLoop& loop)
{
	const Running running(loop);
	loop.begin_on_step();
}
void require_scene(GrainLoop& loop)
{
	const GrainLoop::Turn turn = loop.take_turn();
	loop.scene = scene_of_yade();
	loop.require_scene();
}
long searches(GrainLoop& loop) { return Running(loop)->searches(); }

std::string processor(GrainLoop& loop) { return Running(loop)->processor(); }

py::list processors()
{
	py::list names;
	for (loop::Processor each : loop::processors_supported()) names.append(loop::name_of(each));
	return names;
}

}  // namespace

void bind_loop()
{
	np::initialize();
	auto cls = seam::bind<GrainLoop>(GrainLoop::documentation);
	cls.def("sync", &GrainLoop::sync, "Write positions, velocities and spins of all grains into O.bodies.");
	cls.def("showBodies", &GrainLoop::show_bodies,
		"Write positions, velocities and spins of all grains into O.bodies unless they are up to date; for O.pause().");
	cls.def("read", &GrainLoop::read,
		"Read the scene from O.bodies again at the next step; contacts that persist have the springs of the last sync.");
	cls.def("requireScene", require_scene,
		"Check, before the first step, that GrainLoop can run with O.bodies, O.cell and O.engines. Raises ValueError or\n"
		"RuntimeError with the rule, the body or engine and the way out. The time step is checked when the run begins.");
	const std::string of_contacts =
		"Contacts of the last step, at the positions of its beginning, like YADE's after a step. During a step (in engines\n"
		"before GrainLoop), and always for spheres, contacts at the present positions. Arrays: i, j, slipping, overlap [m],\n"
		"slip of i [m], along z x n for disks, shape (n, 3) for spheres ([N] with " +
		laws::laws_that_remember_forces() +
		",\nwhich store a force), shape (n,); point [m], the middle of the overlap, in i's image, normal n from i to j,\n"
		"normal_force and tangential_force on j [N], shape (n, 3).";
	cls.def("contacts", contacts, of_contacts.c_str());
	cls.def("presentContacts", present_contacts,
		"Contacts at the present positions, as the next step will find them, with the arrays of contacts(); nothing changes.\n"
		"Contacts with flat walls are included, with j = -2, -3, -4, -5, -6, -7 for x_low, x_high, y_low, y_high, z_low,\n"
		"z_high; contacts with solids have the id of the solid's body.");
	bind_checkpoint(cls);
	bind_walls(cls);
	bind_energy(cls);
	cls.add_property("ids", ids, "ids of the grains, in the order of positions, velocities and spins, shape (n,)");
	cls.add_property("positions", positions, "centres [m], shape (n, 2), for spheres (n, 3); inside the periodic box");
	cls.add_property("velocities", velocities, "velocities [m/s], half a step earlier, shape (n, 2), for spheres (n, 3)");
	cls.add_property("spins", spins, "angular velocities [rad/s], shape (n,), for spheres (n, 3)");
	cls.def("beginOnStep", begin_on_step,
		"Use this if the velocities in O.bodies belong to the time of the positions, not half a step earlier (as in LAMMPS):\n"
		"the next step then changes velocities by half a time step only.");
	cls.def("kineticEnergyOnStep", kinetic_energy_on_step, "Kinetic energy with velocities at the time of the positions [J].");
	cls.add_property("kineticEnergy", kinetic_energy, "kinetic energy of the free grains, translation and rotation [J]");
	cls.add_property("searches", searches, "number of neighbour searches so far");
	cls.add_property("processor", processor, "instruction set in use: 'avx512', 'avx2' or 'portable'");
	py::def("processors", processors,
		"Kernels of GrainLoop that this processor can run, the best first, out of 'avx512', 'avx2', 'portable'. The environment\n"
		"variable GRAINDRIVE_PROCESSOR chooses one.");
}

}  // namespace graindrive
