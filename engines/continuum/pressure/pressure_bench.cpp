/// Times the pressure solvers on a drum whose surface turns a little in every step, starting from earlier solutions, and prints a
/// table.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "engines/continuum/pressure/drum_example.hpp"
#include "engines/continuum/pressure/extrapolation.hpp"
#include "engines/continuum/pressure/pressure_solver.hpp"

using namespace graindrive::continuum;

namespace {

double processor_seconds()
{
	timespec now;
	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
	return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double median(std::vector<double> numbers)
{
	std::nth_element(numbers.begin(), numbers.begin() + long(numbers.size() / 2), numbers.end());
	return numbers[numbers.size() / 2];
}

struct Case {
	std::string solver;
	int n;
	double ratio, cells_per_step, tolerance;
	int degree;  // of the extrapolation; -1 starts from 0
	int steps;
};

void run(const Case& c)
{
	const auto solver = make_pressure_solver(c.solver);
	DrumExample drum;
	drum.n = c.n, drum.density_ratio = c.ratio;
	Extrapolation past(std::max(c.degree, 0));
	std::vector<double> p(std::size_t(c.n) * c.n), set_up, solve, iterations;
	double first = 0;
	for (int step = 0; step < c.steps + 4; ++step) {
		const FaceCoefficients b = drum.coefficients();
		const std::vector<double> rhs = drum.right_side();
		const double t0 = processor_seconds();
		solver->update(b);
		const double t1 = processor_seconds();
		if (c.degree < 0) std::fill(p.begin(), p.end(), 0);
		past.predict(p);
		const SolveReport report = solver->solve(rhs, p, c.tolerance);
		if (c.degree >= 0) past.remember(p);
		const double t2 = processor_seconds();
		if (step == 0) first = t1 - t0;
		if (step >= 4) set_up.push_back(t1 - t0), solve.push_back(t2 - t1), iterations.push_back(report.iterations);
		drum.angle += c.cells_per_step / drum.radius();
		drum.phase += c.cells_per_step / drum.radius();
	}
	double mean = 0;
	for (const double one : iterations) mean += one / double(iterations.size());
	const double cells = double(c.n) * c.n;
	std::printf("%-12s %4d %8.0e %8.0e %8.0e %6s %7.1f %10.3f %10.3f %10.3f %9.1f\n", c.solver.c_str(), c.n, c.ratio,
		c.cells_per_step, c.tolerance,
		c.degree < 0    ? "zero"
		: c.degree == 0 ? "last"
		: c.degree == 1 ? "linear"
						: "square",
		mean, 1e3 * first, 1e3 * median(set_up), 1e3 * median(solve), 1e9 * (median(set_up) + 2 * median(solve)) / cells);
	std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv)
{
	if (argc > 1 && std::strcmp(argv[1], "help") == 0)
		return std::fprintf(
				   stderr, "usage: pressure_bench [all|SOLVER] [CELLS] [CELLS_PER_STEP] [TOLERANCE] [DEGREE] [STEPS] [RATIO]\n"),
		       2;
	const std::string wanted = argc > 1 ? argv[1] : "all";
	std::printf("%-12s %4s %8s %8s %8s %6s %7s %10s %10s %10s %9s\n", "solver", "n", "ratio", "move", "tol", "guess", "iter",
		"first[ms]", "update[ms]", "solve[ms]", "ns/cell");
	const std::vector<std::string> solvers = wanted == "all" ? pressure_solvers() : std::vector<std::string>{ wanted };
	const double ratio = argc > 7 ? std::atof(argv[7]) : 1000;
	const int steps = argc > 6 ? std::atoi(argv[6]) : 9;
	const std::vector<int> sizes = argc > 2 ? std::vector<int>{ std::atoi(argv[2]) } : std::vector<int>{ 107, 400 };
	for (const std::string& solver : solvers)
		for (const int n : sizes) {
			if (argc > 5) {
				run({ solver, n, ratio, std::atof(argv[3]), std::atof(argv[4]), std::atoi(argv[5]), steps });
				continue;
			}
			for (const double tolerance : { 1e-5, 1e-8 }) {
				run({ solver, n, ratio, 1e-2, tolerance, -1, steps });
				for (const double move : { 1e-2, 1e-4 })
					for (const int degree : { 0, 1, 2 }) run({ solver, n, ratio, move, tolerance, degree, steps });
			}
		}
}
