/// The kernels for all processors give the same results: AVX2 and AVX-512 to the last bit, portable code within round-off.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "engines/loop/test_scenes.hpp"

namespace graindrive::loop {

using namespace test;

namespace {

const ContactLaw all_laws[] = { hertz(0.3, 500), laws::hertz_restitution(2e5, 0.3, 0.7, 0.4),
	laws::spring_dashpot(1e5, 3e4, 0.8, 0.5), laws::CundallStrack<Real>{ 1e5, 0.3, 0.4 },
	laws::HertzMindlin<Real>{ 2e5, 1e5, 0.1, 0.1, 0.4 } };

static_assert(std::size(all_laws) == laws::Laws::size, "every law of the registry stands here once");

/// Settling disks, periodic in x, above a row of frozen disks, with a free clump of two.
Scene<2> settling(const ContactLaw& law, Precision precision, bool friction)
{
	constexpr int side = 14;
	Scene<2> s = crowd(side, 5, 0.5);
	s.law = law, s.precision = precision, s.friction = friction;
	s.gravity[1] = -1;
	s.cell.periodic[1] = false;
	RigidBody<2> clump;
	clump.place[0] = 6, clump.place[1] = 6, clump.mass = 3, clump.inertia = 0.5;
	clump.responds[0] = clump.responds[1] = clump.turns[0] = true;
	RigidBody<2> base;
	base.frozen = true;
	s.bodies = { clump, base };
	for (std::size_t i : { 90u, 91u }) s.grains[i].body = 0, s.grains[i].mass = 3;
	for (int k = 0; k < side; ++k) {
		Grain<2> g = disk(k + 0.5, -0.5, 0.5, 1);
		g.mass = HUGE_VAL;
		s.grains.push_back(g);
	}
	return s;
}

/// Positions, velocities and spins after some steps with a processor's kernels; nothing if this machine cannot run them.
std::optional<std::vector<double>> moved(const Scene<2>& scene, const char* processor, long steps)
{
	setenv("GRAINDRIVE_PROCESSOR", processor, 1);
	std::optional<std::vector<double>> numbers;
	try {
		Stepper<2> loop(scene);
		loop.step(steps);
		numbers.emplace();
		for (std::size_t i = 0; i < loop.size(); ++i) {
			const Grain<2> g = loop.grain(i);
			numbers->insert(numbers->end(), { g.place[0], g.place[1], g.velocity[0], g.velocity[1], g.spin });
		}
	} catch (const std::invalid_argument& error) {
		EXPECT_NE(std::string(error.what()).find("supported by this processor"), std::string::npos) << error.what();
	}
	unsetenv("GRAINDRIVE_PROCESSOR");
	return numbers;
}

template <class Compare>
void for_every_law(const Compare& compare)
{
	for (const ContactLaw& law : all_laws)
		for (Precision precision : { Precision::double_, Precision::single })
			for (bool friction : { true, false }) {
				SCOPED_TRACE("law " + std::to_string(law.index()) + ", friction " + std::to_string(friction) + ", single " +
							 std::to_string(precision == Precision::single));
				compare(settling(law, precision, friction), precision);
			}
}

}  // namespace

TEST(Kernels, avx2_and_avx512_give_the_same_bits)
{
	for_every_law([](const Scene<2>& scene, Precision) {
		const auto narrow = moved(scene, "avx2", 2000), wide = moved(scene, "avx512", 2000);
		if (narrow && wide) {
			EXPECT_EQ(*narrow, *wide);
		}
	});
}

TEST(Kernels, portable_code_computes_the_same_to_round_off)
{
	for_every_law([](const Scene<2>& scene, Precision precision) {
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

TEST(Kernels, an_unknown_processor_is_refused)
{
	setenv("GRAINDRIVE_PROCESSOR", "abacus", 1);
	EXPECT_THROW(Stepper<2>{ crowd(12, 8) }, std::invalid_argument);
	unsetenv("GRAINDRIVE_PROCESSOR");
}

}  // namespace graindrive::loop
