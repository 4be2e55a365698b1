/// Many spheres: against a plain loop over all pairs, the same bits on any number of threads and with AVX2 or AVX-512,
/// conservation laws.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "engines/base/temporary_file.hpp"
#include "engines/loop/spheres/plain_spheres.hpp"

namespace graindrive::loop {

using namespace test;

namespace {

const ContactLaw all_laws[] = { laws::HertzHistory<Real>{ 2e4, 2.46e4, 50, 50, 0.3 }, laws::hertz_restitution(2e4, 0.3, 0.7, 0.4),
	laws::spring_dashpot(1e4, 3e3, 0.8, 0.5) };

/// Positions, velocities and spins after some steps with a processor's kernels; nothing if this machine cannot run them.
std::optional<std::vector<double>> moved(const Scene<3>& scene, const char* processor, long steps)
{
	setenv("GRAINDRIVE_PROCESSOR", processor, 1);
	std::optional<std::vector<double>> all;
	try {
		Stepper<3> loop(scene);
		loop.step(steps);
		all = numbers(loop);
	} catch (const std::invalid_argument& error) {
		EXPECT_NE(std::string(error.what()).find("supported by this processor"), std::string::npos) << error.what();
	}
	unsetenv("GRAINDRIVE_PROCESSOR");
	return all;
}

template <class Compare>
void for_every_law(const Compare& compare)
{
	for (const ContactLaw& law : all_laws)
		for (const Precision precision : { Precision::double_, Precision::single })
			for (const bool friction : { true, false }) {
				SCOPED_TRACE("law " + std::to_string(law.index()) + ", friction " + std::to_string(friction) + ", single " +
							 std::to_string(precision == Precision::single));
				Scene<3> scene = ball_crowd(6, 6, 3);
				scene.law = law, scene.precision = precision, scene.friction = friction;
				compare(scene, precision);
			}
}

}  // namespace

TEST(SphereLoop, five_hundred_spheres_as_in_a_plain_loop)
{
	const Scene<3> scene = ball_crowd(8, 8, 1);
	Stepper<3> loop(scene);
	PlainSpheres plain(scene);
	for (int k = 0; k < 2000; ++k) plain.step();
	loop.step(2000);
	EXPECT_GT(loop.searches_done(), 1);
	// A round-off of 1e-16 a step, which collisions let grow.
	EXPECT_NEAR(loop.kinetic_energy() / plain.kinetic_energy(), 1, 1e-9);
	for (std::size_t i = 0; i < loop.size(); ++i)
		if (scene.grains[i].body != free_grain) {
			EXPECT_EQ(loop.grain(i).place, scene.grains[i].place) << i;
		}
}

TEST(SphereLoop, any_number_of_threads_gives_the_same_bits)
{
	for_every_law([](Scene<3> scene, Precision) {
		if (!scene.friction) return;
		Stepper<3> one(scene);
		one.step(1500);
		EXPECT_GT(one.searches_done(), 1);
		for (const int threads : { 2, 3 }) {
			scene.threads = threads;
			Stepper<3> many(scene);
			many.step(1500);
			EXPECT_EQ(numbers(one), numbers(many)) << threads;
		}
	});
}

TEST(SphereLoop, avx2_and_avx512_give_the_same_bits)
{
	for_every_law([](const Scene<3>& scene, Precision) {
		const auto narrow = moved(scene, "avx2", 1500), wide = moved(scene, "avx512", 1500);
		if (narrow && wide) {
			EXPECT_EQ(*narrow, *wide);
		}
	});
}

TEST(SphereLoop, portable_code_computes_the_same_to_round_off)
{
	for_every_law([](const Scene<3>& scene, Precision precision) {
		const auto plain = moved(scene, "portable", 100);
		ASSERT_TRUE(plain);
		const auto fused = moved(scene, "avx2", 100);
		if (!fused) return;
		// A fused multiply-add rounds once, a product and a sum round twice. Collisions over a hundred steps let this difference
		// grow; velocities and spins are of order 1.
		const double tolerance = precision == Precision::single ? 1e-3 : 1e-10;
		for (std::size_t k = 0; k < plain->size(); ++k) ASSERT_NEAR((*plain)[k], (*fused)[k], tolerance) << k;
	});
}

TEST(SphereLoop, momentum_stays_and_angular_momentum_changes_by_the_torque_of_the_overlaps)
{
	Scene<3> scene = ball_crowd(6, 6, 2);
	for (bool& periodic : scene.cell.periodic) periodic = false;
	scene.gravity = {};
	scene.bodies.clear();
	for (Grain<3>& s : scene.grains) s.body = free_grain;
	const auto sums = [](auto&& sphere, std::size_t n) {
		Vec<3> p, l;
		for (std::size_t i = 0; i < n; ++i) {
			const Grain<3> s = sphere(i);
			p += s.mass * s.velocity;
			l += s.mass * geometry::cross(s.place, s.velocity) + 0.4 * s.mass * s.radius * s.radius * s.spin;
		}
		return std::make_pair(p, l);
	};
	const auto before = sums([&](std::size_t i) { return scene.grains[i]; }, scene.grains.size());
	Stepper<3> loop(scene);
	PlainSpheres plain(scene);
	Vec<3> overlap_torque;
	const int steps = 200;
	for (int k = 0; k < steps; ++k) {
		plain.step();
		overlap_torque += scene.dt * plain.overlap_torque;
	}
	loop.step(steps);
	const auto after = sums([&](std::size_t i) { return loop.grain(i); }, loop.size());
	ASSERT_GT(norm(overlap_torque), 1e-6);
	// Sums of some hundred terms of size 10, each with its round-off.
	EXPECT_LT(norm(after.first - before.first), 1e-12);
	EXPECT_LT(norm(after.second - before.second - overlap_torque), 1e-11);
}

TEST(SphereLoop, a_prescribed_sphere_moves_as_it_is_told_and_drives_the_others)
{
	Scene<3> scene = ball_crowd(6, 5, 4);
	const std::size_t index = 36 + 2 * 36 + 14;
	Grain<3>& driven = scene.grains[index];
	driven.velocity = { 1, 0.5, 0 }, driven.spin = { 0, 3, 0 };
	hold(scene, index);
	Stepper<3> loop(scene);
	PlainSpheres plain(scene);
	for (int k = 0; k < 500; ++k) plain.step();
	loop.step(500);
	EXPECT_EQ(loop.grain(index).velocity, driven.velocity);
	EXPECT_NEAR(loop.kinetic_energy() / plain.kinetic_energy(), 1, 1e-11);
	EXPECT_LT(norm(loop.bodies()[1].force - plain.force[index]), 1e-8 * norm(plain.force[index]));
}

TEST(SphereLoop, a_checkpoint_goes_on_to_the_same_bits_on_other_threads)
{
	Scene<3> scene = ball_crowd(6, 6, 5, 1);
	scene.skin = 0.1;  // so that many searches are made
	Stepper<3> one(scene);
	one.step(300);
	const graindrive::test::TemporaryFile file;
	one.save(file.path());
	const auto other = Stepper<3>::restore(file.path(), 2);
	one.step(900), other->step(900);
	EXPECT_GT(one.searches_done(), 3);
	EXPECT_EQ(numbers(one), numbers(*other));
	EXPECT_EQ(one.searches_done(), other->searches_done());
}

TEST(SphereLoop, energy_on_the_step_leaves_everything_as_it_was)
{
	const Scene<3> scene = ball_crowd(6, 6, 6);
	Stepper<3> one(scene), other(scene);
	one.step(400), other.step(100);
	for (int k = 0; k < 3; ++k) {
		EXPECT_GT(other.kinetic_energy_on_step(), 0);
		other.step(100);
	}
	EXPECT_EQ(numbers(one), numbers(other));
}

/// At the first selection the loop increases the number of steps between selections; this must not apply to the selection that is
/// already in use, because the balls touch after a hundred steps.
TEST(SphereLoop, balls_that_come_to_each_other_meet_though_selections_become_rare)
{
	Scene<3> scene;
	constexpr int side = 6;
	constexpr double apart = 1.02, speed = 3;  // [d], [d/s]: spheres at rest are candidates of each other, and not selected
	scene.law = laws::hertz_restitution(2e4, 0.3, 0.7, 0.4);
	scene.dt = 2e-4;
	for (int k = 0; k < side * side * side; ++k)
		scene.grains.push_back(sphere(apart * Vec<3>{ double(k % side), double(k / side % side), double(k / (side * side)) }));
	for (int b = 0; b < 2; ++b) {
		Grain<3> one = sphere({ 20 + 1.06 * b, 0, 0 });
		one.body = b;
		RigidBody<3> body;
		body.place = one.place, body.mass = one.mass, body.inertia = Vec<3>::all(0.1 * one.mass);
		body.responds[0] = body.responds[1] = body.responds[2] = true;
		body.velocity[0] = b == 0 ? speed : 0;
		scene.grains.push_back(one), scene.bodies.push_back(body);
	}
	Stepper<3> loop(scene);
	PlainSpheres plain(scene);
	loop.step(200);
	for (int k = 0; k < 200; ++k) plain.step();
	EXPECT_LT(loop.bodies()[0].velocity[0], 0.9 * speed);  // the balls have collided
	EXPECT_NEAR(loop.bodies()[0].velocity[0], plain.bodies[0].b.velocity[0], 1e-9 * speed);
}

/// Layers of spheres that slide over each other without contact: displacements of neighbours differ little, however fast the top
/// layer is.
TEST(SphereLoop, a_shear_is_searched_much_less_often_than_pairs_are_selected)
{
	Scene<3> scene;
	constexpr int side = 8, layers = 40;
	constexpr double apart = 1.2, shear = 2;  // [d], [1/s]
	scene.cell.high = Vec<3>{ side * apart, side * apart, 0 };
	scene.cell.periodic[0] = scene.cell.periodic[1] = true;
	scene.law = laws::hertz_restitution(2e4, 0.3, 0.7, 0.4);
	scene.dt = 2e-4;
	for (int k = 0; k < side * side * layers; ++k) {
		Grain<3> one;
		one.place = { (k % side + 0.5) * apart, (k / side % side + 0.5) * apart, k / (side * side) * apart };
		one.velocity = { shear * one.place[2], 0, 0 };
		one.radius = 0.5, one.mass = 1;
		scene.grains.push_back(one);
	}
	Stepper<3> loop(scene);
	loop.step(2000);
	EXPECT_GE(loop.selections_done(), 10);
	EXPECT_LE(3 * loop.searches_done(), loop.selections_done());
}

TEST(SphereLoop, scenes_that_cannot_be_run_are_refused)
{
	const auto refused = [](const char* words, auto change) {
		Scene<3> scene = ball_crowd(4, 2, 1);
		change(scene);
		try {
			Stepper<3> loop(scene);
			loop.step();
			ADD_FAILURE() << words;
		} catch (const std::invalid_argument& error) {
			EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
		}
	};
	refused("time step must be positive", [](Scene<3>& s) { s.dt = 0; });
	refused("radius must be positive", [](Scene<3>& s) { s.grains[3].radius = -1; });
	refused("finite for a free grain", [](Scene<3>& s) { s.grains.back().mass = HUGE_VAL; });
	refused("lengthen it", [](Scene<3>& s) { s.cell.high[0] = 2; });
	refused("must be finite", [](Scene<3>& s) { s.grains[3].velocity[0] = NAN; });
}

}  // namespace graindrive::loop
