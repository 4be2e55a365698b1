/// Finds the connected parts of the open cells: runs in each row are joined from row to row (union-find).
#include "engines/continuum/pressure/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graindrive::continuum {
namespace {

bool same(const std::vector<double>& b, double least, const std::vector<unsigned char>& open)
{
	if (b.size() != open.size()) return false;
	int differ = 0;
	for (std::size_t i = 0; i < b.size(); ++i) differ |= int(b[i] > least) ^ open[i];
	return differ == 0;
}

void remember(const std::vector<double>& b, double least, std::vector<unsigned char>& open)
{
	open.resize(b.size());
	for (std::size_t i = 0; i < b.size(); ++i) open[i] = b[i] > least;
}

double sum(const double* numbers, int n)
{
	Pack<double> lots = {};
	const int whole = rounded_down(n);
	for (int i = 0; i < whole; i += lanes) lots += pack(numbers + i);
	double rest = 0;
	for (int i = whole; i < n; ++i) rest += numbers[i];
	return sum_of<double>(lots) + rest;
}

int root(std::vector<int>& parent, int i)
{
	while (parent[i] != i) i = parent[i] = parent[parent[i]];
	return i;
}

}  // namespace

bool Parts::update(const FaceCoefficients& b, double least)
{
	if (b.nx == nx && b.ny == ny && same(b.x, least, open_x) && same(b.y, least, open_y)) return false;
	nx = b.nx, ny = b.ny;
	remember(b.x, least, open_x);
	remember(b.y, least, open_y);
	find_runs();
	join_runs();
	return true;
}

void Parts::find_runs()
{
	all_runs.clear();
	open_spans.assign(ny, {});
	for (int j = 0; j < ny; ++j) {
		const unsigned char *left = &open_x[std::size_t(nx + 1) * j], *below = &open_y[std::size_t(nx) * j], *above = below + nx;
		int first = nx, last = 0;
		for (int i = 0; i < nx; ++i) {
			if (!left[i] && !left[i + 1] && !below[i] && !above[i]) continue;
			if (left[i])
				all_runs.back().last = i + 1;
			else
				all_runs.push_back({ j, i, i + 1, 0 });
			first = std::min(first, i), last = i + 1;
		}
		if (first < last) open_spans[j] = { rounded_down(first / 2), rounded_up((last + 1) / 2) };
	}
}

void Parts::join_runs()
{
	std::vector<int> parent(all_runs.size());
	std::iota(parent.begin(), parent.end(), 0);
	std::vector<int> run_below(nx, -1), run_here(nx, -1);
	std::size_t next = 0;
	for (int j = 0; j < ny; ++j) {
		std::fill(run_here.begin(), run_here.end(), -1);
		for (; next < all_runs.size() && all_runs[next].row == j; ++next)
			std::fill(run_here.begin() + all_runs[next].first, run_here.begin() + all_runs[next].last, int(next));
		for (int i = 0; i < nx; ++i)
			if (open_y[i + std::size_t(nx) * j]) {
				const int a = root(parent, run_below[i]), b = root(parent, run_here[i]);
				parent[std::max(a, b)] = std::min(a, b);
			}
		run_below.swap(run_here);
	}
	cells.clear();
	for (std::size_t k = 0; k < all_runs.size(); ++k) {
		Run& run = all_runs[k];
		const int first_of_part = root(parent, int(k));
		if (first_of_part == int(k)) {
			run.part = int(cells.size());
			cells.push_back(0);
		} else {
			run.part = all_runs[first_of_part].part;
		}
		cells[run.part] += run.last - run.first;
	}
}

long Parts::open_cells() const { return std::accumulate(cells.begin(), cells.end(), 0L); }

void Parts::means(const double* numbers, std::vector<double>& mean) const
{
	mean.assign(cells.size(), 0);
	for (const Run& run : all_runs) mean[run.part] += sum(numbers + std::size_t(nx) * run.row + run.first, run.last - run.first);
	for (std::size_t part = 0; part < cells.size(); ++part) mean[part] /= double(cells[part]);
}

double Parts::largest_outside(const double* numbers) const
{
	double largest = 0;
	std::size_t from = 0;
	const auto look = [&](std::size_t to) {
		for (std::size_t i = from; i < to; ++i) largest = std::max(largest, std::abs(numbers[i]));
	};
	for (const Run& run : all_runs) {
		look(std::size_t(nx) * run.row + run.first);
		from = std::size_t(nx) * run.row + run.last;
	}
	look(std::size_t(nx) * ny);
	return largest;
}

}  // namespace graindrive::continuum
