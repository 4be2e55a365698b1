/// What a scene consists of: grains, rigid bodies, walls, a periodic cell and a contact law. Plain data, in the units of the caller.
///
/// `D` is the number of dimensions: 2 for disks, 3 for spheres.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engines/geometry/cell.hpp"
#include "engines/geometry/rigid_motion.hpp"
#include "engines/loop/processor.hpp"
#include "engines/loop/wall.hpp"

namespace graindrive::loop {

using geometry::Cell;
using geometry::Turn;

constexpr int free_grain = -1;  ///< `Grain::body` of a grain that belongs to no rigid body

template <int D>
struct Grain {
	Vec<D> place;           ///< of the centre [m]
	Vec<D> velocity;        ///< [m/s], half a step behind the place (leapfrog)
	Spin<D> spin{};         ///< [rad/s], counter-clockwise in the plane
	double radius = 0;      ///< [m]
	double mass = 0;        ///< [kg]; infinity lets a grain of a fixed body count with the partner's mass alone in m_eff
	int body = free_grain;  ///< index in `Scene::bodies`, or `free_grain`
};

constexpr int spin_axes(int D) { return D == 2 ? 1 : 3; }

/// Grains that move as one, or a solid with a surface, or both: a driven disk, a glued intruder, a drum, a base, a cylinder.
/// Members feel no contacts among themselves. A degree of freedom that does not respond keeps the velocity it is given.
template <int D>
struct RigidBody : geometry::RigidMotion<D> {
	double mass = 0;                         ///< [kg]; needed where the body responds
	Spin<D> inertia{};                       ///< [kg m^2], in space about the axes of its frame
	std::array<bool, D> responds{};          ///< to contacts and gravity, along each axis
	std::array<bool, spin_axes(D)> turns{};  ///< about each axis of the world; in the plane one
	bool frozen = false;                     ///< will never move: costs nothing, knows no forces, and meets no other frozen body
	Vec<D> force;                            ///< by contacts, in the last step [N]
	Spin<D> torque{};                        ///< about `place` [N m]
	Vec<D> load;                             ///< a constant force on what responds [N]
	Vec<D> push;                             ///< from outside, in the step that comes [N]
	Spin<D> push_torque{};                   ///< [N m]
	Spin<D> momentum{}, spin_of_momentum{};  ///< in space: angular momentum [N m s] that belongs to that spin; kept by the loop

	bool responds_somewhere() const
	{
		for (const bool yes : responds)
			if (yes) return true;
		return false;
	}
	bool turns_somewhere() const
	{
		for (const bool yes : turns)
			if (yes) return true;
		return false;
	}
};

/// What makes a body a solid: its surface in the body's frame. `recipe` is the text that the surface is made from, for checkpoints.
template <int D>
struct Solid {
	int body = 0;  ///< index in `Scene::bodies`
	geometry::SharedSurface<D> shape;
	std::string recipe;

	/// Of the surface's box, along axes on which it ends; else 0: grains meet the image that is nearest to it.
	Vec<D> middle() const
	{
		const geometry::Bounds<D> box = shape->bounds();
		Vec<D> at = (box.low + box.high) / 2;
		for (int k = 0; k < D; ++k)
			if (!std::isfinite(at[k])) at[k] = 0;
		return at;
	}
};

template <int D>
struct Scene {
	std::vector<Grain<D>> grains;
	std::vector<RigidBody<D>> bodies;
	std::vector<Solid<D>> solids;
	std::vector<Wall<D>> walls;  ///< flat, at most one on each side
	Cell<D> cell;
	ContactLaw law;
	bool friction = true;       ///< off: no tangential force and no history
	bool rotation = true;       ///< off: spins stay as they are
	Vec<D> gravity;             ///< [m/s^2]
	double damping = 0;         ///< Cundall's non-viscous damping [-], see damping.hpp
	bool damps_gravity = true;  ///< gravity is damped with the other forces
	double dt = 0;              ///< time step [s]
	Precision precision = Precision::double_;
	int threads = 1;
	double spin_response = D == 2 ? 2 : 2.5;  ///< m R^2 / I of free grains
	double skin = 0;                          ///< how far beyond touching neighbours are listed [m]; 0 lets the loop choose
	double target_fraction = 0;               ///< walls halt where grains fill so much of the box; 0: they never do
};

std::string name_of(Side side);
/// @throws std::invalid_argument listing the sides that there are in D dimensions
template <int D>
Side side_named(const std::string& name);
/// What a pressure on the wall acts on: the box's extent along it, a length [m] in the plane, an area [m^2] in space; 0 where
/// nothing bounds it.
template <int D>
double wall_extent(const Scene<D>& scene, const Wall<D>& wall);
/// Sum of the areas of disks (volumes of spheres) that are not frozen, over that of the box between walls or periodic sides.
/// Overlapping members of a body count twice.
template <int D>
double filled_fraction(const Scene<D>& scene);

}  // namespace graindrive::loop
