/// Rows to columns and back on any processor, number by number.
#pragma once
#include "engines/loop/disks/row_at.hpp"

namespace graindrive::loop {
namespace {

constexpr Processor compiled_for = Processor::portable;
constexpr int vector_bytes = 16;

struct RowDifference {
	const DiskRow* rows;
	double length[2], inverse_length[2], image[4];

	explicit RowDifference(const DiskStep& data)
		: rows(data.rows),
		  length{ data.length[0], data.length[1] },
		  inverse_length{ data.inverse_length[0], data.inverse_length[1] },
		  image{ data.image[0], data.image[1], data.image[2], data.image[3] }
	{
	}

	template <bool Wrapped>
	double operator()(PairLink link, int column) const
	{
		const double first = row_at(rows, link.first)[column], second = row_at(rows, link.second)[column];
		if (column >= 4) return second + first;
		double d = second - first;
		if (!Wrapped) return d;
		d -= periods(row_at(rows, link.second)[1] - row_at(rows, link.first)[1], 1) * image[column];
		return column >= 2 ? d : d - length[column] * periods(d, column);
	}

private:
	double periods(double d, int axis) const { return std::nearbyint(d * inverse_length[axis]); }
};

template <class P>
struct Transposer {
	using Number = Pack<P, vector_bytes / sizeof(P)>;

	template <bool Wrapped>
	static void columns(const RowDifference& difference, const PairLink* links, Number out[6])
	{
		for (int column = 0; column < 6; ++column)
			for (int lane = 0; lane < Number::width; ++lane)
				out[column].v[lane] = P(difference.template operator()<Wrapped>(links[lane], column));
	}

	static void store(const Number& x, const Number& y, const Number& friction, const Number& normal, PairForce<P>* to)
	{
		for (int lane = 0; lane < Number::width; ++lane) to[lane] = { x.v[lane], y.v[lane], friction.v[lane], normal.v[lane] };
	}
};

}  // namespace
}  // namespace graindrive::loop
