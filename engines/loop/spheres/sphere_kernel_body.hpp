/// The inner functions of the loop over spheres: forces of packs of pairs, and the motion of blocks of free spheres (leapfrog).
///
///   v_{n+1/2} = v_{n-1/2} + (F_n / m + g) dt,   x_{n+1} = x_n + v_{n+1/2} dt,   (R w)_{n+1/2} = (R w)_{n-1/2} + (R^2 / I) sum (n x F_t) dt
///
/// A sweep runs through the free spheres in memory order. A pair is owned by its lower row, so once the pairs owned up to row i are
/// computed nothing will ask for row i's old position again, and it can move at once, while it is still in the nearest cache.
#pragma once
#include <algorithm>
#include <emmintrin.h>

#include "engines/loop/spheres/contact_pack.hpp"
#include "engines/loop/spheres/layout_transpose.hpp"
#include "engines/loop/spheres/near_body.hpp"

namespace graindrive::loop {
namespace {

template <class Law, class P, bool Friction>
struct SphereBody {
	using Turn = LayoutTransposer<SphereRow, P>;
	using Difference = LayoutDifference<SphereRow>;
	using S = typename Turn::Number;
	using Group = PairGroup<P>;

	static void early(const SphereStep& step, const SphereShare& share) { run(step, share, false); }
	static bool sweep(const SphereStep& step, const SphereShare& share) { return run(step, share, true); }

private:
	typedef double Four __attribute__((vector_size(32)));
	static constexpr std::uint32_t packs_at_once = 12;
	static constexpr std::uint32_t rows_ahead = 96, groups_ahead = 48;  // prefetched, in pairs

	/// Number by number: from a copy as a whole the compiler fuses other products, and results would differ in the last bit.
	static inline Law law_of(const SphereStep& step)
	{
		Law law{};
		const Law& given = *static_cast<const Law*>(step.law);
		Law::constants([&](const laws::Quantity&, auto constant) { law.*constant = given.*constant; });
		return law;
	}

	/// Early pairs and sweeps share one copy of the machine code: in another the compiler may fuse another product of a sum, and a pair
	/// would be rounded by where it is computed, that is by the number of threads.
	__attribute__((flatten, noipa)) static bool run(const SphereStep& step, const SphereShare& share, bool moving)
	{
		const Law law = law_of(step);
		const Difference difference(step.rows, step.length, step.inverse_length);
		const LineAdder adder(step.rows);
		const std::uint32_t blocks = moving ? share.block_end - share.block_begin : 1;
		bool beyond = false;
		std::uint32_t at = moving ? 0 : share.early_begin, early_added = 0;
		for (std::uint32_t b = 0; b < blocks; ++b) {
			const std::uint32_t done = moving ? share.block_pair_end[b] : share.early_end;
			while (at < done) at = packs(difference, adder, step, share, law, at, done, moving);
			if (!moving) break;
			for (; early_added < share.block_early_end[b]; ++early_added)
				adder.to_owner(share.early_links[early_added].first, LineAdder::load(share.early_forces[early_added]));
			const std::uint32_t block = share.block_begin + b;
			step.travelled[block] += move_block(step, block);
			beyond |= step.travelled[block] > step.allowed[block];
		}
		return beyond;
	}

	/// Forces of the pairs from `at` on, in two stages: the roots and divisions of many packs overlap, the law waits for them no more.
	/// @return where the next pack begins
	static inline std::uint32_t packs(const Difference& difference, const LineAdder& adder, const SphereStep& step,
		const SphereShare& share, const Law& law, std::uint32_t at, std::uint32_t end, bool moving)
	{
		Group* groups = static_cast<Group*>(share.groups);
		ContactPack<S> touching[packs_at_once];
		std::uint32_t n = 0;
		for (std::uint32_t k = 0; k < packs_at_once && at < end; ++k, at += S::width) {
			Group& group = groups[at / Group::size];
			const std::uint32_t lane = at % Group::size;
			prefetch_rows(step.rows, groups, at + rows_ahead);
			if (lane == 0) prefetch_group(groups[(at + groups_ahead) / Group::size]);
			S column[Turn::columns_written];
			bool wrapped = share.wrapped[at / Group::size];
			asm volatile("" : "+r"(wrapped));  // or the compiler makes a loop for either, with a copy of the law in each
			if (__builtin_expect(wrapped, false))
				Turn::template columns<true>(difference, group.links + lane, column);
			else
				Turn::template columns<false>(difference, group.links + lane, column);
			touching[n].at = at;
			if (contact_pack<Law, Friction>(column, touching[n])) {
				++n;
			} else {
				store_springs(group, lane, { S(0), S(0), S(0) });
				if (!moving) std::fill_n(share.early_forces + (at - share.early_begin), S::width, ForceLine{});
			}
		}
		for (std::uint32_t k = 0; k < n; ++k) {
			Group& group = groups[touching[k].at / Group::size];
			const std::uint32_t lane = touching[k].at % Group::size;
			const Vector3<S> spring{ S::load(group.spring[0] + lane), S::load(group.spring[1] + lane),
				S::load(group.spring[2] + lane) };
			const auto answer = contact_forces<Friction>(
				law, touching[k], spring, S::load(group.stiffness + lane), S::load(group.damping + lane), S(P(step.dt)));
			store_springs(group, lane, answer.spring);
			const S column[6] = { answer.force.x, answer.force.y, answer.force.z, answer.turn.x, answer.turn.y, answer.turn.z };
			asm volatile("" : "+r"(moving));
			if (__builtin_expect(moving, true))
				Turn::lines(
					column, [&](int pair, const auto& line) __attribute__((always_inline)) {
						adder.to_owner(group.links[lane + pair].first, line);
						adder.to_partner(group.links[lane + pair].second, line);
					});
			else
				Turn::lines(
					column, [&](int pair, const auto& line) __attribute__((always_inline)) {
						LineAdder::store(share.early_forces[touching[k].at - share.early_begin + pair], line);
					});
		}
		return at;
	}

