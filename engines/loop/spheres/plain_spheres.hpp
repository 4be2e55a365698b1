/// A plain loop over all pairs of spheres, for tests to hold the fast one to: no lists, no packs, the laws on vectors.
#pragma once
#include <cmath>
#include <map>
#include <random>

#include "engines/laws/sphere_pair.hpp"
#include "engines/loop/spheres/plain_body.hpp"

namespace graindrive::loop::test {

using geometry::norm;

inline Grain<3> sphere(const Vec<3>& place, double radius = 0.5, double density = 1)
{
	Grain<3> s;
	s.place = place, s.radius = radius, s.mass = density * 4.0 / 3 * pi * radius * radius * radius;
	return s;
}

/// Makes a sphere a body of its own that keeps its velocity and spin; it counts with its own mass in m_eff.
inline void hold(Scene<3>& scene, std::size_t index)
{
	Grain<3>& s = scene.grains[index];
	RigidBody<3> body;
	body.place = s.place, body.velocity = s.velocity, body.spin = s.spin;
	s.body = int(scene.bodies.size());
	scene.bodies.push_back(body);
}

/// A crowd on a jittered lattice, so dense that many touch; periodic in x and y, with a frozen floor below and gravity.
inline Scene<3> ball_crowd(int side, int layers, unsigned seed, double speed = 0.3)
{
	std::mt19937 random(seed);
	const auto in = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
	const auto vector = [&](double size) { return Vec<3>{ in(-size, size), in(-size, size), in(-size, size) }; };
	Scene<3> s;
	s.cell.high = { double(side), double(side), 0 };
	s.cell.periodic[0] = s.cell.periodic[1] = true;
	s.bodies.resize(1);
	s.bodies[0].frozen = true;
	for (int k = 0; k <= layers; ++k)
		for (int j = 0; j < side; ++j)
			for (int i = 0; i < side; ++i) {
				const Vec<3> shift = vector(0.02);
				Grain<3> one = sphere(Vec<3>{ i + 0.5, j + 0.5, double(k) } + shift, in(0.46, 0.503));
				one.body = k == 0 ? 0 : free_grain;
				if (k > 0) one.velocity = vector(speed), one.spin = vector(speed);
				s.grains.push_back(one);
			}
	s.gravity = { 0.3, 0, -1 };
	s.law = laws::hertz_restitution(2e4, 0.3, 0.6, 0.5);
	s.dt = 2e-4;
	return s;
}

/// Free spheres, rigid bodies, flat walls and solids.
class PlainSpheres {
public:
	Scene<3> s;
	std::vector<PlainBody> bodies;
	std::vector<Push<3>> pushes;
	std::vector<Vec<3>> force, turn;  // of the last step; turn is torque over radius
	Vec<3> overlap_torque;            // of the last step: sum of delta n x F_t, by which the levers exceed the distance [N m]

	explicit PlainSpheres(const Scene<3>& scene) : s(scene)
	{
		for (const RigidBody<3>& body : scene.bodies) bodies.emplace_back(body);
		for (const Grain<3>& g : s.grains) in_frame.push_back(g.body == free_grain ? Vec<3>{} : bodies[g.body].to_frame(g.place));
		place_members();
	}

	void forces()
	{
		const std::size_t n = s.grains.size();
		force.assign(n, {}), turn.assign(n, {});
		overlap_torque = {};
		for (PlainBody& body : bodies) body.force = body.torque = Vector3r::Zero();
		for (Wall<3>& wall : s.walls) wall.force = {};
		for (std::size_t i = 0; i < n; ++i)
			for (std::size_t j = i + 1; j < n; ++j)
				if (may_meet(s.grains[i].body, s.grains[j].body)) pair(i, j);
		for (std::size_t i = 0; i < n; ++i) {
			for (std::size_t w = 0; w < s.walls.size(); ++w)
				if (!is_frozen(s.grains[i].body)) wall(i, w);
			for (std::size_t k = 0; k < s.solids.size(); ++k)
				if (may_meet(s.grains[i].body, s.solids[k].body)) solid(i, k);
		}
		for (std::size_t i = 0; i < n; ++i)
			if (const int owner = s.grains[i].body; owner != free_grain) {
				bodies[owner].push(bodies[owner].arm(in_frame[i]), force[i]);
				bodies[owner].torque += for_law(s.grains[i].radius * turn[i]);
			}
	}

