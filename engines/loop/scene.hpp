/// What a scene consists of: grains, rigid bodies made of grains, a box and a contact law. Plain data, in the units of the caller.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engines/loop/kernel.hpp"
#include "engines/loop/wall.hpp"

namespace graindrive::loop {

constexpr int free_grain = -1;  ///< `Grain::body` of a grain that belongs to no rigid body

struct Grain {
	double x = 0, y = 0;    ///< centre [m]
	double vx = 0, vy = 0;  ///< velocity [m/s], half a step behind the position (leapfrog)
	double spin = 0;        ///< angular velocity, counter-clockwise [rad/s]
	double radius = 0;      ///< [m]
	double mass = 0;        ///< [kg]; infinity lets a grain of a fixed body count with the partner's mass alone in m_eff
	int body = free_grain;  ///< index in `Scene::bodies`, or `free_grain`
};

/// Grains that move as one: a driven disk, a glued intruder, a drum, a wall or base of frozen grains.
/// Members feel no contacts among themselves. A degree of freedom that does not respond keeps the velocity it is given.
struct RigidBody {
	double x = 0, y = 0, angle = 0;                                      ///< centre of mass [m], orientation [rad]
	double vx = 0, vy = 0, spin = 0;                                     ///< [m/s], [rad/s]
	double mass = 0, inertia = 0;                                        ///< [kg], [kg m^2]; needed where the body responds
	bool responds_x = false, responds_y = false, responds_spin = false;  ///< to contacts and gravity
	bool frozen = false;  ///< will never move: costs nothing, knows no forces, and meets no other frozen body
	double force_x = 0, force_y = 0, torque = 0;     ///< by contacts, in the last step [N], [N m]
	double load_x = 0, load_y = 0;                   ///< a constant force on what responds [N]
	double push_x = 0, push_y = 0, push_torque = 0;  ///< from outside, in the step that comes [N], [N m]
};

struct Box {
	double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  ///< [m]; used where periodic
	bool periodic_x = false, periodic_y = false;
};

struct Scene {
	std::vector<Grain> grains;
	std::vector<RigidBody> bodies;
	std::vector<Wall> walls;  ///< flat, at most one on each side
	Box box;
	ContactLaw law;
	bool friction = true;                 ///< off: no tangential force and no history
	bool rotation = true;                 ///< off: spins stay as they are
	double gravity_x = 0, gravity_y = 0;  ///< [m/s^2]
	double damping = 0;                   ///< Cundall's non-viscous damping [-], see damping.hpp
	bool damps_gravity = true;            ///< gravity is damped with the other forces
	double dt = 0;                        ///< time step [s]
	Precision precision = Precision::double_;
	int threads = 1;
	double spin_response = 2;         ///< m R^2 / I of free grains: 2 for disks
	double skin = 0;                  ///< how far beyond touching neighbours are listed [m]; 0 lets the loop choose
	double target_area_fraction = 0;  ///< walls halt where disks cover so much of the box; 0: they never do
};

const char* name_of(Side side);
/// @throws std::invalid_argument listing the sides
Side side_named(const std::string& name);
/// What a pressure on the wall acts on: the box's extent along it [m], 0 where nothing bounds it.
double wall_length(const Scene& scene, const Wall& wall);
/// Sum of the areas of disks that are not frozen, over the area between walls or periodic sides. Overlapping beads of a clump count twice.
double area_fraction(const Scene& scene);

}  // namespace graindrive::loop
