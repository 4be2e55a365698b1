/// Checks of a scene before it starts.
#include "engines/loop/guards.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "engines/laws/critical_step.hpp"
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

laws::Terms<Real> terms_of(const ContactLaw& law, const laws::Squeezed<Real>& contact)
{
	return std::visit([&](const auto& l) { return l.terms(contact); }, law);
}

/// Of the contact's two directions, each with what yields in it; infinite where nothing does.
double critical_step_of(const Scene& scene, const laws::Terms<Real>& k, double inverse_pressed_mass, double inverse_sliding_mass)
{
	double smallest = HUGE_VAL;
	if (inverse_pressed_mass > 0) smallest = laws::critical_step(k.stiffness, k.dashpot, 1 / inverse_pressed_mass);
	if (inverse_sliding_mass > 0 && scene.friction && k.tangential_stiffness > 0)
		smallest =
			std::min(smallest, laws::critical_step(k.tangential_stiffness, k.tangential_dashpot, 1 / inverse_sliding_mass));
	return smallest;
}

/// What a member of a body may touch: a grain, or a member of another body.
struct Partner {
	double radius, inverse_mass;  // [m], [1/kg]
	double inverse_sliding_mass;  // of the surface, along the contact [1/kg]
	double inverse_pressed_mass;  // against the contact [1/kg]
};

/// A member's part in a contact: its body yields by moving and by turning, with a lever of at most its distance from the centre.
Partner as_partner(const RigidBody& body, const Grain& member)
{
	const double arm = std::hypot(member.x - body.x, member.y - body.y), reach = arm + member.radius;
	const double moving = (body.responds_x || body.responds_y) ? 1 / body.mass : 0,
				 turning = body.responds_spin ? 1 / body.inertia : 0;
	return { member.radius, std::isfinite(member.mass) ? 1 / member.mass : 0, moving + reach * reach * turning,
		moving + arm * arm * turning };
}

Partner as_partner(const Scene& scene, const Grain& grain)
{
	if (grain.body != free_grain) return as_partner(scene.bodies[grain.body], grain);
	const double spin_response = scene.rotation ? scene.spin_response : 0;
	return { grain.radius, 1 / grain.mass, (1 + spin_response) / grain.mass, 1 / grain.mass };
}

/// The grains that decide: the lightest and the largest free one, and the largest member of each body.
std::vector<std::size_t> telling_grains(const Scene& scene)
{
	constexpr std::size_t none = -1;
	std::size_t lightest = none, largest = none;
	std::vector<std::size_t> of_body(scene.bodies.size(), none), all;
	const auto larger = [&](std::size_t i, std::size_t than) {
		return than == none || scene.grains[i].radius > scene.grains[than].radius;
	};
	for (std::size_t i = 0; i < scene.grains.size(); ++i) {
		const Grain& g = scene.grains[i];
		if (g.body != free_grain) {
			if (larger(i, of_body[g.body])) of_body[g.body] = i;
			continue;
		}
		if (lightest == none || g.mass < scene.grains[lightest].mass) lightest = i;
		if (larger(i, largest)) largest = i;
	}
	for (const std::size_t i : { lightest, largest })
		if (i != none) all.push_back(i);
	for (const std::size_t i : of_body)
		if (i != none) all.push_back(i);
	return all;
}

double critical_step_of(const Scene& scene, const Partner& one, const Partner& other, double overlap)
{
	const double depth = overlap * std::min(one.radius, other.radius);
	const laws::Terms<Real> terms = terms_of(scene.law,
		{ depth, laws::effective_radius(one.radius, other.radius), laws::effective_mass(one.inverse_mass + other.inverse_mass) });
	return critical_step_of(scene, terms, one.inverse_pressed_mass + other.inverse_pressed_mass,
		one.inverse_sliding_mass + other.inverse_sliding_mass);
}

/// A pair is met through one image: the nearest. Where a second image could touch as well, a contact would be lost.
void check_images(const Scene& scene)
{
	const std::vector<std::size_t> telling = telling_grains(scene);
	const auto check = [&](bool periodic, double length, const char* axis) {
		if (!periodic) return;
		for (std::size_t i = 0; i < scene.grains.size(); ++i) {
			const Grain& member = scene.grains[i];
			if (member.body == free_grain) continue;
			for (const std::size_t j : telling) {
				const Grain& other = scene.grains[j];
				if (other.body == member.body) continue;
				if (other.body != free_grain && scene.bodies[other.body].frozen && scene.bodies[member.body].frozen) continue;
				require(2 * (member.radius + other.radius) <= length,
					"a disk of a body must not touch another disk through two of "
					"its images: the period in ",
					axis, " must be at least ", 2 * (member.radius + other.radius), " m, got ", length,
					"; lengthen it, or make the body of smaller disks (grain ", i, ")");
			}
		}
	};
	check(scene.box.periodic_x, scene.box.x_high - scene.box.x_low, "x");
	check(scene.box.periodic_y, scene.box.y_high - scene.box.y_low, "y");
}

}  // namespace

double critical_time_step_of_bodies(const Scene& scene, double overlap)
{
	double smallest = HUGE_VAL;
	const std::vector<std::size_t> telling = telling_grains(scene);
	for (const Grain& member : scene.grains) {
		if (member.body == free_grain) continue;
		const Partner one = as_partner(scene.bodies[member.body], member);
		if (one.inverse_sliding_mass == 0) continue;  // it yields to nothing
		for (const std::size_t other : telling)
			if (scene.grains[other].body != member.body)
				smallest = std::min(smallest, critical_step_of(scene, one, as_partner(scene, scene.grains[other]), overlap));
	}
	return smallest;
}

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
	laws::require_in_range(scene.law);
	const double critical = critical_time_step(scene);
	require(scene.dt <= critical, "time step must not exceed the critical one of the stiffest, lightest pair, ", critical,
		", got ", scene.dt, "; lower it or take softer grains");
	const double of_bodies = critical_time_step_of_bodies(scene);
	require(scene.dt <= of_bodies,
		"time step must not exceed the critical one of the lightest body (clump, large, watched or driven "
		"disk) at its stiffest contact, ",
		of_bodies, ", got ", scene.dt, "; lower it, take softer grains, or give the body more mass and inertia");
	check_images(scene);
}

double critical_time_step(const Scene& scene, double overlap)
{
	double smallest = HUGE_VAL;
	for (const Grain& g : scene.grains) {
		if (g.body != free_grain) continue;
		const double mass = g.mass / 2;
		const laws::Terms<Real> terms = terms_of(scene.law, { overlap * g.radius, g.radius / 2, mass });
		smallest = std::min(smallest, critical_step_of(scene, terms, 1 / mass, (1 + scene.spin_response) / mass));
	}
	return smallest;
}

}  // namespace graindrive::loop
