/// Divides by the diagonal: the simplest preconditioner.
#include "engines/continuum/pressure/preconditioner.hpp"

namespace graindrive::continuum {
namespace {

class Jacobi : public Preconditioner {
public:
	std::string name() const override { return "jacobi"; }
	void update(const FivePoint& present, bool) override { matrix = &present; }
	double apply(const Field<double>& r, Field<double>& z) override
	{
		for_packs(matrix->grid(), matrix->spans(),
			[&](std::size_t i) { pack(z.data() + i) = pack(matrix->inverse_diagonal.data() + i) * pack(r.data() + i); });
		return dot(matrix->grid(), matrix->spans(), r, z);
	}

private:
	const FivePoint* matrix = nullptr;
};

}  // namespace

std::unique_ptr<Preconditioner> make_jacobi_preconditioner() { return std::make_unique<Jacobi>(); }

}  // namespace graindrive::continuum
