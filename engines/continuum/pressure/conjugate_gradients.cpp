/// Preconditioned conjugate gradients (Hestenes, Stiefel 1952).
#include "engines/continuum/pressure/krylov.hpp"

namespace graindrive::continuum {
namespace {

class ConjugateGradients : public KrylovSolver {
public:
	using KrylovSolver::KrylovSolver;
	std::string name() const override { return preconditioner->name(); }

protected:
	void reshape(const SplitGrid& grid) override { z = direction = product = Field<double>(grid); }

	int iterate(double target, int limit) override
	{
		int done = 0;
		double rz_before = 0;
		while (done < limit) {
			const double rz = preconditioner->apply(r, z);
			const double curvature = matrix.turn_and_multiply(z, done > 0 ? rz / rz_before : 0, direction, product);
			if (!(rz > 0 && curvature > 0)) return done + 1;  // rounding errors are as large as the residual
			++done;
			const double rr = go(rz / curvature);
			if (rr <= target || stalled(rr)) break;
			rz_before = rz;
		}
		return done;
	}

private:
	// Steps along the direction. Returns the square of the new residual.
	double go(double step)
	{
		Pack<double> sum = {};
		for_packs(matrix.grid(), matrix.spans(), [&](std::size_t i) {
			pack(x.data() + i) += step * pack(direction.data() + i);
			const Pack<double> rest = pack(r.data() + i) - step * pack(product.data() + i);
			pack(r.data() + i) = rest;
			sum += rest * rest;
		});
		return sum_of<double>(sum);
	}

	Field<double> z, direction, product;
};

}  // namespace

std::unique_ptr<PressureSolver> make_conjugate_gradients(std::unique_ptr<Preconditioner> preconditioner)
{
	return std::make_unique<ConjugateGradients>(std::move(preconditioner));
}

}  // namespace graindrive::continuum
