/// What comes from outside while a run goes on: pushes, other settings, moved grains, and restarts that do not notice.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "engines/base/temporary_file.hpp"
#include "engines/base/complaint.hpp"
#include "engines/loop/guards.hpp"
#include "engines/loop/test_scenes.hpp"

namespace graindrive::loop {
namespace {

/// Positions, velocities and spins of all grains.
std::vector<double> everything(const Stepper& stepper)
{
	std::vector<double> all(5 * stepper.size());
	stepper.positions(all.data());
	stepper.velocities(all.data() + 2 * stepper.size());
	stepper.spins(all.data() + 4 * stepper.size());
	return all;
}

/// 400 grains in a periodic box and a disk of five radii that crosses it, spinning.
Scene crossed_by_a_spinning_disk()
{
	Scene scene;
	scene.law = laws::HertzHistory<Real>{ 2e5, 2.46e5, 50, 50, 0.5 };
	scene.dt = 1e-5;
	scene.box = { 0, 30, 0, 30, true, true };
	for (int k = 0; k < 400; ++k) {
		Grain grain;
		grain.x = 1.5 * (k % 20) + 0.4, grain.y = 1.5 * (k / 20) + 0.4;
		grain.vx = std::sin(k), grain.vy = std::cos(3 * k);
		grain.radius = 0.45 + 0.05 * std::sin(7 * k), grain.mass = pi * grain.radius * grain.radius;
		if (std::hypot(grain.x - 15, grain.y - 15) > 3.2) scene.grains.push_back(grain);
	}
	RigidBody body;
	body.x = body.y = 15, body.vx = 2.5, body.spin = 250;
	scene.bodies.push_back(body);
	Grain disk;
	disk.x = disk.y = 15, disk.radius = 2.5, disk.mass = 20, disk.body = 0;
	scene.grains.push_back(disk);
	return scene;
}

TEST(Restart, SearchesFallOnTheSameStepsWhereverABodyHasGone)
{
	Stepper whole(crossed_by_a_spinning_disk());
	whole.step(20'000);
	const graindrive::test::TemporaryFile file;
	whole.save(file.path());
	const auto restored = Stepper::restore(file.path());
	whole.step(30'000);
	restored->step(30'000);
	EXPECT_GT(whole.searches_done(), 5);
	EXPECT_EQ(whole.searches_done(), restored->searches_done());
	EXPECT_EQ(everything(whole), everything(*restored));
}

TEST(Push, MovesAFreeGrainByForceOverMassAndTorqueOverInertia)
{
	Scene scene = crossed_by_a_spinning_disk();
	scene.grains.resize(1), scene.bodies.clear();
	scene.grains[0].vx = scene.grains[0].vy = 0;
	Stepper stepper(scene);
	stepper.set_pushes({ { 0, 3, -1, 0.5 } });
	stepper.step(100);
	const Grain g = stepper.grain(0);
	const double t = 100 * scene.dt;
	EXPECT_NEAR(g.vx, 3 / g.mass * t, 1e-15);  // round-off of a hundred sums
	EXPECT_NEAR(g.vy, -1 / g.mass * t, 1e-15);
	EXPECT_NEAR(g.spin, 0.5 / (g.mass * g.radius * g.radius / 2) * t, 1e-15);
}

TEST(Push, OnABodyIsRefusedByNumber)
{
	Stepper stepper(crossed_by_a_spinning_disk());
	const std::uint32_t body = stepper.size() - 1;
	EXPECT_TRUE(mentions(complaint([&] { stepper.set_pushes({ { body, 1, 0, 0 } }); }), "got grain"));
}

TEST(BodyForces, TakenBackLeaveNoTrace)
{
	Stepper asked(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
	for (int k = 0; k < 2000; ++k) {
		asked.compute_body_forces();
		asked.take_back_body_forces();
		asked.compute_body_forces();
		asked.step(1);
	}
	plain.step(2000);
	EXPECT_EQ(everything(asked), everything(plain));
}

TEST(KineticEnergyOnStep, OfAStepUnderWayLeavesNoTrace)
{
	Stepper asked(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
	for (int k = 0; k < 200; ++k) {
		asked.compute_body_forces();
		asked.kinetic_energy_on_step();
		asked.step(5);
		plain.step(5);
	}
	EXPECT_EQ(everything(asked), everything(plain));
}

TEST(KineticEnergyOnStep, WhereAGuardTripsLeavesTheLoopAsItWas)
{
	Stepper stepper(test::crowd(20, 1)), plain(test::crowd(20, 1));
	stepper.step(99);
	const auto before = everything(stepper);
	stepper.guarding().every = 1;
	stepper.guarding().largest_overlap = 1e-9;  // no contact passes
	EXPECT_THROW(stepper.kinetic_energy_on_step(), std::runtime_error);
	stepper.guarding() = Guards{};
	EXPECT_EQ(everything(stepper), before);
	stepper.step(200);
	plain.step(299);
	EXPECT_EQ(everything(stepper), everything(plain));
}

TEST(Change, OfNothingChangesNoBit)
{
	Stepper changed(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
	for (int k = 0; k < 20; ++k) {
		changed.step(100);
		changed.change(changed.settings());
	}
	plain.step(2000);
	EXPECT_EQ(everything(changed), everything(plain));
}

TEST(Change, OfThreadsChangesNoBit)
{
	Stepper changed(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
	changed.step(1000);
	Scene other = changed.settings();
	other.threads = 2;
	changed.change(other);
	changed.step(1000);
	plain.step(2000);
	EXPECT_EQ(everything(changed), everything(plain));
}

TEST(Put, AGrainFarAwayMeetsItsNewNeighbours)
{
	Stepper stepper(crossed_by_a_spinning_disk());
	stepper.step(100);
	stepper.guarding().every = 0;  // it will overlap others, too
	Grain grain = stepper.grain(3);
	const Grain other = stepper.grain(200);
	grain.x = other.x + 0.97 * (grain.radius + other.radius), grain.y = other.y;
	stepper.put(3, grain);
	stepper.step(1);
	const auto contacts = stepper.contacts();
	EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
		[](const Contact& c) { return (c.first == 3 && c.second == 200) || (c.first == 200 && c.second == 3); }));
}

TEST(CriticalStepOfBodies, FallsAsTheRootOfTheBodysMass)
{
	Scene scene = crossed_by_a_spinning_disk();
	scene.friction = false;
	RigidBody& body = scene.bodies[0];
	body.responds_x = body.responds_y = true;
	const auto critical = [&](double mass) {
		body.mass = scene.grains.back().mass = mass;
		return critical_time_step_of_bodies(scene);
	};
	// Far lighter than a grain, the body's mass alone decides, and the dashpots of Hertz's law with it fall out.
	EXPECT_NEAR(critical(1e-8) / critical(1e-10), 10, 1e-3);
}

TEST(CriticalStepOfBodies, FallsWithTheMomentOfInertia)
{
	Scene scene = crossed_by_a_spinning_disk();
	RigidBody& body = scene.bodies[0];
	body.responds_spin = true, body.mass = 20;
	const auto critical = [&](double inertia) {
		body.inertia = inertia;
		return critical_time_step_of_bodies(scene);
	};
	EXPECT_LT(critical(1e-4), 0.2 * critical(1));
}

TEST(CriticalStepOfBodies, IsInfiniteWhereNoneResponds)
{
	EXPECT_EQ(critical_time_step_of_bodies(crossed_by_a_spinning_disk()), HUGE_VAL);
}

TEST(Images, ABodyThatAGrainCouldMeetTwiceIsRefused)
{
	Scene scene = crossed_by_a_spinning_disk();
	scene.box.x_high = 5.5;
	EXPECT_TRUE(mentions(complaint([&] { check_scene(scene); }), "two of its images: the period in x must be at least"));
}

}  // namespace
}  // namespace graindrive::loop
