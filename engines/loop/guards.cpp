/// Checks of a scene before it starts.
#include "engines/loop/guards.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "engines/laws/critical_step.hpp"
#include "engines/laws/sphere_terms.hpp"
#include "engines/loop/pair_geometry.hpp"

namespace graindrive::loop {

namespace {

template <class... Words>
void require(bool holds, const Words&... words)
{
	if (!holds) throw std::invalid_argument(sentence(words...));
}

bool is_finite(double number) { return std::isfinite(number); }
bool is_finite(const Vec<3>& v) { return geometry::is_finite(v); }

template <int D>
void check_grain(const Scene<D>& scene, std::size_t i)
{
	const Grain<D>& g = scene.grains[i];
	require(geometry::is_finite(g.place) && geometry::is_finite(g.velocity) && is_finite(g.spin),
		"position, velocity and spin must be finite, got a number that is not in grain ", i);
	require(g.radius > 0 && std::isfinite(g.radius), "radius must be positive, got ", g.radius, " in grain ", i);
	require(g.body >= free_grain && g.body < static_cast<int>(scene.bodies.size()), "a grain's body must be -1 (free) or one of ",
		scene.bodies.size(), " bodies, got ", g.body, " in grain ", i);
	require(g.mass > 0 && (g.body != free_grain || std::isfinite(g.mass)),
		"mass must be positive, and finite for a free grain, got ", g.mass, " in grain ", i);
}

/// In space the equations of motion cover bodies that turn about all axes, one or none; two axes only if the three moments are
/// equal.
void check_turning(const RigidBody<2>&, std::size_t) {}
void check_turning(const RigidBody<3>& body, std::size_t b)
{
	const int free = body.turns[0] + body.turns[1] + body.turns[2];
	const Vec<3>& i = body.inertia;
	require(free != 2 || (i[0] == i[1] && i[1] == i[2]),
		"a body with different moments of inertia must be free to turn about all axes, one or none, got two in body ", b,
		"; block one more rotation, or none");
}

template <int D>
void check_body(const RigidBody<D>& body, std::size_t b)
{
	require(body.mass > 0 || !body.responds_somewhere(), "a body that responds to forces needs a positive mass, got ", body.mass,
		" in body ", b);
	require(!body.turns_somewhere() || is_positive(body.inertia),
		"a body that responds to torques needs a positive moment of inertia, got one that is not in body ", b);
	check_turning(body, b);
}

template <int D>
void check_solid(const Scene<D>& scene, const Solid<D>& solid)
{
	require(solid.shape != nullptr, "a solid needs a surface, got none");
	require(solid.body >= 0 && solid.body < int(scene.bodies.size()), "a solid belongs to one of ", scene.bodies.size(),
		" bodies, got ", solid.body);
}

template <int D>
void check_side(const Cell<D>& cell, int k)
{
	const char name = "xyz"[k];
	require(!cell.periodic[k] || (std::isfinite(cell.low[k]) && std::isfinite(cell.high[k]) && cell.high[k] > cell.low[k]),
		"a periodic box must have ", name, "_high above ", name, "_low, got ", cell.low[k], " and ", cell.high[k]);
}

laws::Terms<Real> terms_of(const ContactLaw& law, const laws::Squeezed<Real>& contact)
{
	return std::visit([&](const auto& l) { return l.terms(contact); }, law);
}

/// The smaller of the critical steps along and across the contact, with the inverse mass that responds in each direction;
/// infinite where nothing responds.
template <int D>
double critical_step_of(
	const Scene<D>& scene, const laws::Terms<Real>& k, double inverse_pressed_mass, double inverse_sliding_mass)
{
	double smallest = HUGE_VAL;
	if (inverse_pressed_mass > 0) smallest = laws::critical_step(k.stiffness, k.dashpot, 1 / inverse_pressed_mass);
	if (inverse_sliding_mass > 0 && scene.friction && k.tangential_stiffness > 0)
		smallest =
			std::min(smallest, laws::critical_step(k.tangential_stiffness, k.tangential_dashpot, 1 / inverse_sliding_mass));
	return smallest;
}

/// One side of a contact, as the critical step needs it: a grain, a member of a body, or a solid.
struct Yielding {
	double radius, inverse_mass;  // [m], [1/kg]
	double inverse_sliding_mass;  // of the surface, along the contact [1/kg]
	double inverse_pressed_mass;  // against the contact [1/kg]
};

double smallest_moment(double inertia) { return inertia; }
double smallest_moment(const Vec<3>& i) { return std::min({ i[0], i[1], i[2] }); }

/// A body responds by translation and by rotation; the lever is at most the distance of its farthest point from the centre.
template <int D>
Yielding yielding(const RigidBody<D>& body, double arm, double radius, double inverse_mass)
{
	const double reach = arm + radius;
	const double moving = body.responds_somewhere() ? 1 / body.mass : 0,
				 turning = body.turns_somewhere() ? 1 / smallest_moment(body.inertia) : 0;
	return { radius, inverse_mass, moving + reach * reach * turning, moving + arm * arm * turning };
}

template <int D>
Yielding yielding(const Scene<D>& scene, const Grain<D>& grain)
{
	if (grain.body != free_grain) {
		const RigidBody<D>& body = scene.bodies[grain.body];
		return yielding(body, length(grain.place - body.place), grain.radius, std::isfinite(grain.mass) ? 1 / grain.mass : 0);
	}
	const double spin_response = scene.rotation ? scene.spin_response : 0;
	return { grain.radius, 1 / grain.mass, (1 + spin_response) / grain.mass, 1 / grain.mass };
}

/// The surface of a solid counts as a plane, whose radius is given as 0.
template <int D>
Yielding yielding(const Scene<D>& scene, const Solid<D>& solid)
{
	const RigidBody<D>& body = scene.bodies[solid.body];
	const geometry::Bounds<D> box = solid.shape->bounds();
	double far = 0, farthest_grain = 0;
	for (int k = 0; k < D; ++k) far = std::hypot(far, std::max(std::abs(box.low[k]), std::abs(box.high[k])));
	for (const Grain<D>& grain : scene.grains)
		farthest_grain = std::max(farthest_grain, length(grain.place - body.place) + grain.radius);
	return yielding(body, std::min(far, farthest_grain), 0, body.responds_somewhere() ? 1 / body.mass : 0);
}

/// The grains that decide the checks: the lightest and the largest free one, and the largest member of each body.
template <int D>
std::vector<std::size_t> telling_grains(const Scene<D>& scene)
{
	constexpr std::size_t none = -1;
	std::size_t lightest = none, largest = none;
	std::vector<std::size_t> of_body(scene.bodies.size(), none), all;
	const auto larger = [&](std::size_t i, std::size_t than) {
		return than == none || scene.grains[i].radius > scene.grains[than].radius;
	};
	for (std::size_t i = 0; i < scene.grains.size(); ++i) {
		const Grain<D>& g = scene.grains[i];
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

template <int D>
double critical_step_of(const Scene<D>& scene, const Yielding& one, const Yielding& other, double overlap)
{
	const bool plane = one.radius == 0 || other.radius == 0;
	const double depth = overlap * (plane ? std::max(one.radius, other.radius) : std::min(one.radius, other.radius)),
				 radius = plane ? std::max(one.radius, other.radius) : laws::effective_radius(one.radius, other.radius);
	const laws::Terms<Real> terms =
		terms_of(scene.law, { depth, radius, laws::effective_mass(one.inverse_mass + other.inverse_mass) });
	return critical_step_of(scene, terms, one.inverse_pressed_mass + other.inverse_pressed_mass,
		one.inverse_sliding_mass + other.inverse_sliding_mass);
}

/// Refuses a period in which two images of one grain could touch the same body, because only the contact with the nearest is
/// computed.
template <int D>
void check_images(const Scene<D>& scene)
{
	const std::vector<std::size_t> telling = telling_grains(scene);
	const char* grain = D == 2 ? "disk" : "sphere";
	for (int k = 0; k < D; ++k) {
		if (!scene.cell.periodic[k]) continue;
		const double period = scene.cell.length(k);
		for (std::size_t i = 0; i < scene.grains.size(); ++i) {
			const Grain<D>& member = scene.grains[i];
			if (member.body == free_grain) continue;
			for (const std::size_t j : telling) {
				const Grain<D>& other = scene.grains[j];
				if (other.body == member.body) continue;
				if (other.body != free_grain && scene.bodies[other.body].frozen && scene.bodies[member.body].frozen) continue;
				require(2 * (member.radius + other.radius) <= period, "a ", grain, " of a body must not touch another ", grain,
					" through two of its images: the period in ", "xyz"[k], " must be at least ",
					2 * (member.radius + other.radius), " m, got ", period, "; lengthen it, or make the body of smaller ", grain,
					"s (grain ", i, ")");
			}
		}
	}
}

/// Checks what differs between disks and spheres: sheared cells, laws and damping.
void check_dimension(const Scene<2>& scene)
{
	if (!scene.cell.sheared()) return;
	scene.cell.check();
	require(scene.cell.across == 1 && scene.cell.along == 0,
		"a sheared cell of disks flows along x and is sheared across y, got the axes ", scene.cell.along, " and ",
		scene.cell.across, "; turn the scene");
	require(scene.bodies.empty(), "a sheared cell may hold only free disks, got ", scene.bodies.size(),
		" bodies (clumps, solids, disks that are driven, blocked, large or watched); take them out, or use YADE's own loop");
	require(scene.walls.empty(), "a sheared cell must have no walls, got ", scene.walls.size(), "; remove them");
	require(scene.damping == 0, "non-viscous damping is not defined relative to a mean flow, got damping ", scene.damping,
		" in a sheared cell; set it to 0, or use YADE's own loop");
}
void check_dimension(const Scene<3>& scene)
{
	require(std::visit([](const auto& law) { return laws::is_for_spheres(law); }, scene.law),
		"the loop over spheres has only the laws ", laws::listed(laws::names_where(laws::is_for_spheres), " and "), ", got ",
		laws::name_of(scene.law), "; take one of those, or YADE's own loop");
	require(scene.damping == 0, "the loop over spheres has no non-viscous damping, got damping ", scene.damping,
		"; set it to 0, or use YADE's own loop");
	require(
		!scene.cell.sheared(), "the loop over spheres has no sheared cell, got a sheared one; set across to -1, or use disks");
	require(scene.grains.size() < 30'000'000, "a scene may have at most 30 million spheres, got ", scene.grains.size());
}

}  // namespace

template <int D>
double critical_time_step_of_bodies(const Scene<D>& scene, double overlap)
{
	double smallest = HUGE_VAL;
	const std::vector<std::size_t> telling = telling_grains(scene);
	const auto meet_all = [&](const Yielding& one, int body) {
		if (one.inverse_sliding_mass == 0) return;  // it does not respond to forces
		for (const std::size_t other : telling)
			if (scene.grains[other].body != body)
				smallest = std::min(smallest, critical_step_of(scene, one, yielding(scene, scene.grains[other]), overlap));
	};
	for (const Grain<D>& member : scene.grains)
		if (member.body != free_grain) meet_all(yielding(scene, member), member.body);
	for (const Solid<D>& solid : scene.solids) meet_all(yielding(scene, solid), solid.body);
	return smallest;
}

template <int D>
void check_scene(const Scene<D>& scene, double overlap)
{
	require(!scene.grains.empty(), "a scene must have at least one grain, got none");
	require(scene.dt > 0 && std::isfinite(scene.dt), "time step must be positive, got ", scene.dt);
	require(scene.threads >= 1 && scene.threads <= 256, "threads must lie in 1..256, got ", scene.threads);
	require(scene.skin >= 0, "skin must not be negative (0: the loop chooses it), got ", scene.skin);
	require(scene.spin_response > 0, "m R^2/I of the grains must be positive, got ", scene.spin_response);
	require(scene.damping >= 0 && scene.damping < 1, "damping must lie in [0, 1), got ", scene.damping);
	require(geometry::is_finite(scene.gravity), "gravity must be finite, got a number that is not");
	for (int k = 0; k < D; ++k) check_side(scene.cell, k);
	check_dimension(scene);
	for (std::size_t i = 0; i < scene.grains.size(); ++i) check_grain(scene, i);
	for (std::size_t b = 0; b < scene.bodies.size(); ++b) check_body(scene.bodies[b], b);
	for (const Solid<D>& solid : scene.solids) check_solid(scene, solid);
	laws::require_in_range(scene.law);
	const double critical = critical_time_step(scene, overlap);
	require(scene.dt <= critical, "time step must not exceed the critical one of the stiffest, lightest pair, ", critical,
		", at the largest allowed overlap of ", overlap, " R, got ", scene.dt, "; lower it or take softer grains");
	const double of_bodies = critical_time_step_of_bodies(scene, overlap);
	require(scene.dt <= of_bodies,
		"time step must not exceed the critical one of the lightest body (clump, large, watched or driven ",
		D == 2 ? "disk" : "sphere, solid", ") at its stiffest contact, ", of_bodies, ", got ", scene.dt,
		"; lower it, take softer grains, or give the body more mass and inertia");
	check_images(scene);
}

template <int D>
double critical_time_step(const Scene<D>& scene, double overlap)
{
	double smallest = HUGE_VAL;
	for (const Grain<D>& g : scene.grains) {
		if (g.body != free_grain) continue;
		const double mass = g.mass / 2;
		const laws::Terms<Real> terms = terms_of(scene.law, { overlap * g.radius, g.radius / 2, mass });
		smallest = std::min(smallest, critical_step_of(scene, terms, 1 / mass, (1 + scene.spin_response) / mass));
	}
	return smallest;
}

template double critical_time_step(const Scene<2>&, double);
template double critical_time_step(const Scene<3>&, double);
template double critical_time_step_of_bodies(const Scene<2>&, double);
template double critical_time_step_of_bodies(const Scene<3>&, double);
template void check_scene(const Scene<2>&, double);
template void check_scene(const Scene<3>&, double);

}  // namespace graindrive::loop
