/// The open cells as a plain vector, for preconditioners that do not work on the grid.
#pragma once
#include <vector>

#include "engines/continuum/pressure/five_point.hpp"

namespace graindrive::continuum {

struct OpenCells {
	std::vector<std::size_t> places;  // of each open cell in a field, row by row
	std::vector<int> number;          // by place; -1 where closed
	std::vector<int> first_of_part;   // number of one cell of each part

	void find(const FivePoint& matrix)
	{
		const SplitGrid& grid = matrix.grid();
		places.clear();
		number.assign(grid.size(), -1);
		first_of_part.assign(matrix.parts().count(), -1);
		for (const Run& run : matrix.parts().runs())
			for (int x = run.first; x < run.last; ++x) {
				const std::size_t place = grid.index(x, run.row);
				number[place] = int(places.size());
				if (first_of_part[run.part] < 0) first_of_part[run.part] = number[place];
				places.push_back(place);
			}
	}
	void gather(const Field<double>& from, double* to) const
	{
		for (std::size_t k = 0; k < places.size(); ++k) to[k] = from.data()[places[k]];
	}
	void scatter(const double* from, Field<double>& to) const
	{
		for (std::size_t k = 0; k < places.size(); ++k) to.data()[places[k]] = from[k];
	}
	/// Calls work(number, number of a neighbour to the east or north, link).
	template <class Work>
	void for_links(const FivePoint& matrix, Work&& work) const
	{
		const SplitGrid& grid = matrix.grid();
		for (const Run& run : matrix.parts().runs())
			for (int x = run.first; x < run.last; ++x) {
				const std::size_t place = grid.index(x, run.row);
				const int east = number[grid.index(x + 1, run.row)], north = number[grid.index(x, run.row + 1)];
				if (matrix.east.data()[place] > 0) work(number[place], east, matrix.east.data()[place]);
				if (matrix.north.data()[place] > 0) work(number[place], north, matrix.north.data()[place]);
			}
	}
};

}  // namespace graindrive::continuum
