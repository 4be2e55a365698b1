/// Common parts of all pressure solvers: the matrix, checks of the input, mean values by part, the true residual.
#pragma once
#include "engines/continuum/pressure/pressure_solver.hpp"
#include "engines/continuum/pressure/preconditioner.hpp"

namespace graindrive::continuum {

class KrylovSolver : public PressureSolver {
public:
	explicit KrylovSolver(std::unique_ptr<Preconditioner> preconditioner) : preconditioner(std::move(preconditioner)) {}
	void update(const FaceCoefficients& b) override;
	SolveReport solve(const std::vector<double>& rhs, std::vector<double>& p, double relative_tolerance) override;

protected:
	/// Memory of the grid's shape.
	virtual void reshape(const SplitGrid& grid) = 0;
	/// Improves x, whose residual is r, until r r <= target; at most `limit` iterations. Returns how many it took.
	virtual int iterate(double target, int limit) = 0;

	/// True if r r has found no new minimum for so long that nothing but rounding can be left.
	bool stalled(double rr);

	FivePoint matrix;
	std::unique_ptr<Preconditioner> preconditioner;
	Field<double> x, r;

private:
	void check(const std::vector<double>& rhs, const std::vector<double>& p, double relative_tolerance) const;
	double load_right_side(const std::vector<double>& rhs, SolveReport& report);
	void load_guess(const std::vector<double>& p);
	void store(std::vector<double>& p);
	void refuse_not_finite(const char* what, const std::vector<double>& numbers) const;

	Field<double> f, best;
	std::vector<double> mean, row;
	double least_rr = 0;
	int since_least = 0;
};

std::unique_ptr<PressureSolver> make_conjugate_gradients(std::unique_ptr<Preconditioner> preconditioner);
/// The drum paper's choice.
std::unique_ptr<PressureSolver> make_bicgstab(std::unique_ptr<Preconditioner> preconditioner);

}  // namespace graindrive::continuum
