/// Speed of the continuum solver on the half-filled drum of Oba, Otsuki (2025): flow_bench CELLS STEPS DT [split|full] [SOLVER] [TOLERANCE]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "engines/base/real.hpp"
#include "engines/continuum/two_phase_flow.hpp"

using namespace graindrive;
using namespace graindrive::continuum;

int main(int count, char** words)
{
	const int cells = count > 1 ? std::atoi(words[1]) : 75;
	const long steps = count > 2 ? std::atol(words[2]) : 200;
	FlowSettings how;
	how.time_step = count > 3 ? std::atof(words[3]) : 1e-4;
	how.viscosity = count > 4 && !std::strcmp(words[4], "full") ? Viscosity::full : Viscosity::split;
	how.pressure_solver = count > 5 ? words[5] : "";
	how.tolerance = count > 6 ? std::atof(words[6]) : 1e-5;
	how.gravity_y = -1;
	if (const char* share = std::getenv("SHARE")) how.implicit_share = std::atof(share);
	const double D = 150, spin = std::getenv("OMEGA") ? std::atof(std::getenv("OMEGA")) : 6.28e-3, spacing = D / cells;
	const int n = cells + 32;
	const Grid grid{ n, n, spacing, -0.5 * n * spacing, -0.5 * n * spacing, false };
	const Domain domain(grid, [&](double x, double y) { return D / 2 - std::hypot(x, y); }, 2 * spacing, { 0, 0, spin, 0, 0 });
	Fluids fluids;
	const double grain = 4 / pi;
	fluids.rheology = laws::GranularFluid<laws::MuOfI>{ laws::MuOfI(), std::sqrt(grain) };
	fluids.density = 0.825 * grain;
	fluids.gas_density = 1e-3 * fluids.density;
	fluids.largest_viscosity = 8000;
	fluids.gas_viscosity = 8e-3;
	fluids.least_pressure = 1e-5;
	TwoPhaseFlow flow(grid, domain, fluids, how, [&](double x, double y) { return y < 0 ? 1.0 : 0.0; });
	const double area = flow.area();
	std::printf("stable step %g, area %.10g\n", flow.stable_step(), area);
	const auto clock = [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
	long p = 0, s = 0, v = 0, before = 0;
	double start = clock();
	for (long k = 1; k <= steps; ++k) {
		try {
			flow.step();
		} catch (const std::exception& error) {
			std::printf("step %ld: %s\n", k, error.what());
			return 1;
		}
		p += flow.report().pressure_iterations;
		s += flow.report().potential_iterations;
		v += flow.report().viscous_iterations;
		if (k % std::max(1L, steps / 20) && k != steps) continue;
		const long some = k - before;
		const auto& state = flow.state();
		// Surface slope at the middle: heights where alpha = 1/2 at x = +-D/8.
		const auto height = [&](double x) {
			const int i = int(std::floor((x - grid.low_x) / spacing));
			double h = -D / 2;
			for (int j = 18; j < n - 18; ++j) h += state.fraction[grid.at(i, j)] * spacing;
			return h;
		};
		std::printf("t %8.3f  it p %.1f s %.1f v %.1f  courant %.4f  area %+.2e  angle %.2f  %.3f ms/step, %.3g cell-steps/s\n",
			state.time, double(p) / some, double(s) / some, double(v) / some, flow.report().courant, flow.area() / area - 1,
			std::atan2(height(D / 8) - height(-D / 8), D / 4) * 180 / pi, (clock() - start) / some * 1e3,
			n * n * some / (clock() - start));
		std::fflush(stdout);
		p = s = v = 0;
		before = k;
		start = clock();
	}
	const auto& state = flow.state();
	for (int j = 16; j < n - 16; j += 3) {
		const std::size_t c = grid.at(n / 2, j);
		std::printf("y %7.2f alpha %.4f u %9.5f p %9.4f S %9.4f eta %.4g\n", grid.centre_y(j), state.fraction[c],
			state.velocity.x[c], state.pressure[c], state.potential[c], flow.present_viscosity()[c]);
	}
}
