/// Finds each pair once: a free sphere is compared with the rest of its cell and with the cells after it in its tile, run by run;
/// in other tiles and across periodic sides with all cells around it, for partners that lie behind it in memory.
#include "engines/loop/spheres/sphere_search.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace graindrive::loop {

namespace {

constexpr std::uint32_t pack_room = 16;  // the kernel may read and write one pack beyond the end

/// Rows of contiguous cells of a tile.
struct Run {
	std::uint32_t begin, end;
};

bool in_order(const MemberPair& a, const MemberPair& b) { return a.owner != b.owner ? a.owner < b.owner : a.member < b.member; }

}  // namespace

void SphereSearch::begin(const State<3>& of, const SphereGrid& sorted)
{
	state = &of, grid = &sorted;
	fill_columns();
	with_members.clear();
	for (std::uint32_t m = state->n_free; m < state->n && state->n_free > 0; ++m) around_member(m);
	std::sort(with_members.begin(), with_members.end(), in_order);
	between_members();
}

/// True if the nearest images of two spheres are closer than the skin.
bool SphereSearch::near(std::uint32_t a, std::uint32_t b, bool& wrapped) const
{
	const SphereRow &one = state->rows[a], &other = state->rows[b];
	const geometry::Image<3> d = state->scene.cell.nearest(other.x - one.x);
	const double limit = one.radius + other.radius + state->skin;
	wrapped = d.wrapped;
	return geometry::squared_norm(d.at) < limit * limit;
}

void SphereSearch::between_members()
{
	members_alone.clear();
	const auto fixed = [&](std::uint32_t row) { return state->body_fixed[state->members[row - state->n_free].body] != 0; };
	const auto body = [&](std::uint32_t row) { return state->members[row - state->n_free].body; };
	if (state->scene.bodies.size() < 2) return;
	for (std::uint32_t a = state->n_free; a < state->n; ++a)
		for (std::uint32_t b = a + 1; b < state->n; ++b) {
			bool wrapped = false;
			if (body(a) == body(b) || (fixed(a) && fixed(b)) || !near(a, b, wrapped)) continue;
			members_alone.push_back({ a, b, wrapped });
		}
}

/// Positions in single precision, measured from the grid's corner. Their error is 1e-7 of the box; `rounding` allows for it.
void SphereSearch::fill_columns()
{
	const std::uint32_t n_free = state->n_free;
	const RowVector<3>& rows = state->rows;
	double corner[3], extent = 0;
	for (int q = 0; q < 3; ++q) {
		corner[grid->axis[q]] = grid->along[q].low;
		extent = std::max(extent, grid->along[q].length);
	}
	rounding = 1e-6 * extent;
	for (auto& c : column) c.resize(n_free + pack_room, 0);
	for (std::uint32_t i = 0; i < n_free; ++i) {
		for (int k = 0; k < 3; ++k) column[k][i] = rows[i].x[k] - corner[k];
		column[3][i] = rows[i].radius;
	}
}

void SphereSearch::around_member(std::uint32_t member)
{
	const SphereRow& row = state->rows[member];
	const double reach = row.radius + state->largest_free_radius + state->skin;
	int first[3], last[3];
	for (int q = 0; q < 3; ++q) {
		const GridAxis& axis = grid->along[q];
		const double at = row.x[grid->axis[q]];
		if (!axis.periodic) {
			first[q] = axis.cell(at - reach), last[q] = axis.cell(at + reach);
			continue;
		}
		if (2 * reach > axis.length) {
			std::ostringstream message;
			message << "a periodic box must be at least " << 2 * reach << " m long in "
					<< "xyz"[grid->axis[q]] << " for a member of a body with radius " << row.radius << " m, got " << axis.length
					<< " m; lengthen it";
			throw std::invalid_argument(message.str());
		}
		first[q] = static_cast<int>(std::floor((at - reach - axis.low) * axis.per_length));
		last[q] = std::min<int>(std::floor((at + reach - axis.low) * axis.per_length), first[q] + axis.cells - 1);
	}
	const auto within = [&](int q, int cell) {
		return (cell % grid->along[q].cells + grid->along[q].cells) % grid->along[q].cells;
	};
	for (int s = first[0]; s <= last[0]; ++s)
		for (int m = first[1]; m <= last[1]; ++m)
			for (int f = first[2]; f <= last[2]; ++f) {
				const std::uint32_t c = grid->index(within(0, s), within(1, m), within(2, f));
				for (std::uint32_t a = grid->start[c]; a < grid->start[c + 1]; ++a) {
					bool wrapped = false;
					if (near(a, member, wrapped)) with_members.push_back({ a, member, wrapped });
				}
			}
}

