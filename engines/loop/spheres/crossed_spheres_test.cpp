/// All features of a scene of spheres combined in small scenes: law, friction, rotation, bodies, walls, solids, pushes,
/// precision, threads.
#include <gtest/gtest.h>

#include "engines/base/temporary_file.hpp"
#include "engines/geometry/solids.hpp"
#include "engines/loop/spheres/plain_spheres.hpp"

namespace graindrive::loop {

using namespace test;

namespace {

constexpr int side = 5, layers = 3, steps = 60;
const ContactLaw every_law[] = { laws::HertzHistory<Real>{ 2e4, 2.46e4, 50, 50, 0.3 },
	laws::hertz_restitution(2e4, 0.3, 0.7, 0.4), laws::spring_dashpot(1e4, 3e3, 0.8, 0.5) };

struct Features {
	int law;
	bool friction, rotation, clump, driven, frozen, walls, solids, pushes;
};

/// Calls visit(features) for each combination. Pushes are the parity of the others, so that all combinations of any seven of the
/// eight occur.
template <class Visitor>
void cross(Visitor&& visit)
{
	for (int law = 0; law < 3; ++law)
		for (int bits = 0; bits < 128; ++bits) {
			const auto on = [&](int bit) { return bool(bits >> bit & 1); };
			bool odd = false;
			for (int bit = 0; bit < 7; ++bit) odd ^= on(bit);
			visit(Features{ law, on(0), on(1), on(2), on(3), on(4), on(5), on(6), odd });
		}
}

std::string name_of(const Features& f)
{
	return "law " + std::to_string(f.law) + (f.friction ? ", friction" : "") + (f.rotation ? ", rotation" : "") +
	       (f.clump ? ", clump" : "") + (f.driven ? ", driven" : "") + (f.frozen ? ", frozen" : "") + (f.walls ? ", walls" : "") +
	       (f.solids ? ", solids" : "") + (f.pushes ? ", pushes" : "");
}

int add(Scene<3>& s, const RigidBody<3>& body)
{
	s.bodies.push_back(body);
	return int(s.bodies.size()) - 1;
}

std::size_t nearest_free(const Scene<3>& s, const Vec<3>& to)
{
	std::size_t best = s.grains.size();
	for (std::size_t i = 0; i < s.grains.size(); ++i)
		if (s.grains[i].body == free_grain &&
			(best == s.grains.size() || norm(s.grains[i].place - to) < norm(s.grains[best].place - to)))
			best = i;
	return best;
}

void give(Scene<3>& s, std::size_t grain, int body) { s.grains[grain].body = body, s.grains[grain].mass = s.bodies[body].mass; }

/// A clump that tumbles, and a sphere with a load that may move along x and turn about y only.
void add_clump(Scene<3>& s)
{
	RigidBody<3> tumbling;
	tumbling.place = { 0.9, 0.9, 2.2 }, tumbling.mass = 1.5, tumbling.inertia = { 0.3, 0.5, 0.4 };
	tumbling.turn = geometry::Turn<3>::by({ 0.3, -0.2, 0.5 });
	tumbling.velocity = { 0.1, -0.2, -0.3 }, tumbling.spin = { 1, -0.5, 2 };
	tumbling.responds.fill(true), tumbling.turns.fill(true);
	const int b = add(s, tumbling);
	for (const Vec<3>& near : { Vec<3>{ 0.5, 0.5, 2 }, Vec<3>{ 1.5, 0.5, 2 }, Vec<3>{ 0.5, 1.5, 2 }, Vec<3>{ 0.5, 0.5, 3 } })
		give(s, nearest_free(s, near), b);
	RigidBody<3> guided;
	const std::size_t i = nearest_free(s, { 0.5, 3.5, 2 });
	guided.place = s.grains[i].place - Vec<3>{ 0.1, 0, 0.05 }, guided.mass = 0.7, guided.inertia = { 0.1, 0.2, 0.15 };
	guided.turn = geometry::Turn<3>::by({ -0.4, 0.1, 0.2 });
	guided.responds[0] = guided.turns[1] = true, guided.load = { 0.5, 0, 0 }, guided.spin = { 0, 0.4, 0 };
	give(s, i, add(s, guided));
}

/// The walls of a box that is periodic in x: a floor that slides, a lid under pressure, a side that moves inwards, one at rest.
void add_walls(Scene<3>& s)
{
	s.cell.periodic[1] = false;
	Wall<3> floor, lid, left, right;
	floor.side = Side::z_low, floor.position = -0.49, floor.slide = { 0.3, 0.1, 0 };
	lid.side = Side::z_high, lid.position = 3.49, lid.pressed = true, lid.pressure = 2, lid.mass = 5, lid.damping = 10;
	left.side = Side::y_low, left.position = 0, left.velocity = 0.2;
	right.side = Side::y_high, right.position = side, right.slide = { 0, 0, -0.4 };
	s.walls = { floor, lid, left, right };
}

/// An endless cylinder along x that rises and turns, and a free ball with a sphere glued to it.
void add_solids(Scene<3>& s)
{
	const double radius = 0.9;
	RigidBody<3> roller, ball;
	roller.place = { 1, 2.5, 1.5 }, roller.velocity = { 0.1, 0, 0.2 }, roller.spin = { 1, 0, 0 };
	ball.place = { 2.5, 1, 4.07 }, ball.velocity = { 0, 0, -0.3 }, ball.spin = { 0, 1, 0.5 };
	ball.mass = 2, ball.inertia = { 0.4, 0.4, 0.4 };
	ball.responds.fill(true), ball.turns.fill(true);
	std::vector<Grain<3>> outside;
	for (const Grain<3>& g : s.grains)
		if (std::hypot(g.place[1] - 2.5, g.place[2] - 1.5) > radius + g.radius - 0.03) outside.push_back(g);
	s.grains = outside;
	s.solids.push_back({ add(s, roller), geometry::shared(geometry::Cylinder({}, { 1, 0, 0 }, radius)), "" });
	s.solids.push_back({ add(s, ball), geometry::shared(geometry::Ball<3>({}, 0.7)), "" });
	if (!s.walls.empty()) return;  // the ball would lie above the lid
	s.grains.push_back(sphere({ 2.6, 1, 5 }, 0.3));
	give(s, s.grains.size() - 1, int(s.bodies.size()) - 1);
}

Scene<3> scene_with(const Features& f)
{
	Scene<3> s = ball_crowd(side, layers, 11);
	s.law = every_law[f.law], s.friction = f.friction, s.rotation = f.rotation;
	if (!f.frozen) {
		s.bodies.clear();
		for (Grain<3>& g : s.grains) g.body = free_grain;
	}
	if (f.walls) add_walls(s);
	if (f.solids) add_solids(s);
	if (f.clump) add_clump(s);
	if (f.driven) {
		const std::size_t i = nearest_free(s, { 3.5, 4.5, 2 });
		s.grains[i].velocity = { 0.5, 0.2, -0.1 }, s.grains[i].spin = { 1, 0, 2 };
		hold(s, i);
	}
	if (f.pushes)
		for (RigidBody<3>& body : s.bodies) body.push = { 0.3, -0.2, 0.5 }, body.push_torque = { 0.1, 0.2, -0.1 };
	return s;
}

std::vector<Push<3>> pushes_in(const Scene<3>& s)
{
	const std::uint32_t one = nearest_free(s, { 4.5, 4.5, 3 }), other = nearest_free(s, { 4.5, 0.5, 1 });
	return { { one, { 1, -2, 0.5 }, { 0.1, 0, -0.2 } }, { other, { 0, 0.3, -1 }, { 0, 0.1, 0 } } };
}

/// A loop after some steps, with or without pushes.
std::unique_ptr<Stepper<3>> ran(const Scene<3>& s, bool pushed, int n = steps)
{
	auto loop = std::make_unique<Stepper<3>>(s);
	if (pushed) loop->set_pushes(pushes_in(s));
	loop->step(n);
	return loop;
}

struct Difference {
	double motion = 0, force = 0;  // largest differences of any component
};

/// The differences of grains (by the nearest image), bodies and walls.
Difference difference(const Stepper<3>& loop, const PlainSpheres& plain)
{
	Difference most;
	const auto compare = [](double& in, const Vec<3>& a, const Vec<3>& b) { in = std::max(in, geometry::largest(a - b)); };
	for (std::size_t i = 0; i < loop.size(); ++i) {
		const Grain<3> one = loop.grain(i), &other = plain.s.grains[i];
		compare(most.motion, plain.s.cell.nearest(one.place - other.place).at, {});
		compare(most.motion, one.velocity, other.velocity), compare(most.motion, one.spin, other.spin);
	}
	const Scene<3>& now = loop.settings();
	for (std::size_t b = 0; b < now.bodies.size(); ++b) {
		const RigidBody<3>&one = now.bodies[b], &other = plain.bodies[b].b;
		compare(most.motion, one.place, other.place);
		compare(most.motion, one.velocity, other.velocity), compare(most.motion, one.spin, other.spin);
		if (one.frozen) continue;
		compare(most.force, one.force, from_law(plain.bodies[b].force));
		compare(most.force, one.torque, from_law(plain.bodies[b].torque));
	}
	for (std::size_t w = 0; w < now.walls.size(); ++w) {
		const Wall<3>&one = now.walls[w], &other = plain.s.walls[w];
		compare(most.force, one.force, other.force);
		most.motion = std::max(most.motion, std::abs(one.position - other.position));
	}
	return most;
}

}  // namespace

TEST(CrossedSpheres, follow_the_plain_loop_on_threads_and_in_single_precision)
{
	int crossed = 0;
	cross([&](const Features& f) {
		SCOPED_TRACE(name_of(f));
		Scene<3> scene = scene_with(f);
		PlainSpheres plain(scene);
		if (f.pushes) plain.pushes = pushes_in(scene);
		for (int k = 0; k < steps; ++k) plain.step();
		const auto one = ran(scene, f.pushes);
		scene.threads = crossed++ % 5 == 0 ? 3 : 1;  // rarely, since threads are slow on a busy machine
		const auto three = ran(scene, f.pushes);
		scene.threads = 1, scene.precision = Precision::single;
		const auto single = ran(scene, f.pushes);
		const Difference in_double = difference(*one, plain), in_single = difference(*single, plain);
		// Round-off of 60 steps, and the kernels' approximation of how springs turn: they compute the last normal as if spheres
		// had moved straight, with one distance for two steps. At 3 m/s this turns a spring by 1e-10 rad too much; for members of
		// turning bodies, which move along arcs, the error is (w dt)^2 arm / 2 = 1e-7 rad. Forces are of order 10, velocities of
		// order 1.
		EXPECT_LT(in_double.motion, 1e-9);
		EXPECT_LT(in_double.force, 1e-8);
		EXPECT_LT(in_single.motion, 1e-3);  // round-off of 6e-8 of the forces, over masses of 0.5
		EXPECT_LT(in_single.force, 5e-3);
		EXPECT_EQ(numbers(*one), numbers(*three));
	});
}

TEST(CrossedSpheres, go_on_from_a_checkpoint_to_the_last_bit)
{
	const graindrive::test::TemporaryFile file;
	cross([&](const Features& f) {
		if (f.solids) return;  // a file holds no surfaces yet
		SCOPED_TRACE(name_of(f));
		const Scene<3> scene = scene_with(f);
		const auto straight = ran(scene, f.pushes), stopped = ran(scene, f.pushes, steps / 2);
		stopped->save(file.path());
		const auto resumed = Stepper<3>::restore(file.path(), 2);
		resumed->step(steps - steps / 2);
		EXPECT_EQ(numbers(*straight), numbers(*resumed));
	});
}

}  // namespace graindrive::loop
