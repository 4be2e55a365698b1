/// The friction mu(I) of flowing grains against its definition, its slope against finite differences, and the range of well-posed
/// equations.
#include "engines/laws/rheology.hpp"

#include <gtest/gtest.h>

namespace graindrive::laws {
namespace {

constexpr Real inertial_numbers[] = { 1e-9, 1e-5, 1e-3, 0.0034, 0.0037, 0.02, 0.133, 1, 30 };

TEST(MuOfI, goes_from_slow_to_fast_friction_and_is_halfway_at_I_0)
{
	const MuOfI law({ 0.246, 0.401, 0.133 });
	EXPECT_DOUBLE_EQ(law.friction(0), 0.246);
	EXPECT_NEAR(law.friction(0.133), (0.246 + 0.401) / 2, 1e-15);
	EXPECT_NEAR(law.friction(1e9), 0.401, 1e-9);
}

template <class Friction>
void expect_slope_by_differences(const Friction& law)
{
	for (const Real I : inertial_numbers) {
		const Real h = 1e-5 * I, difference = (law.friction(I + h) - law.friction(I - h)) / (2 * h);
		const Real rounding = 1e-15 * law.friction(I) / h;
		EXPECT_NEAR(law.slope(I), difference, 1e-6 * difference + rounding) << "at I = " << I;
	}
}

TEST(MuOfI, slope_is_the_derivative) { expect_slope_by_differences(MuOfI()); }
TEST(RegularisedMuOfI, slope_is_the_derivative) { expect_slope_by_differences(RegularisedMuOfI()); }

TEST(MuOfI, is_ill_posed_in_slow_and_in_fast_flow)
{
	const WellPosed range = well_posed_range(MuOfI({ 0.246, 0.401, 0.133 }));
	// Roots of the criterion's polynomial in I, by an independent root finder (Brent's method in Python's scipy).
	EXPECT_NEAR(range.low, 0.00353292658, 1e-11);
	EXPECT_NEAR(range.high, 1.16229044264, 1e-10);
}

TEST(MuOfI, constant_friction_is_ill_posed_everywhere)
{
	const MuOfI law({ 0.3, 0.3, 0.1 });
	for (const Real I : inertial_numbers) EXPECT_NEAR(ill_posedness(law, I), 0.09, 1e-15);
	EXPECT_GT(well_posed_range(law).low, well_posed_range(law).high);
}

TEST(RegularisedMuOfI, is_well_posed_from_rest_to_fast_flow)
{
	const RegularisedMuOfI law;
	for (Real I = 1e-12; I < 20; I *= 1.01) EXPECT_LE(ill_posedness(law, I), 1e-9) << "at I = " << I;
}

TEST(RegularisedMuOfI, equals_the_plain_law_in_between_and_vanishes_at_rest)
{
	const MuOfI plain;
	const RegularisedMuOfI law(FrictionConstants{}, 0);
	for (const Real I : { 0.004, 0.02, 0.5 }) EXPECT_NEAR(law.friction(I), plain.friction(I), 1e-14);
	EXPECT_EQ(law.friction(0), 0);
	const Real below = law.friction(law.neutral()), above = law.friction(law.neutral() * (1 + 1e-12));
	EXPECT_NEAR(below, above, 1e-9);
}

TEST(Rheology, refuses_constants_that_make_no_friction)
{
	EXPECT_THROW(MuOfI({ -0.1, 0.4, 0.1 }), std::invalid_argument);
	EXPECT_THROW(MuOfI({ 0.4, 0.3, 0.1 }), std::invalid_argument);
	EXPECT_THROW(MuOfI({ 0.2, 0.3, 0 }), std::invalid_argument);
	EXPECT_THROW(RegularisedMuOfI({ 0.3, 0.3, 0.1 }), std::invalid_argument);
	EXPECT_THROW(RegularisedMuOfI(FrictionConstants{}, -1), std::invalid_argument);
}

TEST(GranularFluid, shear_stress_is_friction_times_pressure)
{
	const GranularFluid<MuOfI> fluid{ MuOfI(), 1.1 };
	for (const Real rate : { 1e-4, 0.1, 7.0 })
		for (const Real pressure : { 1e-5, 0.3, 60.0 }) {
			const Real I = rate * 1.1 / std::sqrt(pressure);
			EXPECT_NEAR(fluid.viscosity(rate, pressure) * rate / pressure, MuOfI().friction(I), 1e-14);
		}
}

TEST(BinghamFluid, yields_at_its_yield_stress)
{
	const BinghamFluid fluid{ 2, 0.5 };
	EXPECT_NEAR(fluid.viscosity(1e-9, 0) * 1e-9, 2, 1e-8);
	EXPECT_NEAR(fluid.viscosity(4, 0) * 4, 2 + 0.5 * 4, 1e-14);
}

}  // namespace
}  // namespace graindrive::laws
