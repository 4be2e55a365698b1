/// Checks of a scene before it starts.
#include "engines/loop/guards.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

template <class... Words>
void require(bool holds, const Words&... words)
{
	if (!holds) throw std::invalid_argument(sentence(words...));
}

void check_grain(const Scene& scene, std::size_t i)
{
	const Grain& g = scene.grains[i];
	require(std::isfinite(g.x) && std::isfinite(g.y) && std::isfinite(g.vx) && std::isfinite(g.vy) && std::isfinite(g.spin),
		"position, velocity and spin must be finite, got a number that is not in grain ", i);
	require(g.radius > 0 && std::isfinite(g.radius), "radius must be positive, got ", g.radius, " in grain ", i);
	require(g.body >= free_grain && g.body < static_cast<int>(scene.bodies.size()), "a grain's body must be -1 (free) or one of ",
		scene.bodies.size(), " bodies, got ", g.body, " in grain ", i);
	require(g.mass > 0 && (g.body != free_grain || std::isfinite(g.mass)),
		"mass must be positive, and finite for a free grain, got ", g.mass, " in grain ", i);
}

void check_body(const RigidBody& body, std::size_t b)
{
	require(body.mass > 0 || !(body.responds_x || body.responds_y), "a body that responds to forces needs a positive mass, got ",
		body.mass, " in body ", b);
	require(body.inertia > 0 || !body.responds_spin, "a body that responds to torques needs a positive moment of inertia, got ",
		body.inertia, " in body ", b);
}

void check_side(bool periodic, double low, double high, const char* name)
{
	require(!periodic || (std::isfinite(low) && std::isfinite(high) && high > low), "a periodic box must have ", name,
		"_high above ", name, "_low, got ", low, " and ", high);
}

/// Leapfrog's limit of a damped oscillator.
double limit(double stiffness, double dashpot, double mass)
{
	const double omega = std::sqrt(stiffness / mass), zeta = dashpot / (2 * std::sqrt(stiffness * mass));
	return 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
}

struct Stiffness {
	double normal, tangential, normal_dashpot, tangential_dashpot;
};

struct StiffnessOf {
	double radius, mass, overlap;  // effective; overlap in length

	Stiffness operator()(const laws::HertzHistory<Real>& l) const
	{
		const double h = std::sqrt(radius * overlap);
		return { 1.5 * l.k_n * h, l.k_t * h, l.gamma_n * mass * h, l.gamma_t * mass * h };
	}
	Stiffness operator()(const laws::HertzRestitution<Real>& l) const
	{
		const double k = 4.0 / 3 * l.effective_young * std::sqrt(radius), root = std::sqrt(overlap), fourth = std::sqrt(root),
					 c = l.tangential_ratio;
		return { 1.5 * k * root, c * k * root, std::sqrt(5.0) * l.damping_fraction * std::sqrt(mass * k) * fourth,
			std::sqrt(10.0 / 3) * l.damping_fraction * std::sqrt(mass * c * k) * fourth };
	}
	Stiffness operator()(const laws::SpringDashpot<Real>& l) const
	{
		const double eta = l.damping * std::sqrt(mass);
		return { l.k_n, l.k_t, eta, eta };
	}
	Stiffness operator()(const laws::CundallStrack<Real>& l) const
	{
		const double k = 2 * l.young * radius;
		return { k, l.tangential_ratio * k, 0, 0 };
	}
	Stiffness operator()(const laws::HertzMindlin<Real>& l) const
	{
		const double h = std::sqrt(radius * overlap), dashpot = std::sqrt(mass * h);
		return { 2 * l.effective_young * h, 8 * l.effective_shear * h, l.normal_dashpot * dashpot,
			l.tangential_dashpot * dashpot };
	}
};

}  // namespace

void check_scene(const Scene& scene)
{
	require(!scene.grains.empty(), "a scene must have at least one grain, got none");
	require(scene.dt > 0 && std::isfinite(scene.dt), "time step must be positive, got ", scene.dt);
	require(scene.threads >= 1 && scene.threads <= 256, "threads must lie in 1..256, got ", scene.threads);
	require(scene.skin >= 0, "skin must not be negative (0 lets the loop choose), got ", scene.skin);
	require(scene.spin_response > 0, "m R^2/I of the grains must be positive, got ", scene.spin_response);
	require(scene.damping >= 0 && scene.damping < 1, "damping must lie in [0, 1), got ", scene.damping);
	check_side(scene.box.periodic_x, scene.box.x_low, scene.box.x_high, "x");
	check_side(scene.box.periodic_y, scene.box.y_low, scene.box.y_high, "y");
	for (std::size_t i = 0; i < scene.grains.size(); ++i) check_grain(scene, i);
	for (std::size_t b = 0; b < scene.bodies.size(); ++b) check_body(scene.bodies[b], b);
	const double critical = critical_time_step(scene);
	require(scene.dt <= critical, "time step must not exceed the critical one of the stiffest, lightest pair, ", critical,
		", got ", scene.dt, "; lower it or take softer grains");
}

double critical_time_step(const Scene& scene, double overlap)
{
	double smallest = HUGE_VAL;
	for (const Grain& g : scene.grains) {
		if (g.body != free_grain) continue;
		const double mass = g.mass / 2, depth = overlap * g.radius;
		const Stiffness k = std::visit(StiffnessOf{ g.radius / 2, mass, depth }, scene.law);
		smallest = std::min(smallest, limit(k.normal, k.normal_dashpot, mass));
		if (scene.friction && k.tangential > 0)
			smallest = std::min(smallest, limit(k.tangential, k.tangential_dashpot, mass / (1 + scene.spin_response)));
	}
	return smallest;
}

}  // namespace graindrive::loop
