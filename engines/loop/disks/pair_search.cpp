/// Finds each pair once: a free grain is compared with the rest of its cell and with the cells after it, a member of a body with
/// all cells around it.
#include "engines/loop/disks/pair_search.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

struct Search {
	const State<2>& in;
	const CellGrid& grid;
	std::vector<Candidate>& found;

	void if_near(std::uint32_t a, std::uint32_t b) const
	{
		const DiskRow &one = in.rows[a], &other = in.rows[b];
		const Vec<2> d = other.x - one.x;
		const double reach = one.radius + other.radius + in.skin;
		if (geometry::squared_norm(d) < reach * reach) found.push_back({ a, b, false, false });
	}

	void if_near_wrapped(std::uint32_t a, std::uint32_t b) const
	{
		const DiskRow &one = in.rows[std::min(a, b)], &other = in.rows[std::max(a, b)];
		const geometry::Image<2> d = in.scene.cell.nearest(other.x - one.x);
		const double reach = one.radius + other.radius + in.skin;
		if (geometry::squared_norm(d.at) < reach * reach) found.push_back({ std::min(a, b), std::max(a, b), d.wrapped, false });
	}

	/// Pairs of grain a with the cells after (s, f) that lie across a periodic side or in another strip.
	void across_the_sides(std::uint32_t a, int s, int f) const
	{
		constexpr int ahead[4][2] = { { 0, 1 }, { 1, -1 }, { 1, 0 }, { 1, 1 } };
		for (const auto& step : ahead) {
			int to_s = s + step[0], to_f = f + step[1];
			const bool over_s = to_s >= grid.slow.cells, over_f = to_f < 0 || to_f >= grid.fast.cells;
			if ((over_s && !grid.slow.periodic) || (over_f && !grid.fast.periodic)) continue;
			if (in.scene.cell.sheared() && (grid.fast_is_x ? over_s : over_f)) continue;  // across_the_shear finds these
			const bool same_strip = !over_f && to_f / grid.strip_height == f / grid.strip_height;
			if (same_strip && !over_s) continue;
			to_s %= grid.slow.cells;
			to_f = (to_f + grid.fast.cells) % grid.fast.cells;
			const int c = grid.index(to_s, to_f);
			for (std::uint32_t b = grid.start[c]; b < grid.start[c + 1]; ++b) if_near_wrapped(a, b);
		}
	}

	void free_pairs() const
	{
		for (int s = 0; s < grid.slow.cells; ++s)
			for (int f = 0; f < grid.fast.cells; ++f) {
				const int c = grid.index(s, f), next = c + grid.stride();
				const int in_strip = f % grid.strip_height;
				const bool at_side =
					s + 1 == grid.slow.cells || in_strip == 0 || in_strip + 1 == grid.strip_height || f + 1 == grid.fast.cells;
				for (std::uint32_t a = grid.start[c]; a < grid.start[c + 1]; ++a) {
					for (std::uint32_t b = a + 1; b < grid.start[c + 2]; ++b) if_near(a, b);
					for (std::uint32_t b = grid.start[next - 1]; b < grid.start[next + 2]; ++b) if_near(a, b);
					if (at_side) across_the_sides(a, s, f);
				}
			}
	}

	/// Cells of an axis that positions within `reach` of `at` may fall into, unwrapped.
	static std::pair<int, int> range(const GridAxis& axis, double at, double reach)
	{
		if (!axis.periodic) return { axis.cell(at - reach), axis.cell(at + reach) };
		const int first = static_cast<int>(std::floor((at - reach - axis.low) * axis.per_length));
		const int last = static_cast<int>(std::floor((at + reach - axis.low) * axis.per_length));
		return { first, std::min(last, first + axis.cells - 1) };
	}

