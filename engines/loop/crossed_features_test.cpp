/// All features of a scene combined in small scenes: law, friction, rotation, gravity, damping, box, frozen grains, precision,
/// threads.
#include <gtest/gtest.h>

#include "engines/base/temporary_file.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

constexpr int side = 7, steps = 60;
const ContactLaw every_law[] = { hertz(), laws::hertz_restitution(2e5, 0.3, 0.7, 0.4), laws::spring_dashpot(1e5, 3e4, 0.8, 0.5),
	laws::cundall_strack(2e5, 0.3, 0.4), laws::hertz_mindlin(2e5, 0.3, 0.2, 0.1, 0.4) };

struct Features {
	int law;
	bool friction, rotation, gravity, periodic_x, periodic_y, frozen, damping;
};

Scene<2> scene_with(const Features& f)
{
	Scene<2> s = crowd(side, 11);
	s.law = every_law[f.law];
	s.friction = f.friction, s.rotation = f.rotation;
	if (f.gravity) s.gravity[0] = 0.3, s.gravity[1] = -1;
	s.cell.periodic[0] = f.periodic_x, s.cell.periodic[1] = f.periodic_y;
	if (f.damping) s.damping = 0.3, s.damps_gravity = f.periodic_x;
	if (!f.frozen) return s;
	s.bodies.push_back({});
	s.bodies[0].frozen = true;
	for (int i = 0; i < side; ++i) s.grains[i].body = 0, s.grains[i].velocity[0] = s.grains[i].velocity[1] = s.grains[i].spin = 0;
	return s;
}

/// Calls visit(features) for each combination. Damping is the parity of the others, so that all combinations of any six of the
/// seven occur.
template <class Visitor>
void cross(Visitor&& visit)
{
	for (int law = 0; law < 5; ++law)
		for (int bits = 0; bits < 64; ++bits) {
			const auto on = [&](int bit) { return bool(bits >> bit & 1); };
			visit(Features{ law, on(0), on(1), on(2), on(3), on(4), on(5), bool(on(0) ^ on(1) ^ on(2) ^ on(3) ^ on(4) ^ on(5)) });
		}
}

std::string name_of(const Features& f)
{
	return "law " + std::to_string(f.law) + (f.friction ? ", friction" : "") + (f.rotation ? ", rotation" : "") +
	       (f.gravity ? ", gravity" : "") + (f.periodic_x ? ", periodic x" : "") + (f.periodic_y ? ", periodic y" : "") +
	       (f.frozen ? ", frozen" : "") + (f.damping ? ", damping" : "");
}

}  // namespace

TEST(CrossedFeatures, follow_the_plain_loop_on_threads_and_in_single_precision)
{
	int crossed = 0;
	cross([&](const Features& f) {
		SCOPED_TRACE(name_of(f));
		Scene<2> scene = scene_with(f);
		Stepper<2> one(scene);
		PlainLoop plain(scene);
		scene.threads = crossed++ % 7 == 0 ? 3 : 1;  // rarely, since threads are slow on a busy machine
		Stepper<2> three(scene);
		scene.threads = 1;
		scene.precision = Precision::single;
		Stepper<2> single(scene);
		for (int k = 0; k < steps; ++k) plain.step();
		one.step(steps), three.step(steps), single.step(steps);
		const auto from_plain = [&](const Stepper<2>& loop) {
			return largest_difference(
				scene, [&](std::size_t i) { return loop.grain(i); }, [&](std::size_t i) { return plain.s.grains[i]; });
		};
		EXPECT_LT(from_plain(one), 1e-11);    // round-off of 60 steps of forces of order 1e4 on masses of order 1
		EXPECT_LT(from_plain(single), 1e-3);  // the same with a round-off of 6e-8 in place of 1e-16
		EXPECT_TRUE(same_bits(one, three));
	});
}

TEST(CrossedFeatures, go_on_from_a_checkpoint_to_the_last_bit)
{
	const graindrive::test::TemporaryFile file;
	cross([&](const Features& f) {
		SCOPED_TRACE(name_of(f));
		Stepper<2> straight(scene_with(f)), stopped(scene_with(f));
		straight.step(steps);
		stopped.step(steps / 2);
		stopped.save(file.path());
		const auto resumed = Stepper<2>::restore(file.path(), 2);
		resumed->step(steps - steps / 2);
		EXPECT_TRUE(same_bits(straight, *resumed));
	});
}
