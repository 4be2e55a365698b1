/// The V-cycle of multigrid.
#include "engines/continuum/pressure/multigrid.hpp"

#include "engines/continuum/pressure/coarsening.hpp"

namespace graindrive::continuum {
namespace {

// Gauss-Seidel on the cells of a row with one parity of x. Only neighbours of the given kinds are read; the others are 0.
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

// The residual of these cells: it was 0 after their relaxation, and neighbours of the given kinds, which were 0 then, have
// changed it.
template <int kinds>
void residual(const Links& a, const double* u, double* rest, int parity, int y)
{
	if (!has_row(a, y)) return;
	const Neighbours at(*a.grid, y, parity);
	const Span span = (*a.spans)[y];
	for (int k = span.first; k < span.last; k += lanes) pack(rest + at.here + k) = gather<kinds>(at, a, u, k);
}

// Where the right side of a coarse grid is computed.
struct CoarseSide {
	const Interpolation& p;
	PlainField& plain;  // room for rows in natural order
	const NinePoint& a;
	Field<double>& f;
};

// Computes a row of the coarse right side P^T rest. `rows`: rest may differ from 0 between the coarse cells of a row.
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

// u += P correction in a row, without the cells that are relaxed first, whose old value is not used.
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

// Each half of a cycle goes through the rows once. Every colour follows the one before it as closely as its neighbours allow, so
// that a row is still in the cache when the last colour is relaxed.

// From u = 0: relaxes forwards, and restricts the residual. With five points the cells with even x + y come first, then the
// others, whose residual is 0 afterwards.
void descend_five(const Links& a, const double* f, double* u, double* rest, CoarseSide to)
{
	for (int y = -1; y <= a.grid->ny + 1; ++y) {
		relax<none>(a, f, u, (y + 1) & 1, y + 1);
		relax<row | column>(a, f, u, ~y & 1, y);
		residual<row | column>(a, u, rest, (y - 1) & 1, y - 1);
		if (y % 2 == 0) restrict_row<false>(a, rest, to, y / 2 - 1);
	}
}

// Adds the correction, and relaxes backwards. Returns the scalar product of f and u.
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

// With nine points the order is: coarse cells, cells in the middle of four, cells between two of a row, cells between two of a
// column. The residual of the last is 0 afterwards.
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
		coarsen(a, to.p, to.a, to.rows, matrix.largest());
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

// Solves a coarse grid from `f`; the correction is left in `plain`.
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
