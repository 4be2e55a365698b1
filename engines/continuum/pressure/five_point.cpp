/// Loads the matrix, and multiplies it with vectors.
#include "engines/continuum/pressure/five_point.hpp"

namespace graindrive::continuum {

bool FivePoint::update(const FaceCoefficients& b)
{
	largest_link = checked_largest(b);
	const double least = closed_below * largest_link;
	const bool new_shape = connected.update(b, least);
	if (new_shape) {
		shape.nx = b.nx, shape.ny = b.ny;
		east = north = inverse_diagonal = Field<double>(shape);
		row.resize(b.nx);
	}
	width = b.spacing;
	load(b, least);
	invert_diagonal();
	return new_shape;
}

void FivePoint::load(const FaceCoefficients& b, double least)
{
	const int nx = shape.nx;
	const auto keep = [&](const double* from, Field<double>& links, int y) {
		for (int i = 0; i < nx; ++i) row[i] = from[i] > least ? from[i] : 0;
		split_row(row.data(), nx, links.row(y, 0), links.row(y, 1));
	};
	for (int y = 0; y < shape.ny; ++y) {
		if (spans()[y].first == spans()[y].last) continue;
		keep(&b.x[std::size_t(nx + 1) * y + 1], east, y);
		keep(&b.y[std::size_t(nx) * (y + 1)], north, y);
	}
}

void FivePoint::invert_diagonal()
{
	const Pack<double> zero = {}, one = zero + 1;
	const double *e = east.data(), *n = north.data();
	for (int y = 0; y < shape.ny; ++y)
		for (int parity = 0; parity < 2; ++parity) {
			const NeighbourRows at(shape, y, parity);
			for (int k = spans()[y].first; k < spans()[y].last; k += lanes) {
				const Pack<double> diagonal =
					(pack(e + at.here + k) + pack(e + at.west + k)) + (pack(n + at.here + k) + pack(n + at.south + k));
				pack(inverse_diagonal.data() + at.here + k) = diagonal > zero ? one / diagonal : zero;
			}
		}
}

namespace {

// Calls work(place, value of A u at that place) for the packs of a row.
template <class Work>
void for_products(const FivePoint& a, const Field<double>& field, int y, Work&& work)
{
	const double *e = a.east.data(), *n = a.north.data(), *u = field.data();
	for (int parity = 0; parity < 2; ++parity) {
		const NeighbourRows at(a.grid(), y, parity);
		for (int k = a.spans()[y].first; k < a.spans()[y].last; k += lanes) {
			const Pack<double> here = pack(u + at.here + k);
			work(at.here + k, (pack(e + at.here + k) * (here - pack(u + at.east + k)) +
								  pack(e + at.west + k) * (here - pack(u + at.west + k))) +
								  (pack(n + at.here + k) * (here - pack(u + at.north + k)) +
									  pack(n + at.south + k) * (here - pack(u + at.south + k))));
		}
	}
}

}  // namespace

double FivePoint::multiply(const Field<double>& u, Field<double>& product) const
{
	Pack<double> sum = {};
	for (int y = 0; y < shape.ny; ++y) multiply_row(u, product, y, sum);
	return sum_of<double>(sum);
}

double FivePoint::turn_and_multiply(const Field<double>& z, double share, Field<double>& u, Field<double>& product) const
{
	Pack<double> sum = {};
	for (int y = 0; y <= shape.ny; ++y) {  // the product of a row needs the new direction in the row above
		if (y < shape.ny)
			for_row(
				shape, spans(), y, [&](std::size_t i) { pack(u.data() + i) = pack(z.data() + i) + share * pack(u.data() + i); });
		if (y > 0) multiply_row(u, product, y - 1, sum);
	}
	return sum_of<double>(sum);
}

void FivePoint::multiply_row(const Field<double>& u, Field<double>& product, int y, Pack<double>& sum) const
{
	Pack<double> more = {};
	for_products(*this, u, y, [&](std::size_t i, const Pack<double>& value) {
		pack(product.data() + i) = value;
		more += value * pack(u.data() + i);
	});
	sum += more;
}

double FivePoint::residual(const Field<double>& f, const Field<double>& u, Field<double>& r) const
{
	Pack<double> sum = {};
	for (int y = 0; y < shape.ny; ++y)
		for_products(*this, u, y, [&](std::size_t i, const Pack<double>& value) {
			const Pack<double> rest = pack(f.data() + i) - value;
			pack(r.data() + i) = rest;
			sum += rest * rest;
		});
	return sum_of<double>(sum);
}

}  // namespace graindrive::continuum
