/// Runs a scene of spheres from a text file for some steps and prints the speed.
///
/// The file has a line `periods X Y Z` (0 where not periodic, boxes begin at 0), a line `gravity X Y Z`, a line `dt DT`, a line
/// `restitution YOUNG POISSON RESTITUTION FRICTION` or `history K_N K_T GAMMA_N GAMMA_T FRICTION`, then for each sphere
/// `held x y z radius mass vx vy vz wx wy wz`, with velocities at the step, not half a step earlier.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

#include "engines/loop/stepper.hpp"

using namespace graindrive;
using namespace graindrive::loop;

namespace {

Scene<3> read_scene(const char* path)
{
	Scene<3> s;
	s.bodies.resize(1);
	s.bodies[0].frozen = true;
	std::ifstream file(path);
	std::string line, word;
	while (std::getline(file, line)) {
		std::istringstream in(line);
		double a = 0, b = 0, c = 0, d = 0, e = 0;
		if (line.rfind("periods", 0) == 0) {
			in >> word >> s.cell.high[0] >> s.cell.high[1] >> s.cell.high[2];
			for (int k = 0; k < 3; ++k) s.cell.periodic[k] = s.cell.high[k] > 0;
		} else if (line.rfind("gravity", 0) == 0) {
			in >> word >> s.gravity[0] >> s.gravity[1] >> s.gravity[2];
		} else if (line.rfind("dt", 0) == 0) {
			in >> word >> s.dt;
		} else if (line.rfind("restitution", 0) == 0) {
			in >> word >> a >> b >> c >> d;
			s.law = laws::hertz_restitution(a, b, c, d);
		} else if (line.rfind("history", 0) == 0) {
			in >> word >> a >> b >> c >> d >> e;
			s.law = laws::HertzHistory<Real>{ a, b, c, d, e };
		} else {
			Grain<3> one;
			bool held = false;
			in >> held >> one.place[0] >> one.place[1] >> one.place[2] >> one.radius >> one.mass >> one.velocity[0] >>
				one.velocity[1] >> one.velocity[2] >> one.spin[0] >> one.spin[1] >> one.spin[2];
			if (!in) continue;
			if (held) one.mass = HUGE_VAL, one.body = 0;  // as LAMMPS and LIGGGHTS do for frozen atoms
			s.grains.push_back(one);
		}
	}
	return s;
}

void write_spheres(const Stepper<3>& loop, const char* path)
{
	std::FILE* file = std::fopen(path, "w");
	for (std::size_t i = 0; i < loop.size(); ++i) {
		const Grain<3> s = loop.grain(i);
		std::fprintf(file, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", s.body == 0, s.place[0],
			s.place[1], s.place[2], s.radius, s.body == 0 ? 1.0 : s.mass, s.velocity[0], s.velocity[1], s.velocity[2], s.spin[0],
			s.spin[1], s.spin[2]);
	}
	std::fclose(file);
}

}  // namespace

int main(int argc, char** argv)
{
	if (argc < 3) return std::fprintf(stderr, "usage: sphere_bench SCENE STEPS [THREADS] [double|single] [PORTIONS] [OUT]\n"), 2;
	Scene<3> s = read_scene(argv[1]);
	const long n = std::atol(argv[2]);
	s.threads = argc > 3 ? std::atoi(argv[3]) : 1;
	s.precision = argc > 4 && std::string(argv[4]) == "single" ? Precision::single : Precision::double_;
	const int portions = argc > 5 ? std::atoi(argv[5]) : 1;
	Stepper<3> loop(s);
	loop.begin_on_step();
	for (int k = 0; k < portions; ++k) {
		const auto t0 = std::chrono::steady_clock::now();
		const auto c0 = std::clock();
		const long steps = k ? n : n - 1;  // begin_on_step was the first step
		loop.step(steps);
		const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(),
					 cpu = (std::clock() - c0) / double(CLOCKS_PER_SEC);
		std::printf("wall %.1f M/s  cpu %.1f M/s  ke %.15g  pairs/sphere %.2f  searches %ld selections %ld  %s %d\n",
			s.grains.size() * steps / wall / 1e6, s.grains.size() * steps / cpu / 1e6, loop.kinetic_energy_on_step(),
			double(loop.pairs_selected()) / s.grains.size(), loop.searches_done(), loop.selections_done(),
			name_of(loop.processor_in_use()).c_str(), loop.pairs_at_once());
		std::fflush(stdout);
	}
	if (argc > 6) write_spheres(loop, argv[6]);
}
