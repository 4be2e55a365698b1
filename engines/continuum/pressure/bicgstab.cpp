/// Stabilised biconjugate gradients (van der Vorst 1992), preconditioned from the right. The drum paper uses them; here for
/// comparison.
#include "engines/continuum/pressure/krylov.hpp"

namespace graindrive::continuum {
namespace {

class BiCgStab : public KrylovSolver {
public:
	using KrylovSolver::KrylovSolver;
	std::string name() const override { return "bicgstab"; }

protected:
	void reshape(const SplitGrid& grid) override { shadow = p = v = t = y = z = Field<double>(grid); }

	int iterate(double target, int limit) override
	{
		each([&](std::size_t i) {
			pack(shadow.data() + i) = pack(r.data() + i);
			pack(p.data() + i) = pack(v.data() + i) = Pack<double>{};
		});
		double rho = 1, alpha = 1, omega = 1;
		for (int done = 0; done < limit; ++done) {
			const double rho_now = product_of(shadow, r), beta = rho_now / rho * (alpha / omega);
			rho = rho_now;
			if (rho == 0 || omega == 0) return done + 1;
			each([&](std::size_t i) {
				pack(p.data() + i) = pack(r.data() + i) + beta * (pack(p.data() + i) - omega * pack(v.data() + i));
			});
			preconditioner->apply(p, y);
			matrix.multiply(y, v);
			alpha = rho / product_of(shadow, v);
			add(x, alpha, y);
			add(r, -alpha, v);
			if (product_of(r, r) <= target) return done + 1;
			preconditioner->apply(r, z);
			matrix.multiply(z, t);
			omega = product_of(t, r) / product_of(t, t);
			add(x, omega, z);
			add(r, -omega, t);
			const double rr = product_of(r, r);
			if (rr <= target || stalled(rr)) return done + 1;
		}
		return limit;
	}

private:
	template <class Work>
	void each(Work&& work)
	{
		for_packs(matrix.grid(), matrix.spans(), work);
	}
	void add(Field<double>& to, double share, const Field<double>& what)
	{
		each([&](std::size_t i) { pack(to.data() + i) += share * pack(what.data() + i); });
	}
	double product_of(const Field<double>& a, const Field<double>& b) const { return dot(matrix.grid(), matrix.spans(), a, b); }

	Field<double> shadow, p, v, t, y, z;
};

}  // namespace

std::unique_ptr<PressureSolver> make_bicgstab(std::unique_ptr<Preconditioner> preconditioner)
{
	return std::make_unique<BiCgStab>(std::move(preconditioner));
}

}  // namespace graindrive::continuum
