/// The implicit part of a step's momentum equation: what viscosity does to the velocity within the step.
#pragma once
#include "engines/continuum/domain.hpp"
#include "engines/continuum/stresses.hpp"

namespace graindrive::continuum {

struct MomentumReport {
	int iterations = 0;
	double residual = 0;  ///< relative to that of the first guess [-]
};

/// Solves (1 - a laplace) delta = given on the open faces, delta = 0 elsewhere, each component alone, by conjugate gradients: SMAC's
/// constant part nu_0 of the viscosity. Oba, Otsuki (2025), (42).
class SplitViscosity {
public:
	SplitViscosity(const Grid& grid, const Domain& domain, Edge edge);
	/// `delta` in: first guess, out: solution. @throws std::runtime_error if the tolerance is not reached
	MomentumReport solve(double a, const FaceValues& given, FaceValues& delta, double tolerance);

private:
	Grid grid;
	Edge edge;
	FaceValues free;  ///< 1 on faces whose velocity is unknown
	FaceValues direction, image, rest;

	void apply(double a, FaceValues& of, FaceValues& result) const;
};

/// Solves  inertia v - div(eta (grad v + grad v^T)) = given  on faces with inertia < infinity; on the others v stays as it comes in.
///
/// `inertia` is rho/(chi dt). Both components are one system, symmetric and positive, solved by conjugate gradients with the diagonal as
/// preconditioner. There is no bound on the time step from viscosity.
class FullViscosity {
public:
	FullViscosity(const Grid& grid, const Domain& domain, Edge edge);
	/// `velocity` in: first guess, and fixed values; out: solution. @throws std::runtime_error if the tolerance is not reached
	MomentumReport solve(
		const FaceValues& inertia, const Viscosities& viscosity, const FaceValues& given, FaceValues& velocity, double tolerance);

private:
	Grid grid;
	Edge edge;
	FaceValues free, direction, image, rest, preconditioned, over_diagonal;
	Rates rates, stresses;

	void apply(const FaceValues& inertia, const Viscosities& viscosity, FaceValues& of, FaceValues& result);
	void find_diagonal(const FaceValues& inertia, const Viscosities& viscosity);
};

}  // namespace graindrive::continuum
