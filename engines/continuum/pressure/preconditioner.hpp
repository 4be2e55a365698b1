/// What conjugate gradients ask of a preconditioner.
#pragma once
#include <memory>
#include <string>

#include "engines/continuum/pressure/five_point.hpp"

namespace graindrive::continuum {

/// A symmetric approximation of the inverse of the matrix: x·My = y·Mx, and x·Mx > 0 for x without mean over the parts.
class Preconditioner {
public:
	virtual ~Preconditioner() = default;
	virtual std::string name() const = 0;
	/// The matrix has changed. `new_shape`: so have the grid or its parts.
	virtual void update(const FivePoint& matrix, bool new_shape) = 0;
	/// z = M r; the result is r z. r and z are 0 in closed cells. A constant on a part that z has too much or too little does no harm.
	virtual double apply(const Field<double>& r, Field<double>& z) = 0;
	/// How many iterations the last solve took: one that keeps an older matrix decides by it when to take the present one.
	virtual void took(int /*iterations*/) {}
};

/// Division by the diagonal.
std::unique_ptr<Preconditioner> make_jacobi_preconditioner();
/// The Cholesky factor of an older matrix.
std::unique_ptr<Preconditioner> make_cholesky_preconditioner();
/// A cycle of multigrid.
std::unique_ptr<Preconditioner> make_multigrid_preconditioner();

}  // namespace graindrive::continuum
