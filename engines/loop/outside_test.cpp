/// Changes from outside during a run: pushes, settings, moved grains; and restarts, which must not depend on when they are made.
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
std::vector<double> everything(const Stepper<2>& stepper)
{
	std::vector<double> all(5 * stepper.size());
	stepper.positions(all.data());
	stepper.velocities(all.data() + 2 * stepper.size());
	stepper.spins(all.data() + 4 * stepper.size());
	return all;
}

/// 400 grains in a periodic box and a spinning disk of five radii that moves through it.
Scene<2> crossed_by_a_spinning_disk()
{
	Scene<2> scene;
	scene.law = laws::HertzHistory<Real>{ 2e5, 2.46e5, 50, 50, 0.5 };
	scene.dt = 1e-5;
	scene.cell = { { 0, 0 }, { 30, 30 }, { true, true } };
	for (int k = 0; k < 400; ++k) {
		Grain<2> grain;
		grain.place[0] = 1.5 * (k % 20) + 0.4, grain.place[1] = 1.5 * (k / 20) + 0.4;
		grain.velocity[0] = std::sin(k), grain.velocity[1] = std::cos(3 * k);
		grain.radius = 0.45 + 0.05 * std::sin(7 * k), grain.mass = pi * grain.radius * grain.radius;
		if (std::hypot(grain.place[0] - 15, grain.place[1] - 15) > 3.2) scene.grains.push_back(grain);
	}
	RigidBody<2> body;
	body.place[0] = body.place[1] = 15, body.velocity[0] = 2.5, body.spin = 250;
	scene.bodies.push_back(body);
	Grain<2> disk;
	disk.place[0] = disk.place[1] = 15, disk.radius = 2.5, disk.mass = 20, disk.body = 0;
	scene.grains.push_back(disk);
	return scene;
}

TEST(Restart, SearchesFallOnTheSameStepsWhereverABodyHasGone)
{
	Stepper<2> whole(crossed_by_a_spinning_disk());
	whole.step(20'000);
	const graindrive::test::TemporaryFile file;
	whole.save(file.path());
	const auto restored = Stepper<2>::restore(file.path());
	whole.step(30'000);
	restored->step(30'000);
	EXPECT_GT(whole.searches_done(), 5);
	EXPECT_EQ(whole.searches_done(), restored->searches_done());
	EXPECT_EQ(everything(whole), everything(*restored));
}

TEST(Push, MovesAFreeGrainByForceOverMassAndTorqueOverInertia)
{
	Scene<2> scene = crossed_by_a_spinning_disk();
	scene.grains.resize(1), scene.bodies.clear();
	scene.grains[0].velocity[0] = scene.grains[0].velocity[1] = 0;
	Stepper<2> stepper(scene);
	stepper.set_pushes({ { 0, 3, -1, 0.5 } });
	stepper.step(100);
	const Grain<2> g = stepper.grain(0);
	const double t = 100 * scene.dt;
	EXPECT_NEAR(g.velocity[0], 3 / g.mass * t, 1e-15);  // round-off of a hundred sums
	EXPECT_NEAR(g.velocity[1], -1 / g.mass * t, 1e-15);
	EXPECT_NEAR(g.spin, 0.5 / (g.mass * g.radius * g.radius / 2) * t, 1e-15);
}

TEST(Push, OnABodyIsRefusedByNumber)
{
	Stepper<2> stepper(crossed_by_a_spinning_disk());
	const std::uint32_t body = stepper.size() - 1;
	EXPECT_TRUE(mentions(complaint([&] { stepper.set_pushes({ { body, 1, 0, 0 } }); }), "got grain"));
}

TEST(BodyForces, TakenBackLeaveNoTrace)
{
	Stepper<2> asked(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
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
	Stepper<2> asked(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
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
	Stepper<2> stepper(test::crowd(20, 1)), plain(test::crowd(20, 1));
	stepper.step(99);
	const auto before = everything(stepper);
	stepper.guarding().every = 1;
	stepper.guarding().largest_overlap = 1e-9;  // every contact raises an error
	EXPECT_THROW(stepper.kinetic_energy_on_step(), std::runtime_error);
	stepper.guarding() = Guards<2>{};
	EXPECT_EQ(everything(stepper), before);
	stepper.step(200);
	plain.step(299);
	EXPECT_EQ(everything(stepper), everything(plain));
}

TEST(Change, OfNothingChangesNoBit)
{
	Stepper<2> changed(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
	for (int k = 0; k < 20; ++k) {
		changed.step(100);
		changed.change(changed.settings());
	}
	plain.step(2000);
	EXPECT_EQ(everything(changed), everything(plain));
}

TEST(Change, OfThreadsChangesNoBit)
{
	Stepper<2> changed(crossed_by_a_spinning_disk()), plain(crossed_by_a_spinning_disk());
	changed.step(1000);
	Scene<2> other = changed.settings();
	other.threads = 2;
	changed.change(other);
	changed.step(1000);
	plain.step(2000);
	EXPECT_EQ(everything(changed), everything(plain));
}

TEST(Put, AGrainFarAwayMeetsItsNewNeighbours)
{
	Stepper<2> stepper(crossed_by_a_spinning_disk());
	stepper.step(100);
	stepper.guarding().every = 0;  // no guards, because the grain will also overlap others
	Grain<2> grain = stepper.grain(3);
	const Grain<2> other = stepper.grain(200);
	grain.place[0] = other.place[0] + 0.97 * (grain.radius + other.radius), grain.place[1] = other.place[1];
	stepper.put(3, grain);
	stepper.step(1);
	const auto contacts = stepper.contacts();
	EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
		[](const Contact<2>& c) { return (c.first == 3 && c.second == 200) || (c.first == 200 && c.second == 3); }));
}

TEST(CriticalStepOfBodies, FallsAsTheRootOfTheBodysMass)
{
	Scene<2> scene = crossed_by_a_spinning_disk();
	scene.friction = false;
	RigidBody<2>& body = scene.bodies[0];
	body.responds[0] = body.responds[1] = true;
	const auto critical = [&](double mass) {
		body.mass = scene.grains.back().mass = mass;
		return critical_time_step_of_bodies(scene);
	};
	// For a body much lighter than a grain the critical step depends on the body's mass only, and the dashpots of Hertz's law are
	// negligible.
	EXPECT_NEAR(critical(1e-8) / critical(1e-10), 10, 1e-3);
}

TEST(CriticalStepOfBodies, FallsWithTheMomentOfInertia)
{
	Scene<2> scene = crossed_by_a_spinning_disk();
	RigidBody<2>& body = scene.bodies[0];
	body.turns[0] = true, body.mass = 20;
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
	Scene<2> scene = crossed_by_a_spinning_disk();
	scene.cell.high[0] = 5.5;
	EXPECT_TRUE(mentions(complaint([&] { check_scene(scene); }), "two of its images: the period in x must be at least"));
}

}  // namespace
}  // namespace graindrive::loop
