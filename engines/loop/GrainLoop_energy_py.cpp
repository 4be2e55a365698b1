/// Python binding of GrainLoop: the energy ledger.
#include "engines/loop/GrainLoop_py.hpp"

namespace graindrive {
namespace {

py::dict energy(GrainLoop& loop)
{
	const Running running(loop);
	const loop::Energies* ledger = running->energies();
	if (!ledger)
		throw std::runtime_error("GrainLoop.energy is known only while trackEnergy is True; set it before the steps to track");
	const loop::Energies& e = *ledger;
	const std::vector<double> works = running->work_by_body();
	py::dict all, by_body;
	all["kineticTranslation"] = e.translation, all["kineticRotation"] = e.rotation;
	all["elasticNormal"] = e.elastic_normal, all["elasticTangential"] = e.elastic_tangential, all["potential"] = e.potential;
	all["normalDamping"] = e.normal_damping, all["tangentialDamping"] = e.tangential_damping;
	all["friction"] = e.friction, all["opening"] = e.opening, all["stiffening"] = e.stiffening;
	all["workOfBodies"] = e.work_of_bodies, all["workOfWalls"] = e.work_of_walls, all["workOfLoads"] = e.work_of_loads;
	all["workOfCell"] = e.work_of_cell;
	for (std::size_t b = 0; b < works.size(); ++b)
		if (running->map.body_id[b] >= 0) by_body[running->map.body_id[b]] = works[b];
	all["workByBody"] = by_body;
	all["timeStep"] = e.time_step, all["initial"] = e.initial, all["turnover"] = e.turnover;
	all["residual"] = e.residual(), all["closure"] = e.turnover > 0 ? std::abs(e.residual()) / e.turnover : 0.0;
	return all;
}

}  // namespace

void bind_energy(GrainLoopClass& cls)
{
	cls.add_property("energy", energy,
		"the energy ledger [J] since trackEnergy was set, at the last step: kineticTranslation, kineticRotation, elasticNormal,\n"
		"elasticTangential, potential; dissipated: normalDamping, tangentialDamping, friction, opening; given: stiffening, "
		"workOfBodies\n"
		"(workByBody: id -> J), workOfWalls, workOfLoads, workOfCell, timeStep; initial; residual, turnover (sum of |changes|), "
		"closure = "
		"|residual|/turnover");
}

}  // namespace graindrive
