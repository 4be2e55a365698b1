/// The inner functions of the loop over disks: forces of a pack of pairs, and the motion of a block of free grains (leapfrog, both half kicks merged).
///
///   v_{n+1/2} = v_{n-1/2} + (F_n / m + g) dt,   x_{n+1} = x_n + v_{n+1/2} dt,   (R w)_{n+1/2} = (R w)_{n-1/2} + (R^2 / I) sum F_t dt
///
/// A sweep runs through the free grains in memory order. A pair is owned by its lower index, so once the pairs owned up to grain i are
/// computed nothing will ask for grain i's old position again, and it can move at once, while its row is still in the nearest cache.
#pragma once
#include <algorithm>
#include <emmintrin.h>

#include "engines/laws/pair_geometry.hpp"
#include "engines/loop/damping.hpp"
#include "engines/loop/disks/row_transpose.hpp"

namespace graindrive::loop {
namespace {

/// The law's input for a pack of pairs, and the position of the pack.
template <class S>
struct PackGeometry {
	laws::Planar<S> n;
	S overlap;
	laws::RelativeMotion<S, S> motion;
	typename S::Mask touching;
	std::uint32_t at;
};

template <class S>
struct PackForces {
	S x, y, friction, normal, slip;
};

/// Columns of row differences and sums -> geometry of the pairs that touch; false if none does.
template <class Law, class S>
inline bool pack_geometry(const S column[6], PackGeometry<S>& contact)
{
	const S &dx = column[0], &dy = column[1], &dvx = column[2], &dvy = column[3], &reach = column[4], &surface_speed = column[5];
	const S square = dx * dx + dy * dy;
	contact.touching = square < reach * reach;
	if (!any(contact.touching)) return false;
	const S distance = sqrt(square);
	const S inverse = S(1) / distance;
	contact.n = { dx * inverse, dy * inverse };
	contact.overlap = max(reach - distance, S(0));
	if constexpr (Law::acts_at_contact_point)
		contact.motion = laws::relative_motion<S>(contact.n, { dvx, dvy }, surface_speed, reach * inverse);
	else
		contact.motion = laws::relative_motion<S>(contact.n, { dvx, dvy }, surface_speed);
	return true;
}

/// Forces on the owners. Without friction the compiler drops all that only the tangential force needs.
template <bool Friction, class Law, class S>
inline PackForces<S> pack_forces(
	const Law& law, const PackGeometry<S>& pack, const S& effective_radius, const S& effective_mass, const S& slip, const S& dt)
{
	laws::Kinematics<S, S> contact;
	contact.overlap = pack.overlap;
	contact.normal_velocity = pack.motion.normal;
	contact.tangential_velocity = pack.motion.tangential;
	contact.effective_radius = effective_radius;
	contact.effective_mass = effective_mass;
	contact.dt = dt;

	const S zero(0);
	const auto response = law(contact, slip);
	const S normal = select(pack.touching, response.normal, zero);
	if constexpr (!Friction) return { -(normal * pack.n.x), -(normal * pack.n.y), zero, normal, zero };
	const S friction = select(pack.touching, response.tangential, zero);
	const laws::Planar<S> force = laws::force_on_first(pack.n, normal, friction);
	PackForces<S> forces{ force.x, force.y, friction, normal, select(pack.touching, response.slip, zero) };
	if constexpr (Law::acts_at_contact_point) forces.normal = (contact.overlap * S(0.5)) * friction;
	return forces;
}

template <class Law, class P, bool Friction>
struct Body {
	using Turn = Transposer<P>;
	using S = typename Turn::Number;

	static void pairs(const DiskStep& data, std::uint32_t begin, std::uint32_t end, bool wrapped)
	{
		run(data, { 0, 1, 0, begin, end, wrapped, false });
	}

	static bool sweep(
		const DiskStep& data, std::uint32_t begin, std::uint32_t end, std::uint32_t n_free, std::uint32_t first_pair)
	{
		if (data.damping != 0) return damped_sweep(data, begin, end, n_free, first_pair);
		return run(data, { begin, end, n_free, first_pair, 0, false, true });
	}

private:
	typedef double Two __attribute__((vector_size(16)));
	typedef P Four __attribute__((vector_size(4 * sizeof(P))));

	/// Number by number: from a copy as a whole the compiler fuses other products, and results would differ in the last bit.
	static inline Law law_of(const DiskStep& data)
	{
		Law law{};
		const Law& given = *static_cast<const Law*>(data.law);
		Law::constants([&](const laws::Quantity&, auto constant) { law.*constant = given.*constant; });
		return law;
	}

	struct Work {
		std::uint32_t block_begin, block_end, n_free, pair_begin, pair_end;
		bool wrapped, moving;  // across periodic sides; blocks move, and say where their pairs end
	};

