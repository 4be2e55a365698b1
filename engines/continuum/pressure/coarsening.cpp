/// Interpolation weights by Dendy (1982) and the Galerkin product, computed for eight coarse cells at once.
#include "engines/continuum/pressure/coarsening.hpp"

namespace graindrive::continuum {
namespace {

// part / whole, or 0 in closed cells, where whole is 0.
Lanes share(const Lanes& part, const Lanes& whole)
{
	const Lanes zero = {};
	return whole > zero ? part / whole : zero;
}

Lanes positive(const Lanes& a)
{
	const Lanes zero = {};
	return a > zero ? a : zero;
}

// Marks cells with non-zero weights to coarse cells, and counts the open cells that have none.
inline void mark(const Links& a, std::size_t place, const Lanes& whole, Interpolation& p)
{
	const Lanes zero = {}, one = zero + 1;
	const Lanes takes = whole > zero ? one : zero;
	pack(p.takes.data() + place) = takes;
	p.gaps += pack(a.inverse + place) > zero ? one - takes : zero;
}

// A cell between two coarse cells of a row: the weight of each is the sum of its links towards that side (three on a nine-point
// grid).
template <bool nine>
void interpolate_rows(const Links& a, Interpolation& p, int y)
{
	const Neighbours at(*a.grid, 2 * y, 1);
	const Span span = (*a.spans)[2 * y];
	for (int k = span.first; k < span.last; k += lanes) {
		Lanes west = pack(a.east + at.west + k), east = pack(a.east + at.here + k);
		if constexpr (nine) {
			west = positive(west + pack(a.north_west + at.here + k) + pack(a.north_east + at.south_west + k));
			east = positive(east + pack(a.north_east + at.here + k) + pack(a.north_west + at.south_east + k));
		}
		mark(a, at.here + k, west + east, p);
		pack(p.west.row(y) + k) = share(west, west + east);
		pack(p.east.row(y) + k) = share(east, west + east);
	}
}

template <bool nine>
void interpolate_columns(const Links& a, Interpolation& p, int y)
{
	const Neighbours at(*a.grid, 2 * y + 1, 0);
	const Span span = span_or_none(a, 2 * y + 1);
	for (int k = span.first; k < span.last; k += lanes) {
		Lanes south = pack(a.north + at.south + k), north = pack(a.north + at.here + k);
		if constexpr (nine) {
			south = positive(south + pack(a.north_east + at.south_west + k) + pack(a.north_west + at.south_east + k));
			north = positive(north + pack(a.north_east + at.here + k) + pack(a.north_west + at.here + k));
		}
		mark(a, at.here + k, south + north, p);
		pack(p.south.row(y) + k) = share(south, south + north);
		pack(p.north.row(y) + k) = share(north, south + north);
	}
}

// A cell in the middle of four coarse cells: it is interpolated from all its neighbours, and the neighbours that lie between
// coarse cells are in turn replaced by their own interpolation.
template <bool nine>
void interpolate_middles(const Links& a, Interpolation& p, int y)
{
	const Neighbours at(*a.grid, 2 * y + 1, 1);
	const Span span = span_or_none(a, 2 * y + 1);
	for (int k = span.first; k < span.last; k += lanes) {
		const Lanes west = pack(a.east + at.west + k), east = pack(a.east + at.here + k), south = pack(a.north + at.south + k),
					north = pack(a.north + at.here + k);
		Lanes sw = west * pack(p.south.row(y) + k) + south * pack(p.west.row(y) + k),
			  se = east * pack(p.south.row(y) + k + 1) + south * pack(p.east.row(y) + k),
			  nw = west * pack(p.north.row(y) + k) + north * pack(p.west.row(y + 1) + k),
			  ne = east * pack(p.north.row(y) + k + 1) + north * pack(p.east.row(y + 1) + k);
		if constexpr (nine) {
			sw = positive(sw + pack(a.north_east + at.south_west + k));
			se = positive(se + pack(a.north_west + at.south_east + k));
			nw = positive(nw + pack(a.north_west + at.here + k));
			ne = positive(ne + pack(a.north_east + at.here + k));
		}
		const Lanes whole = (sw + se) + (nw + ne);
		mark(a, at.here + k, whole, p);
		pack(p.south_west.row(y) + k) = share(sw, whole);
		pack(p.south_east.row(y) + k) = share(se, whole);
		pack(p.north_west.row(y) + k) = share(nw, whole);
		pack(p.north_east.row(y) + k) = share(ne, whole);
	}
}

template <bool nine>
void interpolate(const Links& a, Interpolation& p, int coarse_ny)
{
	p.gaps = Lanes{};
	for (int y = 0; y < coarse_ny; ++y) interpolate_rows<nine>(a, p, y);
	for (int y = 0; y < coarse_ny; ++y) {
		interpolate_columns<nine>(a, p, y);
		interpolate_middles<nine>(a, p, y);
	}
}

// Fine cells around eight coarse cells in a row; (dx, dy) counts fine cells from the coarse cells (k, y).
struct Around {
	const Links& a;
	const Interpolation& p;
	int y, k;

