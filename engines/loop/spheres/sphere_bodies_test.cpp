/// Rigid bodies in space: tops against closed forms and Euler's equations, bodies with one free axis, clumps in collisions.
#include <gtest/gtest.h>

#include "engines/geometry/solids.hpp"
#include "engines/loop/spheres/plain_spheres.hpp"

namespace graindrive::loop {

using namespace test;
using geometry::Turn;

namespace {

/// A body that responds to all forces and torques.
RigidBody<3> free_body(double mass, const Vec<3>& inertia)
{
	RigidBody<3> body;
	body.mass = mass, body.inertia = inertia;
	body.turn = Turn<3>::by({ 0.4, -0.3, 0.7 });
	body.responds.fill(true), body.turns.fill(true);
	return body;
}

/// The body and one sphere that belongs to it.
Scene<3> alone(const RigidBody<3>& body, double dt)
{
	Scene<3> s;
	s.bodies = { body };
	s.grains = { sphere({ 0.3, 0, 0 }) };
	s.grains[0].body = 0;
	s.law = laws::HertzHistory<Real>{ 2e4, 2.46e4, 50, 50, 0.3 };
	s.dt = dt;
	return s;
}

/// Angular momentum I w of a body in the world's frame.
Vec<3> angular_momentum(const RigidBody<3>& body)
{
	Vec<3> in_frame = body.turn.undo(body.spin);
	for (int k = 0; k < 3; ++k) in_frame[k] *= body.inertia[k];
	return body.turn.apply(in_frame);
}

/// Angle between two orientations [rad].
double angle_between(const Turn<3>& a, const Turn<3>& b) { return 2 * norm(b.then(a.inverse()).u); }

/// The orientation after torque-free motion with the body's L: dR/dt = w x R, w = R I^-1 R^T L, by Runge-Kutta with very small
/// steps.
Turn<3> turned_by_euler(const RigidBody<3>& body, double time)
{
	const Vec<3> momentum = angular_momentum(body);
	const int steps = 4000;
	const double h = time / steps;
	const auto spin = [&](const Turn<3>& turn) {
		Vec<3> w = turn.undo(momentum);
		for (int k = 0; k < 3; ++k) w[k] /= body.inertia[k];
		return turn.apply(w);
	};
	const auto rate = [&](const Turn<3>& q) {  // dq/dt = w q / 2
		const Vec<3> w = 0.5 * spin(q.normalised());
		return Turn<3>{ -dot(w, q.u), q.w * w + cross(w, q.u) };
	};
	const auto moved = [](const Turn<3>& q, const Turn<3>& by, double t) { return Turn<3>{ q.w + t * by.w, q.u + t * by.u }; };
	Turn<3> q = body.turn;
	for (int n = 0; n < steps; ++n) {
		const Turn<3> a = rate(q), b = rate(moved(q, a, h / 2)), c = rate(moved(q, b, h / 2)), d = rate(moved(q, c, h));
		q = moved(moved(moved(moved(q, a, h / 6), b, h / 3), c, h / 3), d, h / 6).normalised();
	}
	return q;
}

}  // namespace

TEST(SphereBodies, a_symmetric_top_precesses_as_euler_says)
{
	// w = L/I_1 + (1 - I_3/I_1) w_3 e_3: the symmetry axis turns about L at |L|/I_1, and the body about this axis at
	// (1 - I_3/I_1) w_3.
	RigidBody<3> top = free_body(1, { 0.5, 0.5, 0.9 });
	top.spin = { 1, 2, -1.5 };
	const Vec<3> momentum = angular_momentum(top);
	const double time = 4, own_rate = (1 - 0.9 / 0.5) * top.turn.undo(top.spin)[2];
	const Turn<3> exact = Turn<3>::by({ 0, 0, own_rate * time }).then(top.turn).then(Turn<3>::by(time / 0.5 * momentum));
	double error[2];
	for (int k = 0; k < 2; ++k) {
		const double dt = k ? 1e-3 : 2e-3;
		Stepper<3> loop(alone(top, dt));
		loop.step(std::lround(time / dt));
		const RigidBody<3>& now = loop.bodies()[0];
		error[k] = angle_between(now.turn, exact);
		EXPECT_LT(norm(now.momentum - momentum), 1e-15 * norm(momentum));  // without torque L stays
		// The axis keeps its angle to L with an error of the same order.
		const Vec<3> axis = now.turn.apply({ 0, 0, 1 }), before = top.turn.apply({ 0, 0, 1 });
		EXPECT_NEAR(dot(axis, momentum), dot(before, momentum), 1e-4);
	}
	EXPECT_LT(error[1], 1e-4);  // (w dt)^2 = 1e-5 of the 13 rad by which it turned
	EXPECT_NEAR(error[0] / error[1], 4, 0.05);
}

TEST(SphereBodies, a_body_without_symmetry_tumbles_by_eulers_equations)
{
	RigidBody<3> body = free_body(1, { 0.3, 0.5, 0.9 });
	body.spin = body.turn.apply({ 0.02, 2, 0.01 });  // rotation about the middle axis is unstable: the body turns over
	const double time = 8;
	const Turn<3> exact = turned_by_euler(body, time);
	double error[2];
	for (int k = 0; k < 2; ++k) {
		const double dt = k ? 2.5e-4 : 5e-4;
		Stepper<3> loop(alone(body, dt));
		double lowest = 1;
		for (int n = 0; n < 20; ++n) {
			loop.step(std::lround(time / 20 / dt));
			lowest = std::min(lowest, loop.bodies()[0].turn.undo(loop.bodies()[0].spin)[1]);
		}
		EXPECT_LT(lowest, -1.5);  // the body has turned over
		error[k] = angle_between(loop.bodies()[0].turn, exact);
		EXPECT_LT(norm(loop.bodies()[0].momentum - angular_momentum(body)), 1e-14);
	}
	EXPECT_LT(error[1], 1e-4);
	EXPECT_NEAR(error[0] / error[1], 4, 0.1);
}

TEST(SphereBodies, about_one_free_axis_the_moment_about_it_decides)
{
	for (int k = 0; k < 3; ++k) {
		RigidBody<3> body = free_body(1, { 0.3, 0.5, 0.9 });
		body.turns = {}, body.turns[k] = true;
		body.push_torque = { 0.2, -0.3, 0.4 };
		double moment = 0;  // e.R I R^T e
		const Vec<3> axis = body.turn.undo(Vec<3>::along(k));
		for (int q = 0; q < 3; ++q) moment += body.inertia[q] * axis[q] * axis[q];
		Stepper<3> loop(alone(body, 1e-3));
		loop.step(1000);
		// The moment of inertia about the axis does not change: w = T t/I, and angle = T t (t + dt)/2I from w = 0 at -dt/2.
		const RigidBody<3>& now = loop.bodies()[0];
		const double rate = body.push_torque[k] / moment;
		EXPECT_LT(norm(now.spin - rate * Vec<3>::along(k)), 1e-12);
		EXPECT_LT(angle_between(now.turn, body.turn.then(Turn<3>::by(rate * 1.001 / 2 * Vec<3>::along(k)))), 1e-12);
	}
}

TEST(SphereBodies, a_ball_has_no_preferred_axis_and_may_keep_one_rotation_blocked)
{
	RigidBody<3> body = free_body(1, { 0.4, 0.4, 0.4 });
	body.spin = { 1, -2, 0.5 };
	body.push_torque = { 0.2, -0.3, 0.4 };
	for (const bool blocked : { false, true }) {
		body.turns[1] = !blocked;
		Stepper<3> loop(alone(body, 1e-3));
		loop.step(1000);
		Vec<3> expected = body.spin + body.push_torque / 0.4;
		if (blocked) expected[1] = body.spin[1];
		EXPECT_LT(norm(loop.bodies()[0].spin - expected), 1e-12);
	}
	body.inertia[2] = 0.5;
	EXPECT_THROW(Stepper<3>(alone(body, 1e-3)), std::invalid_argument);
}

TEST(SphereBodies, random_states_keep_momentum_and_angular_momentum_but_for_the_torque_of_the_overlaps)
{
	const ContactLaw all_laws[] = { laws::HertzHistory<Real>{ 2e4, 2.46e4, 50, 50, 0.3 },
		laws::hertz_restitution(2e4, 0.3, 0.7, 0.4), laws::spring_dashpot(1e4, 3e3, 0.8, 0.5) };
	for (const unsigned seed : { 1u, 2u, 3u }) {
		Scene<3> s = ball_crowd(4, 3, seed, 1);
		for (bool& periodic : s.cell.periodic) periodic = false;
		s.gravity = {}, s.law = all_laws[seed - 1];
		s.bodies = { free_body(1.5, { 0.3, 0.5, 0.4 }), free_body(2, { 0.4, 0.4, 0.4 }) };
		s.bodies[0].place = { 1, 1, 1 }, s.bodies[0].spin = { 1, -2, 0.5 };
		s.bodies[1].place = { 2, 2, 4.2 }, s.bodies[1].velocity = { 0, 0, -0.5 }, s.bodies[1].spin = { 1, 1, 3 };
		for (Grain<3>& g : s.grains) g.body = free_grain;
		for (const int member : { 21, 22, 25, 37 }) s.grains[member].body = 0, s.grains[member].mass = 1.5;
		s.solids = { { 1, geometry::shared(geometry::Ball<3>({}, 0.9)), "" } };  // the ball lies on four spheres
		const auto sums = [&](auto&& grain, const auto& body) {
			Vec<3> p, l;
			for (std::size_t i = 0; i < s.grains.size(); ++i) {
				const Grain<3> g = grain(i);
				if (g.body != free_grain) continue;
				p += g.mass * g.velocity;
				l += g.mass * geometry::cross(g.place, g.velocity) + PlainSpheres::moment(g) * g.spin;
			}
			for (int b = 0; b < 2; ++b) {
				p += body(b).mass * body(b).velocity;
				l += body(b).mass * geometry::cross(body(b).place, body(b).velocity) +
				     (b == 0 ? body(b).momentum : body(b).inertia[0] * body(b).spin);
			}
			return std::make_pair(p, l);
		};
		Stepper<3> loop(s);
		PlainSpheres plain(s);
		const auto now = [&] { return sums([&](int i) { return loop.grain(i); }, [&](int b) { return loop.bodies()[b]; }); };
		s.bodies[0].momentum = angular_momentum(s.bodies[0]);
		const auto before = sums([&](int i) { return s.grains[i]; }, [&](int b) { return s.bodies[b]; });
		Vec<3> overlap_torque;
		for (int k = 0; k < 300; ++k) {
			plain.step();
			overlap_torque += s.dt * plain.overlap_torque;
		}
		loop.step(300);
		const auto after = now();
		EXPECT_GT(norm(loop.bodies()[1].velocity - s.bodies[1].velocity), 0.01) << seed;
		EXPECT_GT(norm(overlap_torque), 1e-6);
		// Sums of some hundred terms of size 10, each with its round-off. The torque of the overlaps is taken from the plain
		// loop, whose springs at members of the clump differ by 1e-7.
		EXPECT_LT(norm(after.first - before.first), 1e-12) << seed;
		EXPECT_LT(norm(after.second - before.second - overlap_torque), 1e-10) << seed;
	}
}

/// At any speed: a selection of pairs must not be used longer than the search is valid.
TEST(SphereBodies, a_driven_sphere_meets_what_lies_in_its_way)
{
	for (const double per_step : { 0.01, 0.1, 0.2, 0.4, 0.8 })  // [radii]
		for (const double ahead : { 1.2, 2., 8. }) {            // [m]
			RigidBody<3> driven;
			Scene<3> s = alone(driven, 1e-4);
			s.grains[0].place = {};
			s.bodies[0].velocity[0] = per_step * s.grains[0].radius / s.dt;
			s.grains.push_back(sphere({ ahead, 0, 0 }));
			s.grains.back().velocity = {};
			Stepper<3> loop(s);
			loop.guarding().every = 0;
			const double way = ahead;  // to the sphere's centre
			loop.step(long(way / (s.bodies[0].velocity[0] * s.dt)));
			EXPECT_GT(loop.grain(1).place[0], ahead) << per_step << " R a step, " << ahead << " m ahead";
		}
}

}  // namespace graindrive::loop
