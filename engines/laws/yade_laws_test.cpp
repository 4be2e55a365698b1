/// YADE's own laws as functions: their equations, Coulomb's bound, what is remembered, and bad input. loop/yade_laws_test.py
/// compares them with YADE.
#include "engines/laws/registry.hpp"

#include <gtest/gtest.h>

#include <string>

#include "engines/base/complaint.hpp"
#include "engines/laws/random_contacts.hpp"

using namespace graindrive;
using namespace graindrive::laws;

namespace {

constexpr Real young = 5e6, poisson = 0.3, mu = 0.5;

Kinematics<Real, Real> contact(Real overlap, Real v_n, Real v_t) { return { overlap, v_n, v_t, 0.25, 0.4, 1e-4 }; }

}  // namespace

TEST(CundallStrack, has_the_stiffness_of_two_springs_in_series)
{
	const auto law = cundall_strack(young, poisson, mu);
	const Real r1 = 0.5, r2 = 0.3, overlap = 1e-3;
	const Real k1 = young * 2 * r1, k2 = young * 2 * r2, k_n = k1 * k2 / (k1 + k2);
	const auto answer = law(Kinematics<Real, Real>{ overlap, 1, 0.01, r1 * r2 / (r1 + r2), 1, 1e-4 }, 2.0);
	EXPECT_NEAR(answer.normal, k_n * overlap, round_off * k_n * overlap);
	EXPECT_NEAR(answer.tangential, -(2.0 + poisson * k_n * 0.01 * 1e-4), round_off * 10);
	EXPECT_EQ(answer.slip, -answer.tangential);
}

TEST(CundallStrack, a_cut_force_is_remembered_as_the_bound)
{
	const auto law = cundall_strack(young, poisson, mu);
	const auto answer = law(contact(1e-3, 0, 1e-3), 1e6);
	EXPECT_TRUE(answer.slipping);
	EXPECT_EQ(answer.slip, mu * answer.normal);
	EXPECT_EQ(answer.tangential, -answer.slip);
}

TEST(HertzMindlin, is_hertz_with_mindlins_no_slip_stiffness)
{
	const auto law = hertz_mindlin(young, poisson, 0, 0, mu);
	const Real overlap = 2e-3, radius = 0.25, shear = young / (2 * (1 + poisson));
	const Real k = 4.0 / 3 * young / (2 * (1 - poisson * poisson)) * std::sqrt(radius);
	const auto answer = law(contact(overlap, -1, 0.02), 0.5);
	EXPECT_NEAR(answer.normal, k * std::pow(overlap, 1.5), round_off * answer.normal);
	const Real k_t = 8 * std::sqrt(radius * overlap) * shear / (2 * (2 - poisson));  // Mindlin 1949, of two equal bodies
	EXPECT_NEAR(answer.slip, 0.5 + k_t * 0.02 * 1e-4, round_off);
	EXPECT_EQ(answer.tangential, -answer.slip);
}

TEST(HertzMindlin, dashpots_are_fractions_of_critical_and_the_normal_force_never_pulls)
{
	const Real beta_n = 0.3, beta_t = 0.2, overlap = 2e-3, mass = 0.4, radius = 0.25;
	const auto law = hertz_mindlin(young, poisson, beta_n, beta_t, mu), elastic = hertz_mindlin(young, poisson, 0, 0, mu);
	const Real h = std::sqrt(radius * overlap), k_n = 2 * elastic.effective_young * h, k_t = 8 * elastic.effective_shear * h;
	const auto damped = law(contact(overlap, 0.1, 0.02), 0.0), plain = elastic(contact(overlap, 0.1, 0.02), 0.0);
	EXPECT_NEAR(plain.normal - damped.normal, 2 * beta_n * std::sqrt(mass * k_n) * 0.1, round_off * plain.normal);
	EXPECT_NEAR(plain.tangential - damped.tangential, 2 * beta_t * std::sqrt(mass * k_t) * 0.02, round_off * plain.normal);
	EXPECT_EQ(damped.slip, plain.slip);
	EXPECT_EQ(law(contact(overlap, 1000, 0), 0.0).normal, 0);
}

TEST(HertzMindlin, only_the_elastic_part_is_held_to_the_bound)
{
	const auto law = hertz_mindlin(young, poisson, 0.3, 0.9, mu);
	const Real bound = mu * law(contact(2e-3, 0, 0), 0.0).normal;
	const auto sticking = law(contact(2e-3, 0, 0.05), 0.9 * bound), slipping = law(contact(2e-3, 0, 0.05), 1.001 * bound);
	EXPECT_FALSE(sticking.slipping);
	EXPECT_GT(std::abs(sticking.tangential), bound);
	EXPECT_TRUE(slipping.slipping);
	EXPECT_EQ(slipping.tangential, -bound);
	EXPECT_EQ(slipping.slip, bound);
}

TEST(YadeLaws, refuse_properties_out_of_range_with_the_value)
{
	const auto says = [](const char* words, auto&& make) { EXPECT_TRUE(mentions(complaint(make), words)) << complaint(make); };
	says("Young's modulus must be positive [Pa], got -1", [] { cundall_strack(-1, 0.3, 0.5); });
	says("k_t/k_n (YADE's poisson) must not be negative, got -0.1", [] { cundall_strack(1e6, -0.1, 0.5); });
	says("friction coefficient must not be negative, got -2", [] { cundall_strack(1e6, 0.3, -2); });
	says("Poisson's ratio must lie in (-1, 0.5], got 0.6", [] { hertz_mindlin(1e6, 0.6, 0, 0, 0.5); });
	says("normal damping ratio must not be negative, got -0.2", [] { hertz_mindlin(1e6, 0.3, -0.2, 0, 0.5); });
	says("tangential damping ratio must not be negative, got -0.3", [] { hertz_mindlin(1e6, 0.3, 0, -0.3, 0.5); });
}
