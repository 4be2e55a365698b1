/// The tangential spring turns with the contact: it stays in the tangent plane and keeps its length.
#include <gtest/gtest.h>

#include "engines/base/real.hpp"
#include "engines/loop/spheres/contact_pack.hpp"

namespace graindrive::loop {

namespace {

using Number = Pack<double, 2>;
using Law = laws::HertzHistory<double>;

Vector3<Number> packed(const Vector3r& v) { return { Number(v.x()), Number(v.y()), Number(v.z()) }; }
Vector3r first_of(const Vector3<Number>& v) { return { v.x.v[0], v.y.v[0], v.z.v[0] }; }

/// One step of two spheres that roll over each other without slip: leapfrog turns their centre line from `before` to `now`, and
/// their surfaces have the same velocity.
ContactForces<Number> roll(const Vector3r& before, const Vector3r& now, const Vector3r& spring, double dt)
{
	const Vector3r dv = (now - before) / dt, n = now.normalized(), surface = n.cross(dv);  // (n x dv) x n = dv - (dv.n) n
	const double columns[10] = { now.x(), now.y(), now.z(), 1, dv.x(), dv.y(), dv.z(), surface.x(), surface.y(), surface.z() };
	Number column[10];
	for (int c = 0; c < 10; ++c) column[c] = Number(columns[c]);
	ContactPack<Number> contact{};
	EXPECT_TRUE((contact_pack<Law, true>(column, contact)));
	return contact_forces<true>(Law{ 1e3, 1e3, 0, 0, 1e9 }, contact, packed(spring), Number(1), Number(1), Number(dt));
}

}  // namespace

TEST(SphereRolling, the_tangential_force_stays_tangent_and_as_strong_about_two_axes)
{
	// Each step changes the length by less than the fourth power of its angle, 1e-16, and by round-off, which adds up as a random
	// walk.
	const double angle = 1e-4, dt = 1e-3;
	Vector3r d(0, 0, 0.99), spring(3e-3, -2e-3, 0);
	double first = 0;
	for (const Vector3r& axis : { Vector3r(1, 2, 0.5).normalized(), Vector3r(-1, 0.3, 2).normalized() }) {
		const Vector3r start = d;
		for (int k = 1; k <= 10000; ++k) {
			const Vector3r now = Eigen::AngleAxisd(k * angle, axis) * start;
			const auto answer = roll(d, now, spring, dt);
			d = now, spring = first_of(answer.spring);
			const Vector3r twist = first_of(answer.turn);
			if (first == 0) first = twist.norm();
			ASSERT_NEAR(spring.dot(d.normalized()) / spring.norm(), 0, 1e-12) << k;
			ASSERT_NEAR(twist.norm() / first, 1, 1e-12) << k;
		}
	}
	EXPECT_NEAR(spring.norm() / Vector3r(3e-3, -2e-3, 0).norm(), 1, 1e-12);
}

TEST(SphereRolling, the_spring_turns_by_the_rotation_of_the_centre_line)
{
	// If the centre line turns about an axis across it, the spring turns with it: after a quarter turn it is the spring turned by
	// that angle.
	const Vector3r axis(0, 1, 0), start(2e-3, 1e-3, 0);
	const int steps = 15708;
	const double angle = pi / 2 / steps;
	Vector3r d(0, 0, 0.99), spring = start;
	for (int k = 0; k < steps; ++k) {
		const Vector3r now = Eigen::AngleAxisd(angle, axis) * d;
		spring = first_of(roll(d, now, spring, 1e-3).spring);
		d = now;
	}
	const Vector3r expected = Eigen::AngleAxisd(pi / 2, axis) * start;
	EXPECT_LT((spring - expected).norm() / start.norm(), 1e-11);
}

}  // namespace graindrive::loop
