/// Small scenes for the tests of this room, and a plain loop over all pairs to hold the fast one to.
#pragma once
#include <cmath>
#include <map>
#include <random>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop::test {

inline Grain disk(double x, double y, double radius = 0.5, int body = free_grain)
{
	Grain g;
	g.x = x, g.y = y, g.radius = radius, g.mass = pi * radius * radius, g.body = body;
	return g;
}

inline laws::HertzHistory<Real> hertz(double mu = 0.3, double damping = 50) { return { 2e5, 2.46e5, damping, damping, mu }; }

/// A crowd of disks with random radii, velocities and spins, so dense that many touch; periodic in both directions.
inline Scene crowd(int side, unsigned seed, double speed = 1)
{
	std::mt19937 random(seed);
	const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
	Scene s;
	s.box = { 0, double(side), 0, double(side), true, true };
	for (int row = 0; row < side; ++row)
		for (int column = 0; column < side; ++column) {
			Grain g = disk(column + 0.5 + uniform(-0.02, 0.02), row + 0.5 + uniform(-0.02, 0.02), uniform(0.45, 0.5));
			g.vx = uniform(-speed, speed), g.vy = uniform(-speed, speed), g.spin = uniform(-speed, speed);
			s.grains.push_back(g);
		}
	s.law = hertz();
	s.dt = 1e-4;
	return s;
}

/// The same physics written down once more, slowly: every pair, every step, no lists, no packs.
class PlainLoop {
public:
	Scene s;
	explicit PlainLoop(const Scene& scene) : s(scene) {}

	void step()
	{
		const std::size_t n = s.grains.size();
		std::vector<double> fx(n, 0), fy(n, 0), torque(n, 0);
		for (std::size_t i = 0; i < n; ++i)
			for (std::size_t j = i + 1; j < n; ++j) pair(i, j, fx, fy, torque);
		for (std::size_t i = 0; i < n; ++i) {
			Grain& g = s.grains[i];
			if (g.body != free_grain) continue;
			kick(g.vx, fx[i] / g.mass, s.gravity_x), kick(g.vy, fy[i] / g.mass, s.gravity_y);
			if (s.rotation) kick(g.spin, torque[i] / (g.mass * g.radius * g.radius / 2), 0);
			g.x += g.vx * s.dt, g.y += g.vy * s.dt;
		}
	}

private:
	/// Less of what speeds up, more of what slows down.
	void kick(double& velocity, double pull, double gravity) const
	{
		double a = pull + (s.damps_gravity ? gravity : 0);
		a *= a * (velocity + a * s.dt / 2) > 0 ? 1 - s.damping : 1 + s.damping;
		velocity += (a + (s.damps_gravity ? 0 : gravity)) * s.dt;
	}

	std::map<std::pair<std::size_t, std::size_t>, double> slips;

	static double nearest(double d, bool periodic, double length)
	{
		return periodic ? d - length * std::nearbyint(d / length) : d;
	}

	void pair(std::size_t i, std::size_t j, std::vector<double>& fx, std::vector<double>& fy, std::vector<double>& torque)
	{
		const Grain &a = s.grains[i], &b = s.grains[j];
		const double dx = nearest(b.x - a.x, s.box.periodic_x, s.box.x_high - s.box.x_low),
					 dy = nearest(b.y - a.y, s.box.periodic_y, s.box.y_high - s.box.y_low);
		if (dx * dx + dy * dy > 4) return;  // disks here have radii up to 0.5: this pair has long been apart
		const double r = std::hypot(dx, dy), overlap = a.radius + b.radius - r;
		if (overlap <= 0) {
			slips.erase({ i, j });
			return;
		}
		const double nx = dx / r, ny = dy / r, dvx = b.vx - a.vx, dvy = b.vy - a.vy;
		const bool at_contact_point = std::visit([](const auto& law) { return law.acts_at_contact_point; }, s.law);
		const double stretch = at_contact_point ? (a.radius + b.radius) / r : 1;
		laws::Kinematics<Real, Real> contact{ overlap, dvx * nx + dvy * ny,
			a.radius * a.spin + b.radius * b.spin - stretch * (dvy * nx - dvx * ny), a.radius * b.radius / (a.radius + b.radius),
			a.mass * b.mass / (a.mass + b.mass), s.dt };
		double& slip = slips[{ i, j }];
		const auto answer = std::visit(
			[&](const auto& law) -> std::array<double, 3> {
				const auto response = law(contact, slip);
				if (!s.friction) return { response.normal, 0, 0 };
				return { response.normal, response.tangential, response.slip };
			},
			s.law);
		slip = answer[2];
		const double x = -answer[0] * nx - answer[1] * ny, y = -answer[0] * ny + answer[1] * nx;
		fx[i] += x, fy[i] += y, fx[j] -= x, fy[j] -= y;
		const double below = at_contact_point ? overlap / 2 : 0;
		torque[i] += (a.radius - below) * answer[1], torque[j] += (b.radius - below) * answer[1];
	}
};

/// Largest difference of position (by the nearest image), velocity or spin between two sets of grains.
template <class A, class B>
double largest_difference(const Scene& scene, A&& grain_a, B&& grain_b)
{
	const auto wrap = [](double d, bool periodic, double length) {
		return periodic ? d - length * std::nearbyint(d / length) : d;
	};
	double largest = 0;
	for (std::size_t i = 0; i < scene.grains.size(); ++i) {
		const Grain a = grain_a(i), b = grain_b(i);
		for (const double d : { wrap(a.x - b.x, scene.box.periodic_x, scene.box.x_high - scene.box.x_low),
				 wrap(a.y - b.y, scene.box.periodic_y, scene.box.y_high - scene.box.y_low), a.vx - b.vx, a.vy - b.vy,
				 a.spin - b.spin })
			largest = std::max(largest, std::abs(d));
	}
	return largest;
}

/// True if every grain of two loops has the same bits.
inline bool same_bits(const Stepper& a, const Stepper& b)
{
	for (std::size_t i = 0; i < a.size(); ++i) {
		const Grain one = a.grain(i), other = b.grain(i);
		if (one.x != other.x || one.y != other.y || one.vx != other.vx || one.vy != other.vy || one.spin != other.spin)
			return false;
	}
	return a.size() == b.size();
}

}  // namespace graindrive::loop::test
