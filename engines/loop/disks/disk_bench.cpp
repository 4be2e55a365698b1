/// Runs a scene of disks from a text file for some steps and prints the speed; scripts/bench calls it.
#include <chrono>
#include <ctime>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "engines/loop/stepper.hpp"

using namespace graindrive;
using namespace graindrive::loop;

int main(int argc, char** argv)
{
	if (argc < 4) return std::fprintf(stderr, "usage: disk_bench DUMP WIDTH STEPS [THREADS] [double|single]\n"), 2;
	Scene<2> s;
	std::ifstream in(argv[1]);
	std::string line;
	while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0) {}
	long id;
	int type;
	double diameter, mass, x, y, vx, vy, w;
	s.bodies.push_back({});
	while (in >> id >> type >> diameter >> mass >> x >> y >> vx >> vy >> w)
		s.grains.push_back({ x, y, vx, vy, w, diameter / 2, mass, type == 1 ? free_grain : 0 });
	for (auto& g : s.grains)
		if (g.body == 0) g.mass = HUGE_VAL;
	s.cell = { { 0, 0 }, { std::atof(argv[2]), 0 }, { true, false } };
	s.law = laws::HertzHistory<Real>{ 2e6, 2.46e6, 2500, 2500, 0.1 };
	s.gravity[1] = -1;
	s.dt = 1e-4;
	s.threads = argc > 4 ? std::atoi(argv[4]) : 1;
	s.precision = argc > 5 && std::string(argv[5]) == "single" ? Precision::single : Precision::double_;
	Stepper<2> loop(s);
	loop.begin_on_step();
	const long n = std::atol(argv[3]);
	const auto t0 = std::chrono::steady_clock::now();
	const auto c0 = std::clock();
	for (int k = 0; k < 10; ++k) {
		loop.step(n / 10 - (k == 0));
		if (argc > 6) std::printf("%ld %.15g\n", loop.steps_done(), loop.kinetic_energy_on_step());
	}
	const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(),
				 cpu = (std::clock() - c0) / double(CLOCKS_PER_SEC);
	std::printf("%.1f M/s (cpu %.1f) ke %.15g  pairs %zu contacts %zu searches %ld selections %ld width %d\n",
		s.grains.size() * n / wall / 1e6, s.grains.size() * n / cpu / 1e6, loop.kinetic_energy_on_step(), loop.pairs_selected(),
		loop.contacts().size(), loop.searches_done(), loop.selections_done(), loop.pairs_at_once());
}