std::uint32_t SphereSearch::cell_at(std::uint32_t row) const
{
	return std::lower_bound(grid->start.begin(), grid->start.begin() + grid->cells(), row) - grid->start.begin();
}

/// Adds partners that lie behind `a` in memory, in neighbouring cells of another tile or across a periodic side.
void SphereSearch::beyond_tile(std::uint32_t a, const CellPlace& at, std::vector<Partner>& partners) const
{
	const int from[3] = { at.s, at.m, at.f };
	for (int step = 0; step < 27; ++step) {
		const int by[3] = { step / 9 - 1, step / 3 % 3 - 1, step % 3 - 1 };
		int to[3];
		bool wrapped = false, outside = false;
		for (int q = 0; q < 3; ++q) {
			const int cells = grid->along[q].cells;
			to[q] = from[q] + by[q];
			if (to[q] >= 0 && to[q] < cells) continue;
			if (!grid->along[q].periodic) outside = true;
			wrapped = true;
			to[q] = (to[q] + cells) % cells;
		}
		if (outside) continue;
		if (!wrapped && to[1] / grid->tile_m == from[1] / grid->tile_m && to[2] / grid->tile_f == from[2] / grid->tile_f)
			continue;
		const std::uint32_t c = grid->index(to[0], to[1], to[2]);
		for (std::uint32_t b = std::max(a + 1, grid->start[c]); b < grid->start[c + 1]; ++b) {
			bool by_image = false;
			if (near(a, b, by_image)) partners.push_back({ wrapped ? b | Partner::across : b });
		}
	}
}

void SphereSearch::find(const SphereKernel& kernel, std::uint32_t first_cell, std::uint32_t end_cell, std::uint32_t* count,
	std::vector<Partner>& partners) const
{
	const SphereGrid& g = *grid;
	const SearchColumns columns{ column[0].data(), column[1].data(), column[2].data(), column[3].data() };
	const std::vector<std::uint32_t>& start = g.start;
	std::vector<std::uint32_t> room;
	partners.clear();
	auto member = std::lower_bound(with_members.begin(), with_members.end(), start[first_cell],
		[](const MemberPair& pair, std::uint32_t row) { return pair.owner < row; });
	for (std::uint32_t c = first_cell; c < end_cell; ++c) {
		if (start[c] == start[c + 1]) continue;
		const CellPlace at = g.place(c);
		const int m_low = at.m / g.tile_m * g.tile_m, m_high = std::min(m_low + g.tile_m, g.along[1].cells) - 1;
		const int f_low = at.f / g.tile_f * g.tile_f, f_high = std::min(f_low + g.tile_f, g.along[2].cells) - 1;
		const int f0 = std::max(at.f - 1, f_low), f1 = std::min(at.f + 1, f_high);
		Run runs[4];
		int n_runs = 0;
		std::uint32_t most = start[g.index(at.s, at.m, f1) + 1] - start[c];
		const auto look_at = [&](int s, int m) {
			const Run run{ start[g.index(s, m, f0)], start[g.index(s, m, f1) + 1] };
			if (run.begin < run.end) runs[n_runs++] = run, most += run.end - run.begin;
		};
		if (at.m < m_high) look_at(at.s, at.m + 1);
		if (at.s + 1 < g.along[0].cells)
			for (int m = std::max(at.m - 1, m_low); m <= std::min(at.m + 1, m_high); ++m) look_at(at.s + 1, m);
		const std::uint32_t rest_end = start[g.index(at.s, at.m, f1) + 1];
		const bool at_side = at.m == m_low || at.m == m_high || at.f == f_low || at.f == f_high ||
		                     (g.along[0].periodic && (at.s == 0 || at.s + 1 == g.along[0].cells));
		room.resize(most + 2 * pack_room);
		for (std::uint32_t a = start[c]; a < start[c + 1]; ++a) {
			const float reach = float(state->rows[a].radius + state->skin) + rounding;
			int n = kernel.near(columns, a, a + 1, rest_end, reach, room.data());
			for (int r = 0; r < n_runs; ++r) n += kernel.near(columns, a, runs[r].begin, runs[r].end, reach, room.data() + n);
			const std::size_t before = partners.size();
			partners.resize(before + n);
			for (int k = 0; k < n; ++k) partners[before + k].bits = room[k];
			if (at_side) {
				beyond_tile(a, at, partners);
				if (partners.size() > before + n)
					std::sort(partners.begin() + before, partners.end(), [](Partner p, Partner q) { return p.row() < q.row(); });
			}
			for (; member != with_members.end() && member->owner == a; ++member)
				partners.push_back({ member->wrapped ? member->member | Partner::across : member->member });
			count[a] = partners.size() - before;
		}
	}
}

}  // namespace graindrive::loop
