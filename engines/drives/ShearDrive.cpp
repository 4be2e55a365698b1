/// Sets O.cell.velGrad, which both loops follow, and sums what it measures.
#include "engines/drives/ShearDrive.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive {

const char* const ShearDrive::documentation =
	"Shears the disks of a periodic cell homogeneously along x, with v_x = shearRate y (Lees, Edwards 1972), at constant\n"
	"height or under a constant pressure P: dL/dt = (p - P) L/g_p with p = (s_xx + s_yy)/2 of the last measurement (da\n"
	"Cruz et al., PRE 72, 021309 (2005)).\n\n"
	"It sets O.cell.velGrad = ((shearRate, 0 .. dL/dt/L)), which YADE's own loop and GrainLoop follow, and\n"
	"O.cell.homoDeform = 1: then bodies follow a change of velGrad at once and otherwise obey Newton's law. Stresses are >\n"
	"0 in compression and belong to the present positions, before the step; velocities are relative to the mean flow.\n"
	"Place it after the contacts and before the integrator. Raises ValueError for a scene that is not periodic and for\n"
	"numbers out of range.";

namespace {

constexpr std::size_t numbers_of_state = 15;

}  // namespace

void ShearDrive::check() const
{
	require(std::isfinite(shearRate), "ShearDrive.shearRate must be finite", shearRate);
	require(pressure >= 0 && std::isfinite(pressure), "ShearDrive.pressure must not be negative", pressure);
	require(
		pressureDamping > 0 && std::isfinite(pressureDamping), "ShearDrive.pressureDamping must be positive", pressureDamping);
	require(height >= 0 && std::isfinite(height), "ShearDrive.height must not be negative", height);
	require(heightRate > 0 && std::isfinite(heightRate), "ShearDrive.heightRate must be positive", heightRate);
	require(pressure == 0 || height == 0, "ShearDrive takes a pressure or a height: set one of them to 0, height", height);
	require(every >= 1, "ShearDrive.every must be at least 1", every);
	require(bins >= 1 && bins <= 100000, "ShearDrive.bins must lie in 1..100000", bins);
}

void ShearDrive::clear()
{
	samples = 0;
	sums.assign(numbers_of_state, 0);
	profileSums.assign(bins, 0);
	profileCounts.assign(bins, 0);
}

void ShearDrive::action()
{
	require(
		scene->isPeriodic, "ShearDrive needs a periodic cell (O.periodic = True, O.cell.setBox), O.periodic", scene->isPeriodic);
	if (scene->iter % every == 0) measure();
	growth = growth_wanted();
	set_flow();
}

void ShearDrive::measure()
{
	if (sums.size() != numbers_of_state || int(profileSums.size()) != bins || int(profileCounts.size()) != bins) clear();
	source_.of(scene).look(view_, true);
	const auto& flow = scene->cell->velGrad;
	const CellState now = state_of_cell(view_, flow(0, 1), flow(1, 1));
	lastPressure = now.pressure(), lastShearStress = now.shear_stress();
	const Real p = lastPressure, tau = lastShearStress;
	const Real numbers[numbers_of_state] = { now.contact[0], now.contact[1], now.contact[2], now.contact[3], now.kinetic[0],
		now.kinetic[1], now.kinetic[2], now.kinetic[3], now.coordination, now.area_fraction, flow(1, 1), p, tau, p * p,
		tau * tau };
	for (std::size_t k = 0; k < numbers_of_state; ++k) sums[k] += numbers[k];
	add_to_profile();
	++samples;
}

void ShearDrive::add_to_profile()
{
	const auto& flow = scene->cell->velGrad;
	Real mean = 0;
	for (const GrainState& g : view_.grains) mean += (g.velocity[0] - flow(0, 1) * g.position[1]) / view_.grains.size();
	for (const GrainState& g : view_.grains) {
		const Real height = g.position[1] / view_.periods[1];
		const int bin = std::min(bins - 1, int((height - std::floor(height)) * bins));
		profileSums[bin] += g.velocity[0] - flow(0, 1) * g.position[1] - mean;
		profileCounts[bin] += 1;
	}
}

Real ShearDrive::growth_wanted() const
{
	if (pressure > 0) return (lastPressure - pressure) / pressureDamping;
	if (height == 0) return 0;
	return std::clamp((height / scene->cell->hSize(1, 1) - 1) / scene->dt, -heightRate, heightRate);
}

void ShearDrive::set_flow()
{
	yade::Cell& cell = *scene->cell;
	Eigen::Matrix<Real, 3, 3> wanted = Eigen::Matrix<Real, 3, 3>::Zero();
	wanted(0, 1) = shearRate, wanted(1, 1) = growth;
	cell.homoDeform = 1;
	if (wanted == cell.velGrad && !cell.velGradChanged) return;
	cell.nextVelGrad = wanted;
	cell.velGradChanged = true;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::ShearDrive)
