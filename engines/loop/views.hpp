/// What a loop shows of its contacts.
#pragma once
#include "engines/loop/pair_geometry.hpp"

namespace graindrive::loop {

/// A contact, all of it at one moment. Forces act on `first`; on `second` they are opposite.
template <int D>
struct Contact {
	std::uint32_t first, second;  ///< indices in `Scene::grains`
	Vec<D> n;                     ///< from first to second
	Vec<D> point;                 ///< on the surface of first [m]
	double normal;                ///< F_n > 0 repels [N]
	Tangent<D> friction;          ///< F_t on first [N], in the plane along z x n
	double overlap;               ///< [m]
	Tangent<D> slip;              ///< tangential spring [m], or the force [N] that YADE's own laws remember
	bool slipping;                ///< Coulomb's bound is active
};

/// The tangential spring of two grains, or what else the law remembers. In the plane its sign does not change when they change places;
/// in space it is that of first's surface against second's.
template <int D>
struct Spring {
	std::uint32_t first, second;  ///< indices in `Scene::grains`
	Tangent<D> slip;              ///< [m]; [N] with a law that remembers a force
};

/// One contact on a member of a rigid body, or on its surface.
template <int D>
struct Touch {
	std::uint32_t member, partner;  ///< indices in `Scene::grains`; beyond their end surfaces, in the order of walls, then solids
	Vec<D> arm;     ///< from the body's place to where the law's force acts: the member's surface, or half an overlap below [m]
	Vec<D> n;       ///< out of the body
	double normal;  ///< F_n along -n on the body [N]
	Tangent<D> friction;  ///< F_t on the body [N], in the plane along z x n
	bool slipping;        ///< Coulomb's bound is active
};

/// A pair's force on its owner in parts.
template <int D>
struct ForceParts {
	double normal;        ///< F_n > 0 repels [N]
	Tangent<D> friction;  ///< F_t [N]
	Vec<D> n;             ///< from the owner to its partner
	double square() const { return normal * normal + inner(friction, friction); }
};

/// What the contacts of free grains do to a member of a body.
template <int D>
struct MemberForce {
	Vec<D> force;        ///< [N]
	Spin<D> turning{};   ///< torque over the member's radius [N]
	double shorter = 0;  ///< in the plane: by how much the torque is less, for laws that act at the contact point [N m]
};

struct PairCounts {
	std::size_t selected = 0, by_half_budgets = 0;  ///< by_half_budgets: if grains had half the way to go
};

}  // namespace graindrive::loop
