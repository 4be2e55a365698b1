/// Disks and spheres at solids: depth at rest, impacts against Hertz's equations, solids that turn or are free, images, refusals.
#include <gtest/gtest.h>

#include <array>

#include "engines/base/complaint.hpp"
#include "engines/geometry/outline_surface.hpp"
#include "engines/geometry/set_algebra.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/loop/stepper.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using geometry::Ball;
using geometry::Complement;
using geometry::Cylinder;
using geometry::HalfSpace;
using geometry::norm;
using geometry::OutlineSurface;
using geometry::shared;
using geometry::SharedSurface;

namespace {

constexpr double radius = 0.5;

template <int D>
Grain<D> grain_at(const Vec<D>& place)
{
	Grain<D> g;
	g.place = place, g.radius = radius, g.mass = D == 2 ? pi * radius * radius : 4 * pi / 3 * radius * radius * radius;
	return g;
}

template <int D>
Scene<D> scene_of(const Grain<D>& grain, const SharedSurface<D>& shape, const RigidBody<D>& body = {})
{
	Scene<D> s;
	s.grains = { grain };
	s.bodies = { body };
	s.solids = { { 0, shape, "" } };
	s.law = laws::hertz_restitution(2e4, 0.3, 0.3, 0.5);
	s.dt = 1e-4;
	return s;
}

/// The overlap delta from m g = 4/3 E_eff sqrt(R) delta^(3/2), E_eff = E/(2 (1 - nu^2)).
double depth_at_rest(double weight) { return std::pow(weight / (4.0 / 3 * 2e4 / (2 * 0.91) * std::sqrt(radius)), 2.0 / 3); }

/// Lets a grain that begins at the surface come to rest, and returns its overlap.
template <int D>
double depth_of_rest(const SharedSurface<D>& shape, const Vec<D>& surface, const Vec<D>& outward)
{
	Scene<D> s = scene_of(grain_at<D>(surface + radius * outward), shape);
	s.gravity = -1.0 * outward;
	Stepper<D> loop(s);
	loop.step(40000);
	const auto contacts = loop.surface_contacts();
	EXPECT_EQ(contacts.size(), 1u);
	EXPECT_NEAR(loop.bodies()[0].force[0], s.grains[0].mass * s.gravity[0], 1e-10);
	EXPECT_LT(norm(loop.grain(0).velocity), 1e-11);
	return contacts.empty() ? 0 : contacts[0].overlap;
}

template <int D>
RigidBody<D> free_body(double mass, const Spin<D>& inertia)
{
	RigidBody<D> body;
	body.mass = mass, body.inertia = inertia;
	body.responds.fill(true), body.turns.fill(true);
	return body;
}

/// Momentum, and angular momentum about the origin.
template <int D>
struct Totals {
	Vec<D> momentum;
	Spin<D> angular{};
};

template <int D>
Totals<D> totals(Stepper<D>& loop)
{
	const Grain<D> g = loop.grain(0);
	const RigidBody<D>& b = loop.bodies()[0];
	const double own = g.mass * g.radius * g.radius / loop.settings().spin_response;
	Totals<D> sum{ g.mass * g.velocity + b.mass * b.velocity };
	sum.angular = g.mass * cross(g.place, g.velocity) + own * g.spin + b.mass * cross(b.place, b.velocity);
	if constexpr (D == 2)
		sum.angular += b.inertia * b.spin;
	else
		sum.angular += b.inertia[0] * b.spin;  // moment of inertia of a ball
	return sum;
}

/// A grain hits a free solid away from its middle. Momentum is conserved, angular momentum changes by the torque delta/2 n x F_t,
/// because forces on the two act at points half an overlap apart.
template <int D>
void meet_free(const SharedSurface<D>& shape, Grain<D> grain, const RigidBody<D>& body)
{
	Scene<D> s = scene_of(grain, shape, body);
	s.law = laws::hertz_restitution(2e4, 0.3, 0.8, 0.4);
	Stepper<D> loop(s);
	const Totals<D> before = totals(loop);
	Spin<D> by_overlap{};
	for (int k = 0; k < 4000; ++k) {
		loop.step();
		for (const Contact<D>& c : loop.surface_contacts()) by_overlap += s.dt * c.overlap / 2 * turning(c.n, c.friction);
	}
	const Totals<D> after = totals(loop);
	EXPECT_GT(norm(loop.bodies()[0].velocity - body.velocity), 0.1);
	EXPECT_GT(length(by_overlap), 1e-6);
	// Some thousand steps with round-offs of 1e-16 in numbers of order 1.
	EXPECT_LT(norm(after.momentum - before.momentum), 1e-12);
	EXPECT_LT(length(after.angular - before.angular - by_overlap), 1e-12);
}

constexpr double k_n = 2e5, k_t = 2.46e5;

/// Overlap, spring, velocity into the surface, tangential velocity of the grain's surface against it.
using Impact = std::array<double, 4>;

/// Equations of motion without damping and slip:
/// m d2(delta)/dt2 = -k_n sqrt(R) delta^(3/2),  m/(1 + m R^2/I) dv_t/dt = -k_t sqrt(R delta) s,  ds/dt = v_t.
Impact slope(const Impact& y, double mass, double spin_response)
{
	const double hertz = std::sqrt(radius * std::max(y[0], 0.0));
	return { y[2], y[3], -k_n * hertz * y[0] / mass, -(1 + spin_response) * k_t * hertz * y[1] / mass };
}

Impact integrated(Impact y, double time, double mass, double spin_response)
{
	const int steps = 20000;
	const double h = time / steps;
	const auto moved = [](const Impact& from, const Impact& by, double how_far) {
		Impact to = from;
		for (int k = 0; k < 4; ++k) to[k] += how_far * by[k];
		return to;
	};
	for (int n = 0; n < steps; ++n) {
		const auto f = [&](const Impact& at) { return slope(at, mass, spin_response); };
		const Impact a = f(y), b = f(moved(y, a, h / 2)), c = f(moved(y, b, h / 2)), d = f(moved(y, c, h));
		for (int k = 0; k < 4; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
	}
	return y;
}

/// A spinning sphere that touches an oblique plane at time 0, with an oblique velocity.
Scene<3> oblique_impact(double mu, const Vec<3>& n)
{
	Scene<3> s = scene_of<3>(grain_at<3>((radius + 1e-13) * n), shared(HalfSpace<3>({}, n)));
	s.law = laws::HertzHistory<Real>{ k_n, k_t, 0, 0, mu };
	s.grains[0].velocity = Vec<3>{ 0.3, -0.2, 0.4 } - 1.5 * n;
	s.grains[0].spin = { 0.5, 1, -0.4 };
	return s;
}

Vec<3> tangential_part(const Vec<3>& v, const Vec<3>& n) { return v - dot(v, n) * n; }

}  // namespace

TEST(Surfaces, a_sphere_at_rest_sinks_as_deep_as_hertz_says)
{
	const Grain<3> g = grain_at<3>({});
	const double depth = depth_at_rest(g.mass);
	const Vec<3> up{ 0, 0, 1 }, oblique = geometry::unit(Vec<3>{ 1, 2, 2 });
	// Damped for four seconds at a rate of ten per second; the rest is round-off of coordinates of order 1.
	EXPECT_NEAR(depth_of_rest<3>(shared(HalfSpace<3>({ 1, 1, 1 }, oblique)), { 1, 1, 1 }, oblique), depth, 1e-13);
	const auto cylinder = shared(Cylinder({ 0, 0, 0 }, { 0, 1, 0 }, 3));
	EXPECT_NEAR(depth_of_rest<3>(cylinder, { 0, 0.4, 3 }, up), depth, 1e-13);
	EXPECT_NEAR(depth_of_rest<3>(shared(Complement<3>(cylinder)), { 0, 0.4, -3 }, up), depth, 1e-13);
	EXPECT_NEAR(depth_of_rest<3>(shared(Ball<3>({ 0, 0, 0 }, 2)), { 0, 0, 2 }, up), depth, 1e-13);
}

TEST(Surfaces, a_disk_at_rest_sinks_as_deep_as_hertz_says)
{
	const double depth = depth_at_rest(grain_at<2>({}).mass);
	const Vec<2> up{ 0, 1 }, oblique = geometry::unit(Vec<2>{ 3, 4 });
	EXPECT_NEAR(depth_of_rest<2>(shared(HalfSpace<2>({ 1, 1 }, oblique)), { 1, 1 }, oblique), depth, 1e-13);
	EXPECT_NEAR(depth_of_rest<2>(shared(Ball<2>({ 0, 0 }, 2)), { 0, 2 }, up), depth, 1e-13);
	const auto square = shared(OutlineSurface({ { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } }));
	EXPECT_NEAR(depth_of_rest<2>(square, { 0.3, 1 }, up), depth, 1e-13);
	const auto edge = shared(OutlineSurface({ { -1, -1 }, { 1, -1 }, { 0, 0 } }));
	EXPECT_NEAR(depth_of_rest<2>(edge, { 0, 0 }, up), depth, 1e-13);  // on its tip
}

TEST(Surfaces, an_oblique_impact_of_a_spinning_sphere_follows_the_equations_of_motion)
{
	const Vec<3> n = geometry::unit(Vec<3>{ 1, -2, 2 });
	Scene<3> s = oblique_impact(10, n);  // so much friction that the contact sticks
	s.dt = 5e-7;
	const Grain<3> start = s.grains[0];
	const Vec<3> v_t = tangential_part(start.velocity, n) + cross(radius * start.spin, -1.0 * n);
	for (const int steps : { 8000, 26000 }) {  // before and after the deepest point at 10 ms
		Stepper<3> loop(s);
		loop.begin_on_step();
		loop.step(steps - 1);
		const Grain<3> at = loop.grain(0);
		loop.step();
		const Vec<3> velocity = 0.5 * (at.velocity + loop.grain(0).velocity), spin = 0.5 * (at.spin + loop.grain(0).spin);
		const Impact end = integrated({ 0, 0, -dot(start.velocity, n), norm(v_t) }, steps * s.dt, start.mass, 2.5);
		const Vec<3> along = v_t / norm(v_t), change = (end[3] - norm(v_t)) / 3.5 * along;
		// Leapfrog's error is (omega dt)^2/24 = 4e-10 of velocities of order 1, with omega = 186/s; that of spins is five times
		// as large.
		EXPECT_NEAR(radius - dot(at.place, n), end[0], 1e-9);
		EXPECT_LT(norm(velocity - (tangential_part(start.velocity, n) + change - end[2] * n)), 2e-9);
		EXPECT_LT(norm(spin - (start.spin + 2.5 / radius * cross(change, n))), 1e-8) << steps;
	}
}

TEST(Surfaces, a_sphere_that_slides_all_through_an_impact_changes_as_walton_says)
{
	const double mu = 0.05;
	const Vec<3> n = geometry::unit(Vec<3>{ 1, -2, 2 });
	Scene<3> s = oblique_impact(mu, n);
	s.grains[0].velocity += 6 * geometry::unit(cross(n, Vec<3>{ 0, 0, 1 }));
	s.dt = 1e-5;
	const Grain<3> start = s.grains[0];
	const Vec<3> v_t = tangential_part(start.velocity, n) + cross(radius * start.spin, -1.0 * n);
	Stepper<3> loop(s);
	double normal_impulse = 0;
	for (int k = 0; k < 3000; ++k) {
		loop.step();
		for (const Contact<3>& c : loop.surface_contacts()) {
			EXPECT_TRUE(c.slipping) << k;
			normal_impulse += c.normal * s.dt;
		}
	}
	const Grain<3> end = loop.grain(0);
	EXPECT_NEAR(dot(end.velocity, n), -dot(start.velocity, n), 1e-4);  // e = 1, to (omega dt)^2 = 4e-6
	// Walton (1993): the tangential impulse is mu times the normal one, opposite to the slip.
	const Vec<3> kick = -mu * normal_impulse / start.mass * (v_t / norm(v_t));
	EXPECT_LT(norm(tangential_part(end.velocity - start.velocity, n) - kick), 1e-12);
	EXPECT_LT(norm(end.spin - start.spin - 2.5 / radius * cross(kick, n)), 1e-11);
}

TEST(Surfaces, a_moving_plane_drags_a_sphere_along_until_it_rolls_at_two_sevenths)
{
	RigidBody<3> belt;
	belt.velocity = { 0.6, 0.8, 0 };
	Scene<3> s = scene_of<3>(grain_at<3>({ 0, 0, 0.4995 }), shared(HalfSpace<3>({}, { 0, 0, 1 })), belt);
	s.gravity = { 0, 0, -10 };
	Stepper<3> loop(s);
	loop.step(30000);
	// Angular momentum about the line of contact is conserved except for the torque of the overlap, whose lever is a hundredth of
	// a radius at most.
	EXPECT_LT(norm(loop.grain(0).velocity - 2.0 / 7 * belt.velocity), 5e-3);
	const Vec<3> rolling = belt.velocity - tangential_part(loop.grain(0).velocity, { 0, 0, 1 });
	EXPECT_LT(norm(cross(loop.grain(0).spin, Vec<3>{ 0, 0, -radius }) - rolling), 1e-6);
}

TEST(Surfaces, two_cylinders_that_spin_turn_the_sphere_between_them)
{
	// A sphere in the groove between two equal rollers ends up turning in the opposite sense with the surface speed of the
	// rollers.
	Scene<3> s = scene_of<3>(grain_at<3>({ 0, 0, 1.13 }), shared(Cylinder({}, { 0, 1, 0 }, 1.0)));
	s.bodies[0].place = { -1.01, 0, 0 }, s.bodies[0].spin = { 0, 0.7, 0 };
	s.bodies.push_back(s.bodies[0]);
	s.bodies[1].place = { 1.01, 0, 0 };
	s.solids.push_back({ 1, s.solids[0].shape, "" });
	s.gravity = { 0, 0, -1 };
	s.law = laws::hertz_restitution(2e4, 0.3, 0.3, 0.2);
	Stepper<3> loop(s);
	loop.step(200000);
	const Grain<3> g = loop.grain(0);
	const double depth = loop.surface_contacts()[0].overlap / 2;  // depth of the point whose velocity is used
	EXPECT_NEAR(g.spin[1], -0.7 * (1 - depth) / radius, 1e-9);
	EXPECT_LT(norm(g.velocity), 1e-9);
	EXPECT_NEAR(g.place[0], 0, 1e-9);
	EXPECT_NEAR(loop.bodies()[0].force[2] + loop.bodies()[1].force[2], -g.mass, 1e-9);
}

TEST(Surfaces, a_sphere_and_a_free_ball_keep_their_momentum)
{
	Grain<3> g = grain_at<3>({ -0.5, 0.3, 1.35 });
	g.velocity = { 0.2, -0.1, -1 }, g.spin = { 1, 2, -1 };
	RigidBody<3> ball = free_body<3>(2, { 0.8, 0.8, 0.8 });
	ball.velocity = { -0.1, 0, 0.2 }, ball.spin = { 0.5, -1, 2 };
	meet_free<3>(shared(Ball<3>({}, 1)), g, ball);
}

TEST(Surfaces, a_disk_and_a_free_ball_or_square_keep_their_momentum)
{
	Grain<2> g = grain_at<2>({ -0.7, 1.55 });
	g.velocity = { 0.2, -1 }, g.spin = 2;
	RigidBody<2> body = free_body<2>(2, 0.8);
	body.velocity = { -0.1, 0.2 }, body.spin = 1, body.turn.angle = 0.3;
	meet_free<2>(shared(OutlineSurface({ { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } })), g, body);
	g.place = { -0.5, 1.45 };
	meet_free<2>(shared(Ball<2>({}, 1)), g, body);
}

TEST(Surfaces, what_touches_a_solid_adds_up_to_its_force_and_torque_and_asking_changes_no_bit)
{
	Grain<3> g = grain_at<3>({ -0.5, 0.3, 1.39 });
	g.velocity = { 0.2, -0.1, -1 }, g.spin = { 1, 2, -1 };
	Scene<3> s = scene_of<3>(g, shared(Ball<3>({}, 1)), free_body<3>(2, { 0.8, 0.8, 0.8 }));
	Stepper<3> asked(s), straight(s);
	int touched = 0;
	for (int k = 0; k < 1500; ++k) {
		asked.compute_body_forces();
		std::vector<Touch<3>> touches;
		asked.touches_on(0, touches);
		Vec<3> force, torque;
		for (const Touch<3>& t : touches) {
			const Vec<3> by = force_on_first(t.n, t.normal, t.friction);
			force += by, torque += cross(t.arm, by), ++touched;
		}
		ASSERT_LT(norm(force - asked.bodies()[0].force), 1e-12 * (1 + norm(force)));
		ASSERT_LT(norm(torque - asked.bodies()[0].torque), 1e-12 * (1 + norm(torque)));
		asked.step(), straight.step();
		ASSERT_EQ(asked.bodies()[0].spin, straight.bodies()[0].spin) << k;
		ASSERT_EQ(asked.grain(0).velocity, straight.grain(0).velocity) << k;
	}
	EXPECT_GT(touched, 100);
}

TEST(Surfaces, a_solid_in_a_periodic_cell_meets_the_nearest_image)
{
	const auto run = [](double shift) {
		Grain<3> g = grain_at<3>({ 6.45 + shift, 2, 0.3 });
		g.velocity = { -1, 0.2, 0 };
		RigidBody<3> ball = free_body<3>(2, { 0.8, 0.8, 0.8 });
		ball.place = { 5 + shift, 2, 0 };
		Scene<3> s = scene_of<3>(g, shared(Ball<3>({}, 1)), ball);
		s.cell.high = { 6, 6, 0 };
		s.cell.periodic[0] = s.cell.periodic[1] = true;
		Stepper<3> loop(s);
		loop.step(3000);
		return std::array<Vec<3>, 4>{ loop.grain(0).velocity, loop.grain(0).spin, loop.bodies()[0].velocity,
			loop.bodies()[0].spin };
	};
	const auto across = run(0), inside = run(-3), behind = run(12);
	EXPECT_GT(across[0][0], 0);  // it bounced
	for (int k = 0; k < 4; ++k) {
		EXPECT_LT(norm(across[k] - inside[k]), 1e-10);  // round-off of coordinates of order 10 in forces of order 1e4
		EXPECT_LT(norm(across[k] - behind[k]), 1e-10);
	}
}

/// The push alone would move the sphere by 2e-4 d a step, but the plane holds it. It does not move, so the selection of pairs
/// stays valid.
TEST(Surfaces, a_sphere_that_is_pressed_on_a_plane_counts_as_at_rest)
{
	Scene<3> s = scene_of<3>(grain_at<3>({ 0, 0, radius }), shared(HalfSpace<3>({}, { 0, 0, 1 })));
	s.bodies[0].frozen = true;
	s.dt = 1e-3;
	Stepper<3> loop(s);
	loop.step(1);
	for (int k = 0; k < 20000; ++k) {  // lowers the sphere so slowly that it does not bounce
		loop.set_pushes({ { 0, { 0, 0, -100 * std::min(1.0, k / 10000.0) }, {} } });
		loop.step(1);
	}
	const long before = loop.selections_done();
	loop.step(2000);
	EXPECT_LE(loop.selections_done() - before, 100);
}

TEST(Surfaces, scenes_that_cannot_be_run_are_refused)
{
	const auto refused = [](const char* words, auto&& change) {
		Scene<3> s = scene_of<3>(grain_at<3>({ 0, 0, 2 }), shared(Ball<3>({}, 1)));
		change(s);
		const std::string said = complaint([&] { Stepper<3> loop(s); });
		EXPECT_TRUE(mentions(said, words)) << words << ": " << said;
	};
	refused("a solid needs a surface, got none", [](Scene<3>& s) { s.solids[0].shape = nullptr; });
	refused("a solid belongs to one of 1 bodies, got 1", [](Scene<3>& s) { s.solids[0].body = 1; });
	refused("a solid belongs to one of 1 bodies, got -1", [](Scene<3>& s) { s.solids[0].body = -1; });
	refused("it must fit into the period of 2.9", [](Scene<3>& s) { s.cell.high[1] = 2.9, s.cell.periodic[1] = true; });
	refused("needs a positive mass", [](Scene<3>& s) { s.bodies[0].responds[0] = true; });
	refused("time step", [](Scene<3>& s) { s.dt = 0.1; });
	Scene<2> flat = scene_of<2>(grain_at<2>({ 0, 2 }), shared(Ball<2>({}, 1)));
	flat.law = laws::cundall_strack(2e5, 0.3, 0.4);
	EXPECT_TRUE(mentions(complaint([&] { Stepper<2> loop(flat); }), "solids: the laws cundallStrack and hertzMindlin"));
}
