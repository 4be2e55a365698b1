/// Small scenes for the tests of this room, and a plain loop over all pairs to hold the fast one to.
#pragma once
#include <cmath>
#include <map>
#include <random>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop::test {

inline Grain<2> disk(double x, double y, double radius = 0.5, int body = free_grain)
{
	Grain<2> g;
	g.place[0] = x, g.place[1] = y, g.radius = radius, g.mass = pi * radius * radius, g.body = body;
	return g;
}

inline laws::HertzHistory<Real> hertz(double mu = 0.3, double damping = 50) { return { 2e5, 2.46e5, damping, damping, mu }; }

/// A crowd of disks with random radii, velocities and spins, so dense that many touch; periodic in both directions.
inline Scene<2> crowd(int side, unsigned seed, double speed = 1)
{
	std::mt19937 random(seed);
	const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
	Scene<2> s;
	s.cell = { { 0, 0 }, { double(side), double(side) }, { true, true } };
	for (int row = 0; row < side; ++row)
		for (int column = 0; column < side; ++column) {
			Grain<2> g = disk(column + 0.5 + uniform(-0.02, 0.02), row + 0.5 + uniform(-0.02, 0.02), uniform(0.45, 0.5));
			g.velocity[0] = uniform(-speed, speed), g.velocity[1] = uniform(-speed, speed), g.spin = uniform(-speed, speed);
			s.grains.push_back(g);
		}
	s.law = hertz();
	s.dt = 1e-4;
	return s;
}

/// The same physics written down once more, slowly: every pair, every step, no lists, no packs.
class PlainLoop {
public:
	Scene<2> s;
	explicit PlainLoop(const Scene<2>& scene) : s(scene) {}

	void step()
	{
		const std::size_t n = s.grains.size();
		std::vector<double> fx(n, 0), fy(n, 0), torque(n, 0);
		for (std::size_t i = 0; i < n; ++i)
			for (std::size_t j = i + 1; j < n; ++j) pair(i, j, fx, fy, torque);
		for (std::size_t i = 0; i < n; ++i) {
			Grain<2>& g = s.grains[i];
			if (g.body != free_grain) continue;
			kick(g.velocity[0], fx[i] / g.mass, s.gravity[0]), kick(g.velocity[1], fy[i] / g.mass, s.gravity[1]);
			if (s.rotation) kick(g.spin, torque[i] / (g.mass * g.radius * g.radius / 2), 0);
			g.place[0] += g.velocity[0] * s.dt, g.place[1] += g.velocity[1] * s.dt;
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
		const Grain<2>&a = s.grains[i], &b = s.grains[j];
		const double dx = nearest(b.place[0] - a.place[0], s.cell.periodic[0], s.cell.high[0] - s.cell.low[0]),
					 dy = nearest(b.place[1] - a.place[1], s.cell.periodic[1], s.cell.high[1] - s.cell.low[1]);
		if (dx * dx + dy * dy > 4) return;  // disks here have radii up to 0.5: this pair has long been apart
		const double r = std::hypot(dx, dy), overlap = a.radius + b.radius - r;
		if (overlap <= 0) {
			slips.erase({ i, j });
			return;
		}
		const double nx = dx / r, ny = dy / r, dvx = b.velocity[0] - a.velocity[0], dvy = b.velocity[1] - a.velocity[1];
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
double largest_difference(const Scene<2>& scene, A&& grain_a, B&& grain_b)
{
	const auto wrap = [](double d, bool periodic, double length) {
		return periodic ? d - length * std::nearbyint(d / length) : d;
	};
	double largest = 0;
	for (std::size_t i = 0; i < scene.grains.size(); ++i) {
		const Grain<2> a = grain_a(i), b = grain_b(i);
		for (const double d : { wrap(a.place[0] - b.place[0], scene.cell.periodic[0], scene.cell.high[0] - scene.cell.low[0]),
				 wrap(a.place[1] - b.place[1], scene.cell.periodic[1], scene.cell.high[1] - scene.cell.low[1]),
				 a.velocity[0] - b.velocity[0], a.velocity[1] - b.velocity[1], a.spin - b.spin })
			largest = std::max(largest, std::abs(d));
	}
	return largest;
}

/// True if every grain of two loops has the same bits.
inline bool same_bits(const Stepper<2>& a, const Stepper<2>& b)
{
	for (std::size_t i = 0; i < a.size(); ++i) {
		const Grain<2> one = a.grain(i), other = b.grain(i);
		if (one.place[0] != other.place[0] || one.place[1] != other.place[1] || one.velocity[0] != other.velocity[0] ||
			one.velocity[1] != other.velocity[1] || one.spin != other.spin)
			return false;
	}
	return a.size() == b.size();
}

}  // namespace graindrive::loop::test
