/// After the first step on a grid a solver allocates no memory.
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "engines/continuum/pressure/drum_example.hpp"
#include "engines/continuum/pressure/extrapolation.hpp"
#include "engines/continuum/pressure/pressure_solver.hpp"

namespace {
long allocations = 0;

void* counted(std::size_t size, std::size_t alignment)
{
	++allocations;
	void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
	if (!memory) throw std::bad_alloc();
	return memory;
}
}  // namespace

// Counts all allocations by C++'s `new`. Eigen calls malloc directly and is not counted.
void* operator new(std::size_t size) { return counted(size, 16); }
void* operator new(std::size_t size, std::align_val_t alignment) { return counted(size, std::size_t(alignment)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace graindrive::continuum {
namespace {

TEST(PressureSolver, AllocatesNothingInAStep)
{
	for (const char* name : { "multigrid", "jacobi", "bicgstab" }) {
		DrumExample drum;
		drum.n = 50;
		const auto solver = make_pressure_solver(name);
		Extrapolation past(2);
		std::vector<double> p(2500);
		long in_last_step = -1;
		for (int step = 0; step < 5; ++step) {
			const FaceCoefficients b = drum.coefficients();
			const std::vector<double> rhs = drum.right_side();
			const long before = allocations;
			solver->update(b);
			past.predict(p);
			const SolveReport report = solver->solve(rhs, p, 1e-6);
			past.remember(p);
			in_last_step = allocations - before;
			EXPECT_GT(report.iterations, 0);
			drum.angle += 0.01;
		}
		EXPECT_EQ(in_last_step, 0) << name;
	}
}

}  // namespace
}  // namespace graindrive::continuum
