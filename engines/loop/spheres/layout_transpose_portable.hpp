/// Rows to columns and back on any processor, number by number.
#pragma once
#include "engines/loop/simd_pack.hpp"
#include "engines/loop/spheres/sphere_kernel.hpp"

namespace graindrive::loop {
namespace {

constexpr Processor compiled_for = Processor::portable;
constexpr int vector_bytes = 16;

template <class Row>
struct LayoutDifference {
	using Layout = RowLayout<Row>;
	const Row* rows;
	double length[Layout::axes], inverse_length[Layout::axes];

	LayoutDifference(const Row* first, const double* lengths, const double* inverse_lengths) : rows(first)
	{
		for (int axis = 0; axis < Layout::axes; ++axis)
			length[axis] = lengths[axis], inverse_length[axis] = inverse_lengths[axis];
	}

	double number(std::uint32_t offset, int column) const
	{
		return reinterpret_cast<const double*>(reinterpret_cast<const char*>(rows) + offset)[column];
	}

	template <bool Wrapped>
	double operator()(PairLink link, int column) const
	{
		const double first = number(link.first, column), second = number(link.second, column);
		const double d = Layout::sign[column] < 0 ? second - first : second + first;
		if (!Wrapped || column >= Layout::axes) return d;
		return d - length[column] * std::nearbyint(d * inverse_length[column]);
	}
};

template <class Row, class P>
struct LayoutTransposer {
	using Number = Pack<P, vector_bytes / sizeof(P)>;
	static constexpr int columns_written = RowLayout<Row>::first_force;

	template <bool Wrapped>
	static inline void columns(const LayoutDifference<Row>& difference, const PairLink* links, Number* out)
	{
		for (int column = 0; column < columns_written; ++column)
			for (int lane = 0; lane < Number::width; ++lane)
				out[column].v[lane] = P(difference.template operator()<Wrapped>(links[lane], column));
	}

	/// Calls put(k, line) with the numbers 0, 0, column[0] ... column[5] of pair k, in the order of pairs.
	template <class Put>
	static inline void lines(const Number column[6], const Put& put)
	{
		for (int lane = 0; lane < Number::width; ++lane) {
			ForceLine line{};
			for (int c = 0; c < 6; ++c) line.number[2 + c] = column[c].v[lane];
			put(lane, line);
		}
	}
};

/// Adds a pair's line to the second lines of both rows; the partner's force has the other sign.
struct LineAdder {
	SphereRow* rows;

	explicit LineAdder(SphereRow* first) : rows(first) {}

	SphereRow& at(std::uint32_t offset) const { return *reinterpret_cast<SphereRow*>(reinterpret_cast<char*>(rows) + offset); }
	void to_owner(std::uint32_t offset, const ForceLine& line) const
	{
		SphereRow& row = at(offset);
		for (int k = 0; k < 3; ++k) row.force[k] += line.number[2 + k], row.turn[k] += line.number[5 + k];
	}
	void to_partner(std::uint32_t offset, const ForceLine& line) const
	{
		SphereRow& row = at(offset);
		for (int k = 0; k < 3; ++k) row.force[k] -= line.number[2 + k], row.turn[k] += line.number[5 + k];
	}
	static const ForceLine& load(const ForceLine& line) { return line; }
	static void store(ForceLine& to, const ForceLine& line) { to = line; }
};

}  // namespace
}  // namespace graindrive::loop
