/// Coarsening and the cycle.
#include "engines/continuum/multigrid.hpp"

namespace graindrive::continuum {
namespace {

using Lanes = Pack<double>;

// What a kernel reads of an operator; the finest has no diagonal links.
struct Links {
	const SplitGrid* grid;
	const std::vector<Span>* spans;
	const double *east, *north, *north_east, *north_west, *inverse;
};

Links links_of(const FivePoint& a)
{
	return { &a.grid(), &a.spans(), a.east.data(), a.north.data(), nullptr, nullptr, a.inverse_diagonal.data() };
}
Links links_of(const NinePoint& a)
{
	return { &a.grid, &a.spans, a.east.data(), a.north.data(), a.north_east.data(), a.north_west.data(),
		a.inverse_diagonal.data() };
}

// Sums of link times neighbour, by kind of neighbour.
struct Neighbours : NeighbourRows {
	std::size_t north_west, north_east, south_west, south_east;
	Neighbours(const SplitGrid& grid, int y, int parity)
		: NeighbourRows(grid, y, parity),
		  north_west(grid.offset(y + 1, 1 - parity) + parity - 1),
		  north_east(north_west + 1),
		  south_west(grid.offset(y - 1, 1 - parity) + parity - 1),
		  south_east(south_west + 1)
	{
	}
	Lanes of_row(const Links& a, const double* u, int k) const
	{
		return pack(a.east + here + k) * pack(u + east + k) + pack(a.east + west + k) * pack(u + west + k);
	}
	Lanes of_column(const Links& a, const double* u, int k) const
	{
		return pack(a.north + here + k) * pack(u + north + k) + pack(a.north + south + k) * pack(u + south + k);
	}
	Lanes of_diagonals(const Links& a, const double* u, int k) const
	{
		return (pack(a.north_east + here + k) * pack(u + north_east + k) +
				   pack(a.north_east + south_west + k) * pack(u + south_west + k)) +
		       (pack(a.north_west + here + k) * pack(u + north_west + k) +
				   pack(a.north_west + south_east + k) * pack(u + south_east + k));
	}
};

enum Kinds { none = 0, row = 1, column = 2, diagonals = 4, all = 7 };

template <int kinds>
Lanes gather(const Neighbours& at, const Links& a, const double* u, int k)
{
	Lanes sum = {};
	if constexpr (kinds & row) sum += at.of_row(a, u, k);
	if constexpr (kinds & column) sum += at.of_column(a, u, k);
	if constexpr (kinds & diagonals) sum += at.of_diagonals(a, u, k);
	return sum;
}

bool has_row(const Links& a, int y) { return y >= 0 && y < a.grid->ny; }

Span span_or_none(const Links& a, int y) { return has_row(a, y) ? (*a.spans)[y] : Span{}; }

// Gauss-Seidel on the cells of a row with one parity of x; neighbours of other kinds are known to be 0.
template <int kinds>
void relax(const Links& a, const double* f, double* u, int parity, int y)
{
	if (!has_row(a, y)) return;
	const Neighbours at(*a.grid, y, parity);
	const Span span = (*a.spans)[y];
	for (int k = span.first; k < span.last; k += lanes) {
		const std::size_t i = at.here + k;
		pack(u + i) = (pack(f + i) + gather<kinds>(at, a, u, k)) * pack(a.inverse + i);
	}
}

// What has changed the residual of these cells since they were relaxed: their neighbours of some kinds, which were 0 then.
template <int kinds>
void residual(const Links& a, const double* u, double* rest, int parity, int y)
{
	if (!has_row(a, y)) return;
	const Neighbours at(*a.grid, y, parity);
	const Span span = (*a.spans)[y];
	for (int k = span.first; k < span.last; k += lanes) pack(rest + at.here + k) = gather<kinds>(at, a, u, k);
}

// The right side of a coarse grid.
struct CoarseSide {
	const Interpolation& p;
	PlainField& plain;  // room for rows in natural order
	const NinePoint& a;
	Field<double>& f;
};

// A row of the coarse right side P^T rest. `rows`: rest is not 0 between the coarse cells of a row.
template <bool rows>
void restrict_row(const Links& a, const double* rest, CoarseSide& to, int y)
{
	if (y < 0 || y >= to.a.grid.ny) return;
	const Interpolation& p = to.p;
	const double *here = rest + a.grid->offset(2 * y, 0), *beside = rest + a.grid->offset(2 * y, 1),
				 *above = rest + a.grid->offset(2 * y + 1, 1), *below = rest + a.grid->offset(2 * y - 1, 1);
	const double *west = p.west.row(y), *east = p.east.row(y), *south_west = p.south_west.row(y),
				 *south_east = p.south_east.row(y), *north_west = p.north_west.row(y - 1), *north_east = p.north_east.row(y - 1);
	double* sums = to.plain.row(y);
	for (int k = (*a.spans)[2 * y].first; k < (*a.spans)[2 * y].last; k += lanes) {
		Lanes sum =
			pack(here + k) + ((pack(south_west + k) * pack(above + k) + pack(south_east + k - 1) * pack(above + k - 1)) +
								 (pack(north_west + k) * pack(below + k) + pack(north_east + k - 1) * pack(below + k - 1)));
		if constexpr (rows) sum += pack(west + k) * pack(beside + k) + pack(east + k - 1) * pack(beside + k - 1);
		pack(sums + k) = sum;
	}
	split_span(sums, to.a.spans[y], to.f.row(y, 0), to.f.row(y, 1));
}

// u += P correction in a row, but for the cells that the sweep relaxes first.
template <bool rows>
void correct(const Links& a, const Interpolation& p, const PlainField& correction, double* u, int y)
{
	if (!has_row(a, y)) return;
	const Span span = (*a.spans)[y];
	const int coarse = y / 2;
	const double* c = correction.row(coarse);
	if (y % 2 == 0) {
		double *here = u + a.grid->offset(y, 0), *beside = u + a.grid->offset(y, 1);
		for (int k = span.first; k < span.last; k += lanes) {
			pack(here + k) += pack(c + k);
			if constexpr (rows)
				pack(beside + k) += pack(p.west.row(coarse) + k) * pack(c + k) + pack(p.east.row(coarse) + k) * pack(c + k + 1);
		}
		return;
	}
	const double *above = correction.row(coarse + 1), *south_west = p.south_west.row(coarse),
				 *south_east = p.south_east.row(coarse), *north_west = p.north_west.row(coarse),
				 *north_east = p.north_east.row(coarse);
	double* middle = u + a.grid->offset(y, 1);
	for (int k = span.first; k < span.last; k += lanes)
		pack(middle + k) += (pack(south_west + k) * pack(c + k) + pack(south_east + k) * pack(c + k + 1)) +
		                    (pack(north_west + k) * pack(above + k) + pack(north_east + k) * pack(above + k + 1));
}

// Half a cycle goes through the rows once: each colour follows the one before it as closely as its neighbours allow, so that a row is
// still in the cache when the last of them needs it.

// From u = 0: relaxes forwards, and restricts what is left. On five points cells with even x + y come first, then the others, whose
// residual is then 0.
void descend_five(const Links& a, const double* f, double* u, double* rest, CoarseSide to)
{
	for (int y = -1; y <= a.grid->ny + 1; ++y) {
		relax<none>(a, f, u, (y + 1) & 1, y + 1);
		relax<row | column>(a, f, u, ~y & 1, y);
		residual<row | column>(a, u, rest, (y - 1) & 1, y - 1);
		if (y % 2 == 0) restrict_row<false>(a, rest, to, y / 2 - 1);
	}
}

// Corrects, and relaxes backwards. Returns f u.
double ascend_five(const Links& a, const double* f, double* u, const Interpolation& p, const PlainField& correction)
{
	Lanes product = {};
	for (int y = -1; y <= a.grid->ny; ++y) {
		correct<false>(a, p, correction, u, y + 1);
		relax<row | column>(a, f, u, ~y & 1, y);
		relax<row | column>(a, f, u, (y - 1) & 1, y - 1);
		const Span span = span_or_none(a, y - 1);
		for (int parity = 0; parity < 2; ++parity) {
			const std::size_t i = a.grid->offset(y - 1, parity);
			for (int k = span.first; k < span.last; k += lanes) product += pack(f + i + k) * pack(u + i + k);
		}
	}
	return sum_of<double>(product);
}

// On nine points: coarse cells, middles of four, cells between two of a row, between two of a column, whose residual is then 0.
void descend_nine(const Links& a, const double* f, double* u, double* rest, CoarseSide* to)
{
	for (int y = 0; y <= a.grid->ny + 6; y += 2) {
		relax<none>(a, f, u, 0, y);
		relax<diagonals>(a, f, u, 1, y - 1);
		relax<row | column>(a, f, u, 1, y - 2);
		relax<all>(a, f, u, 0, y - 3);
		if (!to) continue;
		residual<all>(a, u, rest, 0, y - 4);
		residual<diagonals>(a, u, rest, 1, y - 4);
		residual<row | column>(a, u, rest, 1, y - 5);
		restrict_row<true>(a, rest, *to, y / 2 - 3);
	}
}

void ascend_nine(const Links& a, const double* f, double* u, const Interpolation* p, const PlainField* correction)
{
	for (int y = 0; y <= a.grid->ny + 4; y += 2) {
		for (const int corrected : { y - 1, y })
			if (p) correct<true>(a, *p, *correction, u, corrected);
		relax<all>(a, f, u, 0, y - 1);
		relax<all>(a, f, u, 1, y - 2);
		relax<all>(a, f, u, 1, y - 3);
		relax<all>(a, f, u, 0, y - 4);
	}
}

// a/(a + b), 0 where both are closed.
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

// Marks which cells take anything of coarse cells, and counts the open cells that do not.
inline void mark(const Links& a, std::size_t place, const Lanes& whole, Interpolation& p)
{
	const Lanes zero = {}, one = zero + 1;
	const Lanes takes = whole > zero ? one : zero;
	pack(p.takes.data() + place) = takes;
	p.gaps += pack(a.inverse + place) > zero ? one - takes : zero;
}

// Between two coarse cells each counts by its links (of three kinds on a nine-point grid) towards the cell in between.
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

// In the middle: from all neighbours, those between coarse cells replaced by what they take.
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