	/// Early pairs and sweeps share one copy of the machine code: in another the compiler may fuse another product of a sum, and a pair
	/// would be rounded by where it is computed, that is by the number of threads.
	__attribute__((flatten, noipa)) static bool run(const DiskStep& data, const Work& work)
	{
		const Law law = law_of(data);
		const RowDifference difference(data);
		bool beyond = false;
		std::uint32_t at = work.pair_begin;
		for (std::uint32_t block = work.block_begin; block < work.block_end; ++block) {
			const std::uint32_t done = work.moving ? data.block_pair_end[block] : work.pair_end;
			while (at < done) at = packs(difference, data, law, at, done, work.wrapped);
			if (!work.moving) break;
			if (has_folds(data, block)) fold(data, block);
			const std::uint32_t first = block * grains_per_block;
			const Two fastest =
				move_block(data, data.block_order[block], first, std::min<std::uint32_t>(grains_per_block, work.n_free - first));
			data.travelled[block] += std::sqrt(fastest[0] + fastest[1]) * data.drift;
			beyond |= data.travelled[block] > data.allowed[block];
		}
		return beyond;
	}

	/// With damping every grain is asked which way it goes. Pairs are computed by the same machine code, called block by block, so that
	/// the code of undamped scenes stays what it is.
	static bool damped_sweep(
		const DiskStep& data, std::uint32_t begin, std::uint32_t end, std::uint32_t n_free, std::uint32_t first_pair)
	{
		bool beyond = false;
		for (std::uint32_t block = begin; block < end; ++block) {
			if (const std::uint32_t done = data.block_pair_end[block]; done > first_pair) {
				run(data, { 0, 1, 0, first_pair, done, false, false });
				first_pair +=
					(done - first_pair + S::width - 1) / S::width * S::width;  // the last pack may reach into the next block
			}
			if (has_folds(data, block)) fold(data, block);
			const std::uint32_t first = block * grains_per_block;
			const Two fastest = move_damped_block(
				data, data.block_order[block], first, std::min<std::uint32_t>(grains_per_block, n_free - first));
			data.travelled[block] += std::sqrt(fastest[0] + fastest[1]) * data.drift;
			beyond |= data.travelled[block] > data.allowed[block];
		}
		return beyond;
	}

	static inline bool has_folds(const DiskStep& data, std::uint32_t block)
	{
		return block > 0 ? data.block_fold_end[block] > data.block_fold_end[block - 1] : data.block_fold_end[0] > 0;
	}

	/// Forces of the pairs from `at` on, in two stages: the roots and divisions of many packs overlap, the law's wait for them no more.
	/// @return where the next pack begins
	static inline std::uint32_t packs(
		const RowDifference& difference, const DiskStep& data, const Law& law, std::uint32_t at, std::uint32_t end, bool wrapped)
	{
		constexpr int most = 16;
		PackGeometry<S> touching[most];
		int n = 0;
		for (int k = 0; k < most && at < end; ++k, at += S::width) {
			S column[6];
			asm volatile("" : "+r"(wrapped));  // or the compiler makes a loop for either, with a copy of the law in each
			if (__builtin_expect(wrapped, false))
				Turn::template columns<true>(difference, data.links + at, column);
			else
				Turn::template columns<false>(difference, data.links + at, column);
			touching[n].at = at;
			if (pack_geometry<Law>(column, touching[n]))
				++n;
			else
				put(data, at, { S(0), S(0), S(0), S(0), S(0) });
		}
		for (int k = 0; k < n; ++k) {
			const std::uint32_t place = touching[k].at;
			const S radius = S::load(static_cast<const P*>(data.effective_radii) + place),
					mass = S::load(static_cast<const P*>(data.effective_masses) + place),
					slip = Friction ? S::load(static_cast<const P*>(data.slips) + place) : S(0);
			put(data, place, pack_forces<Friction>(law, touching[k], radius, mass, slip, S(P(data.dt))));
		}
		return at;
	}

	static inline void put(const DiskStep& data, std::uint32_t at, const PackForces<S>& f)
	{
		if constexpr (Friction) f.slip.store(static_cast<P*>(data.slips) + at);
		Turn::store(f.x, f.y, f.friction, f.normal, static_cast<PairForce<P>*>(data.forces) + at);
	}

	static void fold(const DiskStep& data, std::uint32_t block)
	{
		auto* forces = static_cast<PairForce<P>*>(data.forces);
		for (std::uint32_t f = block > 0 ? data.block_fold_end[block - 1] : 0; f < data.block_fold_end[block]; ++f) {
			PairForce<P> sum{};
			for (std::uint32_t s = data.folds[f].begin; s < data.folds[f].end; ++s) {
				const PairForce<P>& one = forces[data.fold_sources[s]];
				sum = { sum.x + one.x, sum.y + one.y, sum.friction + one.friction, sum.normal + one.normal };
			}
			forces[data.folds[f].target] = sum;
		}
	}

	static inline Four force_at(const char* forces, std::uint32_t bytes)
	{
		return *reinterpret_cast<const Four*>(forces + bytes);
	}

