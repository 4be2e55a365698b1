/// Contact laws against closed forms: impact energy, restitution, stick and slip, conservation, objectivity.
#include "engines/laws/contact_laws.hpp"

#include <gtest/gtest.h>

using namespace graindrive;
using namespace graindrive::laws;

TEST(HertzRestitution, reproduces_table_one_of_guillard)
{
	const Real d = 1.5e-3, mass = 2500 * pi * d * d * d / 6;
	const auto law = hertz_restitution(5e6, 0.45, 0.6, 0.5);
	const Real k_grain = law.effective_young * 4 / 3 * std::sqrt(d / 4), k_plane = law.effective_young * 4 / 3 * std::sqrt(d / 2);
	EXPECT_NEAR(k_grain, 81e3, 0.5e3);   // tolerances: half a unit of the printed digit
	EXPECT_NEAR(k_plane, 114e3, 0.5e3);
	EXPECT_NEAR(std::sqrt(5.0) * law.damping_fraction * std::sqrt(mass / 2 * k_grain), 0.15, 0.005);
	EXPECT_NEAR(std::sqrt(5.0) * law.damping_fraction * std::sqrt(mass * k_plane), 0.26, 0.005);
}