	// What (dx, dy) takes of the coarse cell (k, y) + (cx, cy).
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

// A times the column of P that belongs to the coarse cells, at (dx, dy). Links to cells that take nothing of coarse cells are left out
// (`gaps`: there are such cells): they would leave the coarse matrix with too small a diagonal, and so indefinite.
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

// `closed`: what counts as the inverse diagonal of a closed cell.
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
			pack(rows.row(4) + k) = own > zero ? own : zero + closed;  // a closed cell may stand for open ones beside it
		}
		for (int n = 0; n < 5; ++n) {
			std::fill(rows.row(n) + 2 * coarse_span.first, rows.row(n) + span.first, 0);
			std::fill(rows.row(n) + span.last, rows.row(n) + 2 * coarse_span.last, 0);
			split_span(rows.row(n), coarse_span, fields[n]->row(y, 0), fields[n]->row(y, 1));
		}
	}
}

template <bool nine>
void coarsen(const Links& a, Interpolation& p, NinePoint& coarse, PlainField& rows, double closed)
{
	interpolate<nine>(a, p, coarse.grid.ny);
	if (sum_of<double>(p.gaps) > 0)
		link_coarse<nine, true>(a, p, coarse, rows, closed);
	else
		link_coarse<nine, false>(a, p, coarse, rows, closed);
}