	/// Sum of the forces on a free grain.
	static inline Four total_force(const char* forces, const std::uint32_t* at)
	{
		const Four partner_sign = { -1, -1, 1, 1 };
		const Four owned = (force_at(forces, at[0]) + force_at(forces, at[1])) + force_at(forces, at[2]);
		const Four partnered = (force_at(forces, at[3]) + force_at(forces, at[4])) + force_at(forces, at[5]);
		return partnered * partner_sign + owned;
	}

	/// Torque over radius [N].
	static inline double turning_force(const Four& total, const DiskRow& row)
	{
		if constexpr (Law::acts_at_contact_point && Friction) return double(total[2]) - double(total[3]) / row.radius;
		return double(total[2]);
	}

	/// Largest v_x^2 and v_y^2 among the grains moved.
	static inline Two move_block(const DiskStep& data, const BlockOrder& block, std::uint32_t first, std::uint32_t count)
	{
		const auto* forces = static_cast<const char*>(data.forces);
		const ForceSlots* slots = data.slots + first;
		DiskRow* rows = data.rows + first;
		const Two gravity_kick = { data.gravity[0] * data.kick, data.gravity[1] * data.kick };
		const Two no_speed = {}, drift = data.drift - no_speed;
		const double kick = data.kick, spin_response = data.spin_response;
		const std::uint32_t with_pairs = block.with_pairs;
		Two highest = {};
		const auto kick_and_drift = [&](std::uint32_t g) __attribute__((always_inline))
		{
			const Four total = total_force(forces, slots[g].at);
			DiskRow& row = rows[g];
			const double response = row.inverse_mass * kick;
			const Two force = { double(total[0]), double(total[1]) };
			row.surface += turning_force(total, row) * (response * spin_response);
			drift_row(row, force * response + gravity_kick, drift, highest);
		};
		if (with_pairs == count) {
			for (std::uint32_t g = 0; g < count; ++g) kick_and_drift(g);
		} else {
			for (std::uint32_t k = 0; k < with_pairs; ++k) kick_and_drift(block.order[k]);
			for (std::uint32_t k = with_pairs; k < count; ++k) drift_row(rows[block.order[k]], gravity_kick, drift, highest);
		}
		return highest;
	}

	/// The same with damping.
	static Two move_damped_block(const DiskStep& data, const BlockOrder& block, std::uint32_t first, std::uint32_t count)
	{
		const auto* forces = static_cast<const char*>(data.forces);
		const Two no_speed = {}, drift = data.drift - no_speed;
		Two highest = {};
		for (std::uint32_t k = 0; k < count; ++k) {
			const std::uint32_t g = first + block.order[k];
			DiskRow& row = data.rows[g];
			const Four total = k < block.with_pairs ? total_force(forces, data.slots[g].at) : Four{};
			const OutsideForce more = data.outside ? data.outside[g] : OutsideForce{};
			const double turning = (turning_force(total, row) + more.turning) * row.inverse_mass * data.spin_response;
			row.v[0] = kicked(row.v[0], (double(total[0]) + more.force[0]) * row.inverse_mass, data.gravity[0], data);
			row.v[1] = kicked(row.v[1], (double(total[1]) + more.force[1]) * row.inverse_mass, data.gravity[1], data);
			row.surface = kicked(row.surface, turning, 0, data);
			drift_row(row, no_speed, drift, highest);
		}
		return highest;
	}

	static inline void drift_row(DiskRow& row, Two kick, Two drift, Two& highest)
	{
		Two position, velocity;
		std::memcpy(&position, row.x.coordinate, sizeof position);
		std::memcpy(&velocity, row.v.coordinate, sizeof velocity);
		velocity = velocity + kick;
		position = position + velocity * drift;
		std::memcpy(row.x.coordinate, &position, sizeof position);
		std::memcpy(row.v.coordinate, &velocity, sizeof velocity);
		highest = (Two)_mm_max_pd((__m128d)highest, (__m128d)(velocity * velocity));
	}
};

template <template <class> class Law, class P, bool Friction>
DiskKernel disk_kernel_of()
{
	using B = Body<Law<P>, P, Friction>;
	return { &B::pairs, &B::sweep, compiled_for, B::S::width };
}

template <template <class> class Law>
DiskKernel disk_kernel_of(const KernelChoice& choice)
{
	if (choice.precision == Precision::single)
		return choice.friction ? disk_kernel_of<Law, float, true>() : disk_kernel_of<Law, float, false>();
	return choice.friction ? disk_kernel_of<Law, double, true>() : disk_kernel_of<Law, double, false>();
}

template <template <class> class... Law>
DiskKernel disk_kernel_of(laws::LawList<Law...>, const KernelChoice& choice)
{
	constexpr DiskKernel (*of_law[])(const KernelChoice&) = { &disk_kernel_of<Law>... };
	return of_law[choice.law](choice);
}

/// One set of kernels, for the instructions this file is compiled for.
DiskKernel disk_kernel_compiled_here(const KernelChoice& choice) { return disk_kernel_of(laws::Laws{}, choice); }

}  // namespace
}  // namespace graindrive::loop