	static int parity(int dx) { return dx & 1; }
	static int shift(int dx) { return (dx - (dx & 1)) / 2; }
	std::size_t place(int dx, int dy) const { return a.grid->offset(2 * y + dy, parity(dx)) + k + shift(dx); }

	// The link between (dx, dy) and (dx + ax, dy + ay).
	Lanes link(int dx, int dy, int ax, int ay) const
	{
		if (ay < 0 || (ay == 0 && ax < 0)) return link(dx + ax, dy + ay, -ax, -ay);
		const double* links = ay == 0 ? a.east : ax == 0 ? a.north : ax > 0 ? a.north_east : a.north_west;
		return pack(links + place(dx, dy));
	}

	Lanes takes(int dx, int dy) const { return pack(p.takes.data() + place(dx, dy)); }

	// The weight of the coarse cell (k, y) + (cx, cy) in the fine cell (dx, dy).
	Lanes weight(int dx, int dy, int cx, int cy) const
	{
		const Lanes zero = {};
		dx -= 2 * cx, dy -= 2 * cy;
		if (dx < -1 || dx > 1 || dy < -1 || dy > 1) return zero;
		if (dx == 0 && dy == 0) return zero + 1;
		const PlainField& of = dy == 0   ? (dx > 0 ? p.west : p.east)
		                       : dx == 0 ? (dy > 0 ? p.south : p.north)
		                       : dy > 0  ? (dx > 0 ? p.south_west : p.south_east)
		                                 : (dx > 0 ? p.north_west : p.north_east);
		return pack(of.row(y + cy + (dy < 0 ? -1 : 0)) + k + cx + (dx < 0 ? -1 : 0));
	}
};

// A times the column of P that belongs to the coarse cells, at (dx, dy). With `gaps` (some open cells have no weights) links to
// such cells are left out, because the coarse diagonal, which is the sum of the links, would be too small with them, and the
// matrix indefinite.
template <bool nine, bool gaps>
inline __attribute__((always_inline)) Lanes product_at(const Around& cells, int dx, int dy)
{
	const Lanes here = cells.weight(dx, dy, 0, 0);
	Lanes sum = {};
#pragma GCC unroll 3
	for (int ay = -1; ay <= 1; ++ay)
#pragma GCC unroll 3
		for (int ax = -1; ax <= 1; ++ax) {
			if ((ax == 0 && ay == 0) || (!nine && ax != 0 && ay != 0)) continue;
			const int ex = dx + ax, ey = dy + ay;
			const bool both_outside = (dx < -1 || dx > 1 || dy < -1 || dy > 1) && (ex < -1 || ex > 1 || ey < -1 || ey > 1);
			if (both_outside) continue;
			const Lanes there = cells.weight(ex, ey, 0, 0);
			if constexpr (gaps)
				sum += cells.link(dx, dy, ax, ay) * (here * cells.takes(ex, ey) - there * cells.takes(dx, dy));
			else
				sum += cells.link(dx, dy, ax, ay) * (here - there);
		}
	return sum;
}

// The links of the coarse cells to the east, north, north-east and north-west: -(column of P of the neighbour)^T A (column of P).
template <bool nine, bool gaps>
inline __attribute__((always_inline)) void coarse_links(
	const Around& cells, Lanes& east, Lanes& north, Lanes& north_east, Lanes& north_west)
{
	const Lanes zero = {};
	east = north = north_east = north_west = zero;
#pragma GCC unroll 4
	for (int dy = -1; dy <= 2; ++dy)
#pragma GCC unroll 5
		for (int dx = -2; dx <= 2; ++dx) {
			if (dy < 1 && dx < 1) continue;
			const Lanes product = product_at<nine, gaps>(cells, dx, dy);
			if (dx > 0 && dy < 2) east -= cells.weight(dx, dy, 1, 0) * product;
			if (dx > -2 && dx < 2 && dy > 0) north -= cells.weight(dx, dy, 0, 1) * product;
			if (dx > 0 && dy > 0) north_east -= cells.weight(dx, dy, 1, 1) * product;
			if (dx < 0 && dy > 0) north_west -= cells.weight(dx, dy, -1, 1) * product;
		}
}

// `closed`: the value used as inverse diagonal of a closed cell.
template <bool nine, bool gaps>
void link_coarse(const Links& a, const Interpolation& p, NinePoint& coarse, PlainField& rows, double closed)
{
	Field<double>* const fields[] = { &coarse.east, &coarse.north, &coarse.north_east, &coarse.north_west,
		&coarse.inverse_diagonal };
	for (int y = 0; y < coarse.grid.ny; ++y) {
		const Span span = (*a.spans)[2 * y], coarse_span = coarse.spans[y];
		const double* inverse = a.inverse + a.grid->offset(2 * y, 0);
		for (int k = span.first; k < span.last; k += lanes) {
			Lanes link[4];
			coarse_links<nine, gaps>({ a, p, y, k }, link[0], link[1], link[2], link[3]);
			for (int n = 0; n < 4; ++n) pack(rows.row(n) + k) = link[n];
			const Lanes own = pack(inverse + k), zero = {};
			pack(rows.row(4) + k) = own > zero ? own : zero + closed;  // it may represent open neighbours
		}
		for (int n = 0; n < 5; ++n) {
			std::fill(rows.row(n) + 2 * coarse_span.first, rows.row(n) + span.first, 0);
			std::fill(rows.row(n) + span.last, rows.row(n) + 2 * coarse_span.last, 0);
			split_span(rows.row(n), coarse_span, fields[n]->row(y, 0), fields[n]->row(y, 1));
		}
	}
}

template <bool nine>
void interpolate_and_link(const Links& a, Interpolation& p, NinePoint& coarse, PlainField& rows, double closed)
{
	interpolate<nine>(a, p, coarse.grid.ny);
	if (sum_of<double>(p.gaps) > 0)
		link_coarse<nine, true>(a, p, coarse, rows, closed);
	else
		link_coarse<nine, false>(a, p, coarse, rows, closed);
}

// Below this ratio to the finer diagonal a coarse diagonal is round-off: the cell has no links, because it represents a whole
// connected part.
constexpr double least_coarse_diagonal = 1e-13;

void invert_diagonal(NinePoint& a)
{
	const Lanes zero = {}, one = zero + 1;
	const Links links = links_of(a);
	for (int y = 0; y < a.grid.ny; ++y)
		for (int parity = 0; parity < 2; ++parity) {
			const Neighbours at(a.grid, y, parity);
			for (int k = a.spans[y].first; k < a.spans[y].last; k += lanes) {
				const std::size_t i = at.here + k;
				const Lanes diagonal = (pack(links.east + i) + pack(links.east + at.west + k)) +
				                       (pack(links.north + i) + pack(links.north + at.south + k)) +
				                       ((pack(links.north_east + i) + pack(links.north_east + at.south_west + k)) +
										   (pack(links.north_west + i) + pack(links.north_west + at.south_east + k)));
				Lanes& inverse = pack(a.inverse_diagonal.data() + i);
				inverse = diagonal * inverse > zero + least_coarse_diagonal ? one / diagonal : zero;
			}
		}
}

}  // namespace

void coarsen(const Links& a, Interpolation& p, NinePoint& coarse, PlainField& rows, double largest)
{
	if (a.north_east)
		interpolate_and_link<true>(a, p, coarse, rows, 1 / largest);
	else
		interpolate_and_link<false>(a, p, coarse, rows, 1 / largest);
	invert_diagonal(coarse);
}

}  // namespace graindrive::continuum
