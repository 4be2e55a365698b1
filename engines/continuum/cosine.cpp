/// The Poisson equation with one density in the whole box as preconditioner, solved by cosine transforms; for comparison.
#include <Eigen/Dense>
#include <cmath>

#include "engines/continuum/preconditioner.hpp"

namespace graindrive::continuum {
namespace {

// Orthonormal cosines of n cells between closed ends (DCT-II), a column each.
Eigen::MatrixXd cosines(int n)
{
	Eigen::MatrixXd c(n, n);
	for (int i = 0; i < n; ++i)
		for (int k = 0; k < n; ++k) c(i, k) = std::sqrt((k == 0 ? 1.0 : 2.0) / n) * std::cos(M_PI * k * (i + 0.5) / n);
	return c;
}

// Which value of the density counts as one for all does not matter: conjugate gradients do not see a factor.
// The transforms are products of matrices, for lengths such as 107 and 400 no slower than a fast one that is not made for them.
class Cosine : public Preconditioner {
public:
	std::string name() const override { return "cosine"; }

	void update(const FivePoint& present, bool new_shape) override
	{
		matrix = &present;
		if (!new_shape) return;
		const int nx = present.grid().nx, ny = present.grid().ny;
		along = cosines(nx), across = cosines(ny);
		waves = half = numbers = Eigen::MatrixXd::Zero(nx, ny);
		inverse.resize(nx, ny);
		for (int i = 0; i < nx; ++i)
			for (int j = 0; j < ny; ++j) {
				const double size = 4 - 2 * std::cos(M_PI * i / nx) - 2 * std::cos(M_PI * j / ny);
				inverse(i, j) = i + j > 0 ? 1 / size : 0;
			}
		inverse(0, 0) = inverse.maxCoeff();  // parts may differ by a constant: the mean of one part is a wave as any other
	}

	double apply(const Field<double>& r, Field<double>& z) override
	{
		const SplitGrid& grid = matrix->grid();
		for (int y = 0; y < grid.ny; ++y) merge_row(r.row(y, 0), r.row(y, 1), grid.nx, numbers.col(y).data());
		half.noalias() = along.transpose() * numbers;
		waves.noalias() = half * across;
		waves.array() *= inverse.array();
		half.noalias() = along * waves;
		numbers.noalias() = half * across.transpose();
		const Pack<double> zero = {};
		for (int y = 0; y < grid.ny; ++y) {
			split_row(numbers.col(y).data(), grid.nx, z.row(y, 0), z.row(y, 1));
			for (const int parity : { 0, 1 })
				for (int k = 0; 2 * k < grid.nx; k += lanes) {
					const Pack<double> there = pack(z.row(y, parity) + k);
					pack(z.row(y, parity) + k) = pack(matrix->inverse_diagonal.row(y, parity) + k) > zero ? there : zero;
				}
		}
		return dot(grid, matrix->spans(), r, z);
	}

private:
	const FivePoint* matrix = nullptr;
	Eigen::MatrixXd along, across, inverse, numbers, half, waves;
};

}  // namespace

std::unique_ptr<Preconditioner> make_cosine_preconditioner() { return std::make_unique<Cosine>(); }

}  // namespace graindrive::continuum
