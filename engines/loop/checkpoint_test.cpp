/// A resumed run equals an uninterrupted one to the last bit, and a damaged file is refused with the reason.
#include "engines/loop/checkpoint.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "engines/base/temporary_file.hpp"
#include "engines/laws/every_law.hpp"
#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

class Checkpoint : public ::testing::Test {
protected:
	const graindrive::test::TemporaryFile file;
	const std::string path = file.path();

	static Scene<2> busy()
	{
		Scene<2> scene = crowd(14, 11, 2);
		RigidBody<2> body;
		body.place[0] = 7, body.place[1] = 7, body.mass = 3, body.inertia = 1, body.responds[1] = true, body.spin = 1;
		scene.bodies = { body };
		for (const std::size_t i : { 100u, 101u }) scene.grains[i].body = 0;
		return scene;
	}

	std::string refusal() const
	{
		try {
			Stepper<2>::restore(path);
		} catch (const std::runtime_error& error) {
			return error.what();
		}
		return "";
	}

	void rewrite(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
	std::string contents() const
	{
		std::ifstream in(path, std::ios::binary);
		return { std::istreambuf_iterator<char>(in), {} };
	}
};

}  // namespace

TEST_F(Checkpoint, a_continued_run_has_the_bits_of_one_never_stopped)
{
	for (const Precision precision : { Precision::double_, Precision::single }) {
		Scene<2> scene = busy();
		scene.precision = precision;
		Stepper<2> straight(scene), first(scene);
		straight.step(900);
		first.step(457);
		first.save(path, "the caller's words");
		std::string words;
		const auto second = Stepper<2>::restore(path, 3, &words);
		EXPECT_EQ(words, "the caller's words");
		EXPECT_EQ(second->steps_done(), 457);
		second->step(443);
		first.step(443);
		EXPECT_TRUE(same_bits(straight, *second));
		EXPECT_TRUE(same_bits(straight, first));  // saving changes nothing
		EXPECT_EQ(straight.bodies()[0].place[1], second->bodies()[0].place[1]);
		EXPECT_EQ(straight.searches_done(), second->searches_done());
	}
}

TEST_F(Checkpoint, damaged_and_foreign_files_are_refused_with_the_reason)
{
	Stepper<2> loop(busy());
	loop.step(10);
	loop.save(path);
	const std::string good = contents();
	rewrite(good.substr(0, good.size() - 5));
	EXPECT_NE(refusal().find("truncated"), std::string::npos) << refusal();
	std::string flipped = good;
	flipped[good.size() / 2] ^= 1;
	rewrite(flipped);
	EXPECT_NE(refusal().find("damaged"), std::string::npos) << refusal();
	std::string newer = good;
	newer[16] = 77;
	rewrite(newer);
	EXPECT_NE(refusal().find("version 77"), std::string::npos) << refusal();
	rewrite("a poem");
	EXPECT_NE(refusal().find("not a checkpoint"), std::string::npos) << refusal();
	std::remove(path.c_str());
	EXPECT_NE(refusal().find("cannot be opened"), std::string::npos) << refusal();
}

TEST_F(Checkpoint, a_law_is_kept_by_its_name_with_every_constant)
{
	laws::for_every_law_by_default([](const auto& law) {
		Packer pack;
		visit_law(pack, law);
		Unpacker unpack(pack.bytes);
		ContactLaw kept;
		visit_law(unpack, kept);
		EXPECT_TRUE(laws::same(kept, law)) << law.name;
	});
	Packer pack;
	pack(std::string("thornton")), pack(std::vector<Real>{ 1, 2 });
	Unpacker unpack(pack.bytes);
	ContactLaw kept;
	try {
		visit_law(unpack, kept);
		FAIL() << "a law that this build does not have was taken";
	} catch (const std::runtime_error& error) {
		EXPECT_NE(std::string(error.what()).find("got thornton"), std::string::npos) << error.what();
	}
}

TEST_F(Checkpoint, a_failed_write_leaves_the_old_file)
{
	Stepper<2> loop(busy());
	EXPECT_THROW(loop.save("/nonexistent-folder/checkpoint"), std::runtime_error);
	loop.compute_body_forces();
	EXPECT_THROW(loop.save(path), std::runtime_error);  // in the middle of a step
}