	void around_member(std::uint32_t member) const
	{
		const DiskRow& row = in.rows[member];
		const double reach = row.radius + in.largest_free_radius + in.skin;
		const auto s = range(grid.slow, grid.slow_of(row.x), reach), f = range(grid.fast, grid.fast_of(row.x), reach);
		for (int to_s = s.first; to_s <= s.second; ++to_s)
			for (int to_f = f.first; to_f <= f.second; ++to_f) {
				const int c = grid.index((to_s % grid.slow.cells + grid.slow.cells) % grid.slow.cells,
					(to_f % grid.fast.cells + grid.fast.cells) % grid.fast.cells);
				for (std::uint32_t a = grid.start[c]; a < grid.start[c + 1]; ++a) if_near_wrapped(a, member);
			}
	}

	/// Pairs of the last layer of cells in y with the first, whose images are shifted by `offset` along x.
	void across_the_shear() const
	{
		const GridAxis &x = grid.fast_is_x ? grid.fast : grid.slow, &y = grid.fast_is_x ? grid.slow : grid.fast;
		const auto index = [&](int in_x, int in_y) { return grid.fast_is_x ? grid.index(in_y, in_x) : grid.index(in_x, in_y); };
		for (int column = 0; column < x.cells; ++column) {
			const int top = index(column, y.cells - 1);
			for (std::uint32_t a = grid.start[top]; a < grid.start[top + 1]; ++a) {
				const DiskRow& row = in.rows[a];
				const double reach = row.radius + in.largest_free_radius + in.skin;
				const auto below = range(x, row.x[0] - in.scene.cell.offset, reach);
				for (int to = below.first; to <= below.second; ++to) {
					const int bottom = index((to % x.cells + x.cells) % x.cells, 0);
					for (std::uint32_t b = grid.start[bottom]; b < grid.start[bottom + 1]; ++b) if_near_wrapped(a, b);
				}
			}
		}
	}

	void between_members() const
	{
		for (std::uint32_t a = in.n_free; a < in.n; ++a)
			for (std::uint32_t b = a + 1; b < in.n; ++b) {
				const int one = in.members[a - in.n_free].body, other = in.members[b - in.n_free].body;
				if (one != other && !(in.body_fixed[one] && in.body_fixed[other])) if_near_wrapped(a, b);
			}
	}

	bool several_bodies_may_meet() const
	{
		return in.scene.bodies.size() > 1 && std::count(in.body_fixed.begin(), in.body_fixed.end(), char(0)) > 0;
	}
};

/// Counting sort by owner, then insertion sort of the few pairs of each owner.
void sort_by_owner(std::vector<Candidate>& pairs, std::uint32_t n_grains)
{
	static thread_local std::vector<std::uint32_t> begin, end;
	static thread_local std::vector<Candidate> sorted;
	begin.assign(n_grains + 1, 0);
	sorted.resize(pairs.size());
	for (const Candidate& pair : pairs) ++begin[pair.first + 1];
	for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
	end = begin;
	for (const Candidate& pair : pairs) {
		std::uint32_t at = end[pair.first]++;
		for (; at > begin[pair.first] && sorted[at - 1].second > pair.second; --at) sorted[at] = sorted[at - 1];
		sorted[at] = pair;
	}
	pairs.swap(sorted);
}

}  // namespace

void find_candidates(const State<2>& in, const CellGrid& grid, std::vector<Candidate>& candidates)
{
	candidates.clear();
	static thread_local std::vector<Candidate> others;
	others.clear();
	if (in.n_free > 0) {
		Search{ in, grid, candidates }.free_pairs();
		if (in.scene.cell.sheared()) Search{ in, grid, others }.across_the_shear();
		for (std::uint32_t member = in.n_free; member < in.n; ++member) Search{ in, grid, others }.around_member(member);
	}
	if (Search{ in, grid, others }.several_bodies_may_meet()) Search{ in, grid, others }.between_members();
	candidates.insert(candidates.end(), others.begin(), others.end());
	sort_by_owner(candidates, in.n);
}

}  // namespace graindrive::loop