// A coarse cell is linked to nothing if its diagonal is rounding beside the finer diagonal: then a part has shrunk to that cell.
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

void Multigrid::Coarse::reshape(const SplitGrid& finer, const std::vector<Span>& finer_spans)
{
	a.grid.nx = (finer.nx + 1) / 2, a.grid.ny = (finer.ny + 1) / 2;
	const int nx = a.grid.nx, ny = a.grid.ny;
	a.spans.resize(ny);
	for (int y = 0; y < ny; ++y)
		a.spans[y] = { rounded_down(finer_spans[2 * y].first / 2), rounded_up((finer_spans[2 * y].last + 1) / 2) };
	for (Field<double>* field : { &a.east, &a.north, &a.north_east, &a.north_west, &a.inverse_diagonal, &f, &u, &rest })
		*field = Field<double>(a.grid);
	for (PlainField* field :
		{ &p.west, &p.east, &p.south, &p.north, &p.south_west, &p.south_east, &p.north_west, &p.north_east, &plain })
		*field = PlainField(nx, ny);
	rows = PlainField(nx, 5);
	p.takes = Field<double>(finer);
	for (int y = 0; y < finer.ny; y += 2) std::fill_n(p.takes.row(y, 0), nx, 1);
}

void Multigrid::update(const FivePoint& matrix, bool new_shape)
{
	finest = &matrix;
	if (new_shape) {
		coarse.clear();
		rest = Field<double>(matrix.grid());
		const SplitGrid* finer = &matrix.grid();
		const std::vector<Span>* spans = &matrix.spans();
		while (finer->nx > 1 || finer->ny > 1) {
			coarse.push_back(std::make_unique<Coarse>());
			coarse.back()->reshape(*finer, *spans);
			finer = &coarse.back()->a.grid, spans = &coarse.back()->a.spans;
		}
	}
	for (std::size_t level = 0; level < coarse.size(); ++level) {
		Coarse& to = *coarse[level];
		const Links a = level == 0 ? links_of(matrix) : links_of(coarse[level - 1]->a);
		if (level == 0)
			coarsen<false>(a, to.p, to.a, to.rows, 1 / matrix.largest());
		else
			coarsen<true>(a, to.p, to.a, to.rows, 1 / matrix.largest());
		invert_diagonal(to.a);
	}
}

