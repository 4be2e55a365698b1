/// Impacts of two spheres: against a plain loop, the prescribed restitution, and conservation laws.
#include <gtest/gtest.h>

#include "engines/loop/spheres/plain_spheres.hpp"

namespace graindrive::loop {

using namespace test;

namespace {

const ContactLaw all_laws[] = { laws::HertzHistory<Real>{ 2e5, 2.46e5, 50, 50, 0.3 }, laws::hertz_restitution(2e5, 0.3, 0.7, 0.4),
	laws::spring_dashpot(1e5, 3e4, 0.8, 0.5) };

Scene<3> two(const Grain<3>& a, const Grain<3>& b, const ContactLaw& law)
{
	Scene<3> s;
	s.grains = { a, b };
	s.law = law;
	s.dt = 1e-5;
	return s;
}

/// An oblique impact of unequal spheres that spin about all axes, along no axis of the box.
Scene<3> oblique(const ContactLaw& law)
{
	Grain<3> a = sphere({ 0.1, -0.2, 0.3 }, 0.5), b = sphere(a.place + (0.851 / 3) * Vec<3>{ 2, -1, 2 }, 0.35, 2);
	a.velocity = { 0.7, -0.1, 0.4 }, b.velocity = { -0.4, 0.5, -0.3 };
	a.spin = { 1, -2, 0.5 }, b.spin = { -0.7, 3, 2 };
	return two(a, b, law);
}

}  // namespace

TEST(SphereImpact, oblique_and_spinning_as_in_a_plain_loop)
{
	for (const ContactLaw& law : all_laws)
		for (const bool friction : { true, false }) {
			SCOPED_TRACE("law " + std::to_string(law.index()) + ", friction " + std::to_string(friction));
			Scene<3> scene = oblique(law);
			scene.friction = friction;
			Stepper<3> loop(scene);
			PlainSpheres plain(scene);
			const double before = plain.kinetic_energy();
			for (int k = 0; k < 4000; ++k) plain.step();
			loop.step(4000);
			EXPECT_GT(std::abs(plain.kinetic_energy() - before), 1e-3 * before);  // the spheres have collided
			for (int i = 0; i < 2; ++i) {
				const Grain<3> one = loop.grain(i), &other = plain.s.grains[i];
				// Some thousand steps of contact, each with a round-off of 1e-16 and a spring turned by 1e-5 rad (its length
				// changes by the fourth power).
				EXPECT_LT(norm(one.velocity - other.velocity), 1e-12) << i;
				EXPECT_LT(norm(one.spin - other.spin), 1e-11) << i;
				EXPECT_LT(norm(one.place - other.place), 1e-12) << i;
			}
		}
}

TEST(SphereImpact, normal_restitution_is_what_was_asked_for)
{
	// The damping follows from a linear oscillator whose contact ends when the overlap is zero again. Here the contact ends when
	// the force is zero, and Hertz's force is not linear; with Tsuji's damping e differs by less than a percent at any speed, and
	// so with the linear law.
	for (const double e : { 0.5, 0.7, 0.9 })
		for (const double speed : { 0.01, 1.0 }) {
			Grain<3> a = sphere({ 0, 0, 0 }, 0.5), b = sphere({ 0, 0, 1.0001 }, 0.5);
			b.velocity = { 0, 0, -speed };
			Scene<3> scene = two(a, b, laws::hertz_restitution(1e6, 0.3, e, 0.5));
			scene.dt = 2e-6;
			Stepper<3> loop(scene);
			loop.step(speed < 0.1 ? 60000 : 10000);
			EXPECT_NEAR((loop.grain(1).velocity - loop.grain(0).velocity)[2] / speed, e, 0.01) << e << " at " << speed;
			EXPECT_EQ(loop.grain(1).spin, Vec<3>{});
		}
}

TEST(SphereImpact, without_friction_and_damping_energy_comes_back)
{
	Grain<3> a = sphere({ 0, 0, 0 }, 0.5), b = sphere({ 0.3, 0.2, 0.95 }, 0.5);
	b.velocity = { 0, 0, -1 };
	Scene<3> scene = two(a, b, laws::HertzHistory<Real>{ 1e6, 1e6, 0, 0, 0 });
	scene.friction = false, scene.dt = 2e-6;
	Stepper<3> loop(scene);
	const double before = loop.kinetic_energy();
	loop.step(50000);
	EXPECT_GT(norm(loop.grain(0).velocity), 0.1);
	EXPECT_NEAR(loop.kinetic_energy() / before, 1, 1e-8);  // leapfrog's error of an impact is of order (dt / duration)^2
}

TEST(SphereImpact, a_held_sphere_feels_the_opposite_force_at_its_own_surface)
{
	Scene<3> scene = oblique(all_laws[1]);
	hold(scene, 1);
	Stepper<3> loop(scene);
	PlainSpheres plain(scene);
	for (int k = 0; k < 300; ++k) plain.step();
	loop.step(300);
	ASSERT_GT(norm(plain.force[1]), 0);
	EXPECT_LT(norm(loop.bodies()[0].force - plain.force[1]), 1e-10 * norm(plain.force[1]));
	EXPECT_LT(norm(loop.bodies()[0].torque - 0.35 * plain.turn[1]), 1e-10 * norm(plain.turn[1]));
	EXPECT_EQ(loop.grain(1).velocity, scene.grains[1].velocity);
}

}  // namespace graindrive::loop