	void step()
	{
		forces();
		for (std::size_t i = 0; i < s.grains.size(); ++i) {
			Grain<3>& g = s.grains[i];
			if (g.body != free_grain) continue;
			g.velocity += (force[i] / g.mass + s.gravity) * s.dt;
			if (s.rotation) g.spin += turn[i] * (g.radius / moment(g) * s.dt);
		}
		for (const Push<3>& push : pushes) {
			Grain<3>& g = s.grains[push.grain];
			g.velocity += push.force / g.mass * s.dt;
			if (s.rotation) g.spin += push.torque / moment(g) * s.dt;
		}
		for (Grain<3>& g : s.grains)
			if (g.body == free_grain) g.place += g.velocity * s.dt;
		for (PlainBody& body : bodies) body.move(s.gravity, s.dt);
		place_members();
		for (Wall<3>& wall : s.walls) move(wall);
	}

	double kinetic_energy() const
	{
		double energy = 0;
		for (const Grain<3>& g : s.grains)
			if (g.body == free_grain)
				energy += 0.5 * (g.mass * geometry::squared_norm(g.velocity) + moment(g) * geometry::squared_norm(g.spin));
		return energy;
	}

	static double moment(const Grain<3>& g) { return 0.4 * g.mass * g.radius * g.radius; }

private:
	struct Spring {
		Vector3r s, n;
	};
	/// What two surfaces that touch do: n from the first to the second, velocities and R w of both.
	struct Meeting {
		Vec<3> n;
		double overlap, radius, mass;
		Vec<3> approach, rolling;  // v_1 - v_2, R_1 w_1 + R_2 w_2
	};
	struct Effect {
		Vec<3> force, twist;  // on the first; torque over radius, on both
	};
	using Springs = std::map<std::pair<std::size_t, std::size_t>, Spring>;
	Springs springs, wall_springs, solid_springs;
	std::vector<Vec<3>> in_frame;

	bool is_frozen(int body) const { return body != free_grain && s.bodies[body].frozen; }
	bool may_meet(int one, int other) const
	{
		return one == free_grain || (one != other && !(is_frozen(one) && is_frozen(other)));
	}

	/// By the rotation that takes one unit vector to the other.
	static Vector3r turned(const Spring& spring, const Vector3r& n)
	{
		return Quaternionr::FromTwoVectors(spring.n, n) * spring.s;
	}

	void place_members()
	{
		for (std::size_t i = 0; i < s.grains.size(); ++i) {
			Grain<3>& g = s.grains[i];
			if (g.body == free_grain) continue;
			const PlainBody& of = bodies[g.body];
			const Vec<3> arm = of.arm(in_frame[i]);
			g.place = of.b.place + arm, g.velocity = of.b.velocity + geometry::cross(of.b.spin, arm), g.spin = of.b.spin;
		}
	}

	void pair(std::size_t i, std::size_t j)
	{
		const Grain<3>&a = s.grains[i], &b = s.grains[j];
		const Vec<3> d = s.cell.nearest(b.place - a.place).at;
		const double touch = a.radius + b.radius;
		if (geometry::squared_norm(d) > 1.5 * touch * touch) return;  // has long been apart
		const double r = norm(d);
		const Effect on = meet(springs, { i, j },
			{ d / r, touch - r, a.radius * b.radius / touch, laws::effective_mass(1 / a.mass + 1 / b.mass),
				a.velocity - b.velocity, a.radius * a.spin + b.radius * b.spin });
		force[i] += on.force, force[j] -= on.force, turn[i] += on.twist, turn[j] += on.twist;
	}

