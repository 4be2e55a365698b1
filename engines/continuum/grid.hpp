/// A grid of square cells with two layers of ghosts, fields in its cells, and vectors on its faces (marker and cell).
#pragma once
#include <cstddef>
#include <vector>

namespace graindrive::continuum {

using Values = std::vector<double>;

/// Cells (i, j), 0 <= i < nx, 0 <= j < ny; x fastest. Face x (i, j) is to the left of cell (i, j), face y (i, j) below it, node (i, j) at
/// its lower left corner. All of them lie in arrays of one shape, so that neighbours are one step or one stride away.
struct Grid {
	static constexpr int ghosts = 2;

	int nx = 0, ny = 0;
	double spacing = 1;           ///< side of a cell
	double low_x = 0, low_y = 0;  ///< lower left corner of cell (0, 0)
	bool periodic_x = false;      ///< left and right edge are one; otherwise all edges are closed

	std::size_t stride() const { return std::size_t(nx + 2 * ghosts); }
	std::size_t size() const { return stride() * std::size_t(ny + 2 * ghosts); }
	std::size_t at(int i, int j) const { return std::size_t(j + ghosts) * stride() + std::size_t(i + ghosts); }

	double centre_x(int i) const { return low_x + (i + 0.5) * spacing; }
	double centre_y(int j) const { return low_y + (j + 0.5) * spacing; }
	double face_x(int i) const { return low_x + i * spacing; }
	double face_y(int j) const { return low_y + j * spacing; }

	Values zeros() const { return Values(size(), 0.0); }

	/// `work(i, j, index)` for every cell, row by row.
	template <class Work>
	void for_cells(Work&& work) const
	{
		for (int j = 0; j < ny; ++j) {
			const std::size_t row = at(0, j);
			for (int i = 0; i < nx; ++i) work(i, j, row + std::size_t(i));
		}
	}
	/// The same for the x faces whose velocity is free: between two cells, or at the edge of a periodic grid (once, at i = 0).
	template <class Work>
	void for_x_faces(Work&& work) const
	{
		for (int j = 0; j < ny; ++j)
			for (int i = periodic_x ? 0 : 1; i < nx; ++i) work(i, j, at(i, j));
	}
	/// The same for y faces.
	template <class Work>
	void for_y_faces(Work&& work) const
	{
		for (int j = 1; j < ny; ++j)
			for (int i = 0; i < nx; ++i) work(i, j, at(i, j));
	}
};

/// A vector by its components on the faces across them.
struct FaceValues {
	Values x, y;
};

inline FaceValues zero_faces(const Grid& grid) { return { grid.zeros(), grid.zeros() }; }

/// What a closed edge does to the velocity along it.
enum class Edge { slips, sticks };

/// Cell values continue without change beyond closed edges.
void fill_ghosts(const Grid& grid, Values& cells);

/// Cell values go on beyond closed edges as straight lines through the last two cells: of a pressure, which has a slope there.
void extrapolate_ghosts(const Grid& grid, Values& cells);

/// No flow through closed edges; along them the mirror image, or its opposite where the edge holds the fluid.
void fill_ghosts(const Grid& grid, FaceValues& velocity, Edge edge);

/// (u_right - u_left + v_top - v_bottom)/spacing in each cell
void divergence(const Grid& grid, const FaceValues& flow, Values& cells);

}  // namespace graindrive::continuum