	static inline void store_springs(Group& group, std::uint32_t lane, const Vector3<S>& spring)
	{
		if constexpr (!Friction) return;
		spring.x.store(group.spring[0] + lane);
		spring.y.store(group.spring[1] + lane);
		spring.z.store(group.spring[2] + lane);
	}

	/// Partners' rows come from far away: they are called in time. Groups end with as many links that may be read.
	static inline void prefetch_rows(const SphereRow* rows, const Group* groups, std::uint32_t at)
	{
		const PairLink* links = groups[at / Group::size].links + at % Group::size;
		for (int k = 0; k < S::width; ++k) {
			const char* row = reinterpret_cast<const char*>(rows) + links[k].second;
			_mm_prefetch(row, _MM_HINT_T0);
			_mm_prefetch(row + 64, _MM_HINT_T0);
		}
	}

	/// Springs and constants are read once a step: they are called past the large caches, which are left to rows (1.2 times the rate at
	/// 190,000 spheres, nothing at 20,000).
	static inline void prefetch_group(const Group& group)
	{
		const char* line = reinterpret_cast<const char*>(group.spring);
		for (; line < reinterpret_cast<const char*>(&group + 1); line += 64) _mm_prefetch(line, _MM_HINT_NTA);
	}

	static inline Four load(const double* from)
	{
		Four four;
		std::memcpy(&four, __builtin_assume_aligned(from, 32), sizeof four);
		return four;
	}
	static inline void store(const Four& four, double* to) { std::memcpy(__builtin_assume_aligned(to, 32), &four, sizeof four); }

	/// Kicks and drifts a block; returns a bound on the way of any of its spheres against the block's drift [m].
	static inline double move_block(const SphereStep& step, std::uint32_t block)
	{
		const std::uint32_t first = block * grains_per_block,
							end = std::min<std::uint32_t>(first + grains_per_block, step.n_free);
		const double turn = step.kick * step.spin_response;
		const Four kick = { step.kick, step.kick, step.kick, turn }, drift = { step.drift, step.drift, step.drift, 0 };
		const Four fall = { step.gravity[0] * step.kick, step.gravity[1] * step.kick, step.gravity[2] * step.kick, 0 };
		const geometry::Vec<3>& along = step.drifts[block];
		const Four zero = {}, common = { along[0], along[1], along[2], 0 };
		Four highest = {};
		for (std::uint32_t i = first; i < end; ++i) {
			double* row = step.rows[i].x.coordinate;
			const double inverse_mass = step.inverse_masses[i];
			const Four lower = load(row + 8), upper = load(row + 12);  // surface y z, force x y; force z, turn x y z
			const Four force = __builtin_shufflevector(lower, upper, 2, 3, 4, 5),
					   turns = __builtin_shufflevector(upper, zero, 2, 3, 4, 4);
			const Four velocity = load(row + 4) + (force * (inverse_mass * kick) + fall);
			store(load(row) + velocity * drift, row);
			store(velocity, row + 4);
			store(__builtin_shufflevector(lower, zero, 0, 1, 4, 4) + turns * (inverse_mass * turn), row + 8);
			store(zero, row + 12);
			const Four against = velocity - common, square = against * against;
			highest = square > highest ? square : highest;
		}
		return std::sqrt(highest[0] + highest[1] + highest[2]) * step.drift;
	}
};

template <template <class> class Law, class P, bool Friction>
SphereKernel sphere_kernel_of()
{
	using B = SphereBody<Law<P>, P, Friction>;
	return { &B::early, &B::sweep, &near_in_columns, compiled_for, B::S::width };
}

template <template <class> class Law>
SphereKernel sphere_kernel_of(const KernelChoice& choice)
{
	if constexpr (!laws::is_for_spheres(Law<Real>{})) {
		return {};
	} else {
		if (choice.precision == Precision::single)
			return choice.friction ? sphere_kernel_of<Law, float, true>() : sphere_kernel_of<Law, float, false>();
		return choice.friction ? sphere_kernel_of<Law, double, true>() : sphere_kernel_of<Law, double, false>();
	}
}

template <template <class> class... Law>
SphereKernel sphere_kernel_of(laws::LawList<Law...>, const KernelChoice& choice)
{
	constexpr SphereKernel (*of_law[])(const KernelChoice&) = { &sphere_kernel_of<Law>... };
	return of_law[choice.law](choice);
}

/// One set of kernels, for the instructions this file is compiled for; none for a law that is for disks only.
SphereKernel sphere_kernel_compiled_here(const KernelChoice& choice) { return sphere_kernel_of(laws::Laws{}, choice); }

}  // namespace
}  // namespace graindrive::loop
