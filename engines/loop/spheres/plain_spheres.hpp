/// A plain loop over all pairs of spheres, for tests to hold the fast one to: no lists, no packs, the laws of contact_laws.hpp on vectors.
#pragma once
#include <cmath>
#include <map>
#include <random>

#include "engines/laws/sphere_pair.hpp"
#include "engines/loop/spheres/sphere_loop.hpp"

namespace graindrive::loop::test {

inline Sphere sphere(const Vector3r& x, double radius = 0.5, double density = 1)
{
	Sphere s;
	s.x = x, s.radius = radius, s.mass = density * 4.0 / 3 * pi * radius * radius * radius;
	return s;
}

/// A crowd on a jittered lattice, so dense that many touch; periodic in x and y, with a held floor below and gravity.
inline SphereScene crowd(int side, int layers, unsigned seed, double speed = 0.3)
{
	std::mt19937 random(seed);
	const auto in = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
	const auto vector = [&](double size) { return Vector3r(in(-size, size), in(-size, size), in(-size, size)); };
	SphereScene s;
	s.box.high = { double(side), double(side), 0 };
	s.box.periodic = { true, true, false };
	for (int k = 0; k <= layers; ++k)
		for (int j = 0; j < side; ++j)
			for (int i = 0; i < side; ++i) {
				Sphere one = sphere(Vector3r(i + 0.5, j + 0.5, k) + vector(0.02), in(0.45, 0.52));
				one.held = k == 0;
				if (!one.held) one.v = vector(speed), one.spin = vector(speed);
				s.spheres.push_back(one);
			}
	s.gravity = { 0.3, 0, -1 };
	s.law = laws::hertz_restitution(2e4, 0.3, 0.6, 0.5);
	s.dt = 2e-4;
	return s;
}

class PlainSpheres {
public:
	SphereScene s;
	std::vector<Vector3r> force, turn;  // of the last step; turn is torque over radius
	Vector3r overlap_torque;            // of the last step: sum of delta n x F_t, by which the levers exceed the distance [N m]

	explicit PlainSpheres(const SphereScene& scene) : s(scene) {}

	void forces()
	{
		const std::size_t n = s.spheres.size();
		force.assign(n, Vector3r::Zero()), turn.assign(n, Vector3r::Zero());
		overlap_torque.setZero();
		for (std::size_t i = 0; i < n; ++i)
			for (std::size_t j = i + 1; j < n; ++j)
				if (!(s.spheres[i].held && s.spheres[j].held)) pair(i, j);
	}

	void step()
	{
		forces();
		for (std::size_t i = 0; i < s.spheres.size(); ++i) {
			Sphere& g = s.spheres[i];
			if (!g.held) {
				g.v += (force[i] / g.mass + s.gravity) * s.dt;
				g.spin += turn[i] * g.radius / (0.4 * g.mass * g.radius * g.radius) * s.dt;
			}
			g.x += g.v * s.dt;
		}
	}

	double kinetic_energy() const
	{
		double energy = 0;
		for (const Sphere& g : s.spheres)
			if (!g.held) energy += g.mass / 2 * (g.v.squaredNorm() + 0.4 * g.radius * g.radius * g.spin.squaredNorm());
		return energy;
	}

private:
	struct Spring {
		Vector3r s, n;
	};
	std::map<std::pair<std::size_t, std::size_t>, Spring> springs;

	/// By the rotation that takes one unit vector to the other.
	static Vector3r turned(const Spring& spring, const Vector3r& n)
	{
		return Quaternionr::FromTwoVectors(spring.n, n) * spring.s;
	}

	void pair(std::size_t i, std::size_t j)
	{
		const Sphere &a = s.spheres[i], &b = s.spheres[j];
		Vector3r d = b.x - a.x;
		for (int k = 0; k < 3; ++k)
			if (s.box.periodic[k]) d[k] -= s.box.length(k) * std::nearbyint(d[k] / s.box.length(k));
		const double touch = a.radius + b.radius;
		if (d.squaredNorm() > 1.5 * touch * touch) return;  // has long been apart
		const double r = d.norm(), overlap = a.radius + b.radius - r;
		if (overlap <= 0) {
			springs.erase({ i, j });
			return;
		}
		const Vector3r n = d / r;
		const auto found = springs.find({ i, j });
		const Vector3r spring = found == springs.end() ? Vector3r(Vector3r::Zero()) : turned(found->second, n);
		const Vector3r approach = a.v - b.v;
		const Vector3r v_t = approach - approach.dot(n) * n + (a.radius * a.spin + b.radius * b.spin).cross(n);
		const laws::Kinematics<Real, Vector3r> contact{ overlap, -approach.dot(n), v_t,
			a.radius * b.radius / (a.radius + b.radius), 1 / (1 / a.mass + 1 / b.mass), s.dt };
		std::visit(
			[&](const auto& law) {
				auto answer = law(contact, spring);
				if (!s.friction) answer.tangential = answer.slip = Vector3r::Zero();
				springs[{ i, j }] = { answer.slip, n };
				const Vector3r on_a = answer.tangential - answer.normal * n, twist = n.cross(answer.tangential);
				force[i] += on_a, force[j] -= on_a, turn[i] += twist, turn[j] += twist;
				overlap_torque += overlap * twist;
			},
			s.law);
	}
};

}  // namespace graindrive::loop::test
