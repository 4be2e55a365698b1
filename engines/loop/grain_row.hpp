/// What the loop keeps in memory: one 64-byte row per grain, and for every pair a link, a tangential spring and a force.
///
/// Every changing quantity that a contact needs is a sum or a difference of two rows, so a kernel subtracts whole rows and transposes once.
#pragma once
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace graindrive::loop {

struct alignas(64) GrainRow {
	double x, y;           ///< centre [m]; not wrapped between two searches for neighbours
	double vx, vy;         ///< velocity, half a step behind the position [m/s]
	double radius;         ///< [m]
	double surface_speed;  ///< radius * spin [m/s], counter-clockwise positive
	double inverse_mass;   ///< 1/m [1/kg]; 0 stands for an infinite mass
	double unused;
};
static_assert(sizeof(GrainRow) == 64, "one row, one cache line");

/// Byte offsets of the two rows of a pair from the first row: `first` is the owner, on which the stored force acts.
struct PairLink {
	std::uint32_t first, second;
};

/// Force of one pair on its owner; on the partner x and y change sign, the friction does not.
template <class P>
struct alignas(4 * sizeof(P)) PairForce {
	P x, y;      ///< [N]
	P friction;  ///< F_t along t = z x n [N]: its torque on either grain is radius * F_t
	P normal;  ///< F_n, > 0 repels [N]; with a law that acts at the contact point overlap/2 F_t [N m], by which torques are less
};

/// Where a grain finds its pair forces, in bytes from the first: three pairs it owns, then three it is partner in. 0 is no pair.
/// A grain with more has its surplus folded into one extra force beforehand, so that summing needs no branch.
struct ForceSlots {
	static constexpr int owned = 3, partnered = 3;
	std::uint32_t at[owned + partnered];
};

/// Memory on cache-line boundaries.
template <class T>
struct CacheAligned {
	using value_type = T;
	CacheAligned() = default;
	template <class U>
	CacheAligned(const CacheAligned<U>&)
	{
	}
	T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
	void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
	template <class U>
	bool operator==(const CacheAligned<U>&) const
	{
		return true;
	}
	template <class U>
	bool operator!=(const CacheAligned<U>&) const
	{
		return false;
	}
};

template <class T>
using AlignedVector = std::vector<T, CacheAligned<T>>;

}  // namespace graindrive::loop
