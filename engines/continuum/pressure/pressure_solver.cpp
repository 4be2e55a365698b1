/// Makes a solver by its name.
#include "engines/continuum/pressure/pressure_solver.hpp"

#include <stdexcept>

#include "engines/continuum/pressure/krylov.hpp"

namespace graindrive::continuum {
namespace {

struct Named {
	const char* name;
	std::unique_ptr<PressureSolver> (*make)();
};

const Named table[] = {
	{ "multigrid", [] { return make_conjugate_gradients(make_multigrid_preconditioner()); } },
	{ "cholesky", [] { return make_conjugate_gradients(make_cholesky_preconditioner()); } },
	{ "jacobi", [] { return make_conjugate_gradients(make_jacobi_preconditioner()); } },
	{ "bicgstab", [] { return make_bicgstab(make_jacobi_preconditioner()); } },
};

}  // namespace

std::string default_pressure_solver() { return "multigrid"; }

std::vector<std::string> pressure_solvers()
{
	std::vector<std::string> names;
	for (const Named& one : table) names.push_back(one.name);
	return names;
}

std::unique_ptr<PressureSolver> make_pressure_solver(const std::string& name)
{
	std::string names;
	for (const Named& one : table) {
		if (name == one.name) return one.make();
		names += (names.empty() ? "" : ", ") + std::string(one.name);
	}
	throw std::invalid_argument("a pressure solver must be one of " + names + ", got '" + name + "'; choose one of these");
}

}  // namespace graindrive::continuum
