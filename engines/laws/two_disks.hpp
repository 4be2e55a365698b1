/// Two disks and one contact, stepped by leapfrog: the smallest simulation that a contact law can be measured in.
#pragma once
#include <algorithm>
#include <cmath>

#include "engines/laws/contact.hpp"

namespace graindrive::laws {

struct Disk {
	Real radius = 1, mass = 1;  // [m], [kg]
	Vector2r x = Vector2r::Zero(), v = Vector2r::Zero();
	Real omega = 0;  // [rad/s], counter-clockwise

	Real inertia() const { return mass * radius * radius / 2; }
};

inline Real cross(const Vector2r& a, const Vector2r& b) { return a.x() * b.y() - a.y() * b.x(); }

/// i at the origin, j beside it on the right, just touching.
struct Pair {
	Disk i, j;
	Real slip = 0;
	bool always_slid = true;

	Pair(Disk left, Disk right) : i(left), j(right) { j.x = i.x + Vector2r(i.radius + j.radius, 0); }

	Real effective_mass() const { return i.mass * j.mass / (i.mass + j.mass); }
	Real effective_radius() const { return i.radius * j.radius / (i.radius + j.radius); }
	Real overlap() const { return i.radius + j.radius - (j.x - i.x).norm(); }
	Vector2r normal() const { return (j.x - i.x).normalized(); }
	Real approach() const { return (i.v - j.v).dot(normal()); }
	Vector2r momentum() const { return i.mass * i.v + j.mass * j.v; }

	Real angular_momentum() const
	{
		return i.mass * cross(i.x, i.v) + j.mass * cross(j.x, j.v) + i.inertia() * i.omega + j.inertia() * j.omega;
	}

	/// Levers from the centres to the contact point; they add up to the distance, which conserves angular momentum exactly.
	Real lever(const Disk& disk) const { return (j.x - i.x).norm() * disk.radius / (i.radius + j.radius); }

	Kinematics<Real, Real> kinematics(Real dt) const
	{
		const Vector2r n = normal(), t(-n.y(), n.x());
		const Real v_t = (i.v - j.v).dot(t) + lever(i) * i.omega + lever(j) * j.omega;
		return { overlap(), -approach(), v_t, effective_radius(), effective_mass(), dt };
	}

	/// One kick and drift; `v` and `omega` belong to half steps. Returns the normal force on i [N].
	template <class Law>
	Real step(const Law& law, Real dt)
	{
		const Vector2r n = normal(), t(-n.y(), n.x());
		Real normal_force = 0;
		if (overlap() > 0) {
			const auto response = law(kinematics(dt), slip);
			slip = response.slip;
			always_slid = always_slid && response.slipping;
			normal_force = response.normal;
			const Vector2r force = -response.normal * n + response.tangential * t;
			i.v += force * (dt / i.mass);
			j.v -= force * (dt / j.mass);
			i.omega += lever(i) * response.tangential * (dt / i.inertia());
			j.omega += lever(j) * response.tangential * (dt / j.inertia());
		}
		i.x += i.v * dt;
		j.x += j.v * dt;
		return normal_force;
	}
};

/// What one impact looked like from outside.
struct Impact {
	Real restitution;   // of the normal velocity [-]
	Real duration;      // [s]
	Real deepest;       // greatest overlap [m]
	Real hardest;       // greatest normal force [N]
	Real energy_error;  // greatest change of kinetic + Hertz energy against the start, for an elastic law of stiffness k [J]
};

/// Steps until the disks part. The overlap's return to zero is interpolated within the last step.
template <class Law>
Impact collide(Pair& pair, const Law& law, Real dt, Real hertz_stiffness = 0)
{
	const Real v_0 = pair.approach(), mass = pair.effective_mass(), e_0 = mass * v_0 * v_0 / 2;
	Impact impact{};
	Real before = 0;
	do {
		const Real at = std::max(0.0, pair.overlap()), v_minus = pair.approach();
		impact.hardest = std::max(impact.hardest, pair.step(law, dt));
		const Real v = (v_minus + pair.approach()) / 2;
		const Real energy = mass * v * v / 2 + 0.4 * hertz_stiffness * std::pow(at, 2.5);
		impact.energy_error = std::max(impact.energy_error, std::abs(energy - e_0));
		impact.deepest = std::max(impact.deepest, pair.overlap());
		impact.duration += dt;
		if (pair.overlap() > 0) before = pair.overlap();
	} while (pair.overlap() > 0);
	impact.duration += dt * pair.overlap() / (before - pair.overlap());
	impact.restitution = -pair.approach() / v_0;
	return impact;
}

}  // namespace graindrive::laws