	void wall(std::size_t i, std::size_t w)
	{
		const Grain<3>& g = s.grains[i];
		Wall<3>& wall = s.walls[w];
		const double way = wall.outward() * (g.place[wall.axis()] - wall.position);
		Vec<3> surface = wall.slide;
		surface[wall.axis()] = wall.velocity;
		const Effect on = meet(wall_springs, { w, i },
			{ wall.outward() * Vec<3>::along(wall.axis()), g.radius + way, g.radius, g.mass, g.velocity - surface,
				g.radius * g.spin });
		force[i] += on.force, turn[i] += on.twist, wall.force -= on.force;
	}

	/// The nearest of all images of the sphere, by trying.
	void solid(std::size_t i, std::size_t k)
	{
		const Grain<3>& g = s.grains[i];
		PlainBody& body = bodies[s.solids[k].body];
		geometry::Nearest<3> found{ HUGE_VAL, {} };
		Vec<3> seen;
		for (int x = -s.cell.periodic[0]; x <= s.cell.periodic[0]; ++x)
			for (int y = -s.cell.periodic[1]; y <= s.cell.periodic[1]; ++y) {
				const Vec<3> away = s.cell.nearest(g.place - body.b.place).at;
				const Vec<3> at = body.b.place + away + Vec<3>{ x * s.cell.length(0), y * s.cell.length(1), 0 };
				const geometry::Nearest<3> there = s.solids[k].shape->nearest(body.to_frame(at));
				// Along an endless solid all images are equally near, and the one that is nearest to its place counts.
				if (there.distance < found.distance - 1e-9 || (x == 0 && y == 0 && there.distance < found.distance + 1e-9))
					found = there, seen = at;
			}
		const Vec<3> n = -body.arm(found.normal), arm = seen + (g.radius + found.distance) / 2 * n - body.b.place;
		const double inverse = body.b.responds_somewhere() ? 1 / body.b.mass : 0;
		const Vec<3> surface = body.b.velocity + geometry::cross(body.b.spin, arm);
		const Effect on = meet(solid_springs, { k, i },
			{ n, g.radius - found.distance, g.radius, laws::effective_mass(1 / g.mass + inverse), g.velocity - surface,
				g.radius * g.spin },
			0.5);
		force[i] += on.force, turn[i] += on.twist;
		body.push(arm, -on.force);
	}

	/// `between` is how far apart along the normal the two forces act, in overlaps: at own radii, on a solid at the middle.
	Effect meet(Springs& all, std::pair<std::size_t, std::size_t> key, const Meeting& m, double between = 1)
	{
		if (m.overlap <= 0) {
			all.erase(key);
			return {};
		}
		const Vector3r n = for_law(m.n), approach = for_law(m.approach);
		const auto found = all.find(key);
		const Vector3r spring = found == all.end() ? Vector3r(Vector3r::Zero()) : turned(found->second, n);
		const Vector3r v_t = approach - approach.dot(n) * n + for_law(m.rolling).cross(n);
		const laws::Kinematics<Real, Vector3r> contact{ m.overlap, -approach.dot(n), v_t, m.radius, m.mass, s.dt };
		return std::visit(
			[&](const auto& law) {
				auto answer = law(contact, spring);
				if (!s.friction) answer.tangential = answer.slip = Vector3r::Zero();
				all[key] = { answer.slip, n };
				const Vec<3> twist = from_law(n.cross(answer.tangential));
				overlap_torque += between * m.overlap * twist;
				return Effect{ from_law(answer.tangential - answer.normal * n), twist };
			},
			s.law);
	}

	void move(Wall<3>& wall) const
	{
		if (wall.pressed) {
			const double push = wall.force[wall.axis()] - wall.outward() * wall.pressure * wall_extent(s, wall);
			wall.velocity = (wall.mass * wall.velocity + push * s.dt) / (wall.mass + wall.damping * s.dt);
		}
		wall.position += wall.velocity * s.dt;
	}
};

/// All numbers of all spheres.
inline std::vector<double> numbers(const Stepper<3>& loop)
{
	std::vector<double> all;
	for (std::size_t i = 0; i < loop.size(); ++i) {
		const Grain<3> s = loop.grain(i);
		for (const Vec<3>& v : { s.place, s.velocity, s.spin }) all.insert(all.end(), v.coordinate, v.coordinate + 3);
	}
	return all;
}

}  // namespace graindrive::loop::test
