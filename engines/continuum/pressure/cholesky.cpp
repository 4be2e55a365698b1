/// Preconditions with the sparse Cholesky factor of an earlier matrix, which is computed again when solves take too many
/// iterations.
#include <Eigen/SparseCholesky>

#include "engines/continuum/pressure/open_cells.hpp"
#include "engines/continuum/pressure/preconditioner.hpp"

namespace graindrive::continuum {
namespace {

// A factor costs as much as some tens of iterations, so it is kept until a solve takes more iterations than this.
constexpr int most_iterations = 8;

class Cholesky : public Preconditioner {
public:
	std::string name() const override { return "cholesky"; }

	void update(const FivePoint& matrix, bool new_shape) override
	{
		if (new_shape) {
			cells.find(matrix);
			const long n = long(cells.places.size());
			from.resize(n);
			turned.resize(n);
			solution.resize(n);
			fill(matrix);
			factor.analyzePattern(lower);
			aged = true;
		}
		if (!aged) return;
		fill(matrix);
		factor.factorize(lower);
		aged = false;
	}

	double apply(const Field<double>& r, Field<double>& z) override
	{
		cells.gather(r, from.data());
		turned.noalias() = factor.permutationP() * from;
		factor.matrixL().solveInPlace(turned);
		factor.matrixU().solveInPlace(turned);
		solution.noalias() = factor.permutationPinv() * turned;
		cells.scatter(solution.data(), z);
		return from.dot(solution);
	}

	void took(int iterations) override { aged |= iterations > most_iterations; }

private:
	// One cell of each connected part gets a link to p = 0 as strong as its other links together. This makes the matrix definite;
	// for a right side with zero mean the solution is still exact.
	void fill(const FivePoint& matrix)
	{
		const int n = int(cells.places.size());
		std::vector<Eigen::Triplet<double>> entries;
		std::vector<double> diagonal(n);
		cells.for_links(matrix, [&](int a, int b, double link) {
			entries.emplace_back(std::max(a, b), std::min(a, b), -link);
			diagonal[a] += link, diagonal[b] += link;
		});
		for (const int tied : cells.first_of_part) diagonal[tied] *= 2;
		for (int k = 0; k < n; ++k) entries.emplace_back(k, k, diagonal[k]);
		lower.resize(n, n);
		lower.setFromTriplets(entries.begin(), entries.end());
	}

	OpenCells cells;
	Eigen::SparseMatrix<double> lower;
	Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>> factor;
	Eigen::VectorXd from, turned, solution;
	bool aged = true;
};

}  // namespace

std::unique_ptr<Preconditioner> make_cholesky_preconditioner() { return std::make_unique<Cholesky>(); }

}  // namespace graindrive::continuum