double Multigrid::apply(const Field<double>& r, Field<double>& z)
{
	const Links a = links_of(*finest);
	if (coarse.empty()) {  // a single cell
		z.clear();
		return 0;
	}
	Coarse& next = *coarse.front();
	descend_five(a, r.data(), z.data(), rest.data(), { next.p, next.plain, next.a, next.f });
	solve_coarse(0);
	return ascend_five(a, r.data(), z.data(), next.p, next.plain);
}

// From f to the correction in `plain`.
void Multigrid::solve_coarse(std::size_t level)
{
	Coarse& here = *coarse[level];
	const Links a = links_of(here.a);
	if (level + 1 < coarse.size()) {
		Coarse& next = *coarse[level + 1];
		CoarseSide to{ next.p, next.plain, next.a, next.f };
		descend_nine(a, here.f.data(), here.u.data(), here.rest.data(), &to);
		solve_coarse(level + 1);
		ascend_nine(a, here.f.data(), here.u.data(), &next.p, &next.plain);
	} else {
		descend_nine(a, here.f.data(), here.u.data(), here.rest.data(), nullptr);
		ascend_nine(a, here.f.data(), here.u.data(), nullptr, nullptr);
	}
	for (int y = 0; y < here.a.grid.ny; ++y) merge_span(here.u.row(y, 0), here.u.row(y, 1), here.a.spans[y], here.plain.row(y));
}

std::unique_ptr<Preconditioner> make_multigrid_preconditioner() { return std::make_unique<Multigrid>(); }

}  // namespace graindrive::continuum
