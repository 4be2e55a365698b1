/// Contact laws as functions: action and reaction, objectivity, two against three dimensions, float, tables, bad input.
#include "engines/laws/registry.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "engines/base/complaint.hpp"
#include "engines/laws/random_contacts.hpp"

using namespace graindrive;
using namespace graindrive::laws;

TEST(ContactLaws, partner_feels_the_opposite_force_to_the_last_bit)
{
	// Seen from j, the slip and the spring change sign and so must the force; the normal force and the branch must not change.
	for_random_contacts([](const auto& law, const auto& c, const Vector3r& spring) {
		const auto on_i = law(c, spring), on_j = law(with(c, Vector3r(-c.tangential_velocity)), Vector3r(-spring));
		EXPECT_EQ(on_j.tangential, Vector3r(-on_i.tangential));
		EXPECT_EQ(on_j.slip, Vector3r(-on_i.slip));
		EXPECT_EQ(on_j.normal, on_i.normal);
		EXPECT_EQ(on_j.slipping, on_i.slipping);
	});
}

TEST(ContactLaws, turn_with_the_observer)
{
	const Eigen::Matrix3d turn =
		(Eigen::AngleAxis<Real>(0.7, Vector3r::UnitX()) * Eigen::AngleAxis<Real>(-1.9, Vector3r::UnitZ())).matrix();
	for_random_contacts([&](const auto& law, const auto& c, const Vector3r& spring) {
		const auto here = law(c, spring), there = law(with(c, Vector3r(turn * c.tangential_velocity)), Vector3r(turn * spring));
		EXPECT_NEAR((there.tangential - turn * here.tangential).norm(), 0, round_off * (1 + here.tangential.norm()));
		EXPECT_NEAR((there.slip - turn * here.slip).norm(), 0, round_off * (here.slip.norm() + spring.norm()));
		EXPECT_EQ(there.normal, here.normal);
	});
}

TEST(ContactLaws, in_two_dimensions_are_the_three_dimensional_ones_in_a_plane)
{
	const Vector3r t = Vector3r(1, -2, 2) / 3;
	for_random_contacts([&](const auto& law, const auto& c, const Vector3r& spring) {
		const Real v_t = c.tangential_velocity.x(), s = spring.x();
		const auto flat = law(with(c, v_t), s);
		const auto solid = law(with(c, Vector3r(v_t * t)), Vector3r(s * t));
		EXPECT_EQ(flat.normal, solid.normal);
		EXPECT_NEAR((solid.tangential - flat.tangential * t).norm(), 0, round_off * (1 + std::abs(flat.tangential)));
		EXPECT_NEAR((solid.slip - flat.slip * t).norm(), 0, round_off * (std::abs(s) + std::abs(flat.slip)));
	});
}

template <class Single, class Double>
void expect_float_close(const Single& single, const Double& law)
{
	RandomContacts draw;
	for (int i = 0; i < 500; ++i) {
		const auto c = draw.contact(draw.vector());
		const Real v_t = c.tangential_velocity.x(), s = 1e-3 * draw.in(-1, 1);
		const auto exact = law(with(c, v_t), s);
		const Kinematics<float, float> f{ float(c.overlap), float(c.normal_velocity), float(v_t), float(c.effective_radius),
			float(c.effective_mass), float(c.dt) };
		const auto rounded = single(f, float(s));
		static_assert(std::is_same_v<decltype(rounded.normal), float>);
		// Spring and dashpot may nearly cancel, so the error is measured against the larger of the two, found without damping and
		// without spring.
		const auto still = law(Kinematics<Real, Real>{ c.overlap, 0, 0, c.effective_radius, c.effective_mass, c.dt }, 0.0);
		const Real scale = std::abs(still.normal) + std::abs(exact.normal - still.normal);
		EXPECT_NEAR(rounded.normal, exact.normal, 2e-6 * scale);  // some twelve round-offs of 6e-8
		EXPECT_LE(std::abs(rounded.tangential), law.mu * std::abs(rounded.normal) * (1 + 1e-6));
		if (rounded.slipping && exact.slipping) {
			EXPECT_NEAR(rounded.tangential, exact.tangential, 2e-6 * law.mu * scale);
		}
	}
}

TEST(ContactLaws, work_in_single_precision)
{
	expect_float_close(
		HertzHistory<float>{ 2e6f, 2.46e6f, 2500, 2500, 0.5f }, HertzHistory<Real>{ 2e6, 2.46e6, 2500, 2500, 0.5 });
	const auto hertz = hertz_restitution(5e6, 0.45, 0.6, 0.5);
	expect_float_close(HertzRestitution<float>{ float(hertz.effective_young), float(hertz.tangential_ratio),
						   float(hertz.damping_fraction), 0.5f },
		hertz);
	const auto linear = spring_dashpot(2e5, 2e5 * 2 / 7, 0.92, 0.5);
	expect_float_close(SpringDashpot<float>{ float(linear.k_n), float(linear.k_t), float(linear.damping), 0.5f }, linear);
}

TEST(HertzRestitution, reproduces_table_one_of_guillard)
{
	const Real d = 1.5e-3, mass = 2500 * pi * d * d * d / 6;
	const auto law = hertz_restitution(5e6, 0.45, 0.6, 0.5);
	const Real k_grain = law.effective_young * 4 / 3 * std::sqrt(d / 4), k_plane = law.effective_young * 4 / 3 * std::sqrt(d / 2);
	EXPECT_NEAR(k_grain, 81e3, 0.5e3);  // tolerances: half a unit of the last printed digit
	EXPECT_NEAR(k_plane, 114e3, 0.5e3);
	EXPECT_NEAR(std::sqrt(5.0) * law.damping_fraction * std::sqrt(mass / 2 * k_grain), 0.15, 0.005);
	EXPECT_NEAR(std::sqrt(5.0) * law.damping_fraction * std::sqrt(mass * k_plane), 0.26, 0.005);
}

TEST(ContactLaws, refuse_properties_out_of_range_with_the_value)
{
	for (const Real e : { 0.0, -0.1, 1.1, std::nan("") })
		EXPECT_NE(complaint([&] { damping_fraction(e); }).find("(0, 1]"), std::string::npos) << e;
	EXPECT_NE(complaint([] { hertz_restitution(-5e6, 0.45, 0.6, 0.5); }).find("got -5e+06"), std::string::npos);
	EXPECT_NE(complaint([] { hertz_restitution(5e6, 0.6, 0.6, 0.5); }).find("Poisson's ratio"), std::string::npos);
	EXPECT_NE(complaint([] { hertz_restitution(5e6, 0.45, 0.6, -1); }).find("friction"), std::string::npos);
	EXPECT_NE(complaint([] { spring_dashpot(0, 1, 0.9, 0.5); }).find("normal stiffness"), std::string::npos);
	EXPECT_NE(complaint([] { spring_dashpot(1, -1, 0.9, 0.5); }).find("tangential stiffness"), std::string::npos);
	EXPECT_EQ(damping_fraction(1), 0);
}
