/// The connected parts of the open cells: each has its own constant of the pressure.
#pragma once
#include <cstddef>
#include <vector>

#include "engines/continuum/pressure/face_coefficients.hpp"
#include "engines/continuum/pressure/split_grid.hpp"

namespace graindrive::continuum {

/// Neighbouring cells of one row and one part: from `first` to before `last`.
struct Run {
	int row, first, last, part;
};

class Parts {
public:
	/// Finds the parts again if a face has opened or closed since the last call.
	/// @param least faces with b <= least are closed
	/// @return true if the parts may have changed
	bool update(const FaceCoefficients& b, double least);

	std::size_t count() const { return cells.size(); }
	const std::vector<Run>& runs() const { return all_runs; }
	/// By row, the packs with open cells.
	const std::vector<Span>& spans() const { return open_spans; }
	/// How many cells belong to any part, and to each.
	long open_cells() const;
	const std::vector<long>& cells_of_part() const { return cells; }
	/// The mean over each part, numbers in natural order.
	void means(const double* numbers, std::vector<double>& mean) const;
	/// The largest |number| outside of all parts.
	double largest_outside(const double* numbers) const;

private:
	void find_runs();
	void join_runs();

	int nx = 0, ny = 0;
	std::vector<unsigned char> open_x, open_y;  // faces, as in FaceCoefficients
	std::vector<Run> all_runs;
	std::vector<long> cells;
	std::vector<Span> open_spans;
};

}  // namespace graindrive::continuum
