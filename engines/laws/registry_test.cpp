/// The registry: names, constants and their ranges, other number types.
#include "engines/laws/registry.hpp"

#include <gtest/gtest.h>

#include <set>

#include "engines/base/complaint.hpp"
#include "engines/laws/every_law.hpp"

using namespace graindrive;
using namespace graindrive::laws;

TEST(Registry, finds_every_law_by_its_own_name)
{
	std::set<std::string> names;
	for_every_law_by_default([&](const auto& law) {
		EXPECT_STREQ(name_of(law_named(law.name)), law.name);
		EXPECT_EQ(law_named(law.name).index(), ContactLaw(law).index());
		names.insert(law.name);
	});
	EXPECT_EQ(names.size(), Laws::size);
	const std::string refusal = complaint([] { law_named("mindlin"); });
	for (const std::string& name : names) EXPECT_TRUE(mentions(refusal, "'" + name + "'")) << refusal;
	EXPECT_TRUE(mentions(refusal, "or 'hertzMindlin', got mindlin")) << refusal;
}

TEST(Registry, a_law_is_its_name_and_constants)
{
	for_every_law_by_default([](const auto& law) {
		const std::vector<Real> constants = constants_of(law);
		EXPECT_EQ(constants.size() * sizeof(Real), sizeof law) << law.name << " lists each of its numbers once";
		EXPECT_TRUE(same(law_with(law.name, constants), law));
		auto other = law;
		other.mu += 0.1;
		EXPECT_FALSE(same(other, law));
		EXPECT_TRUE(mentions(complaint([&] { law_with(law.name, { 1, 2 }); }), "constants, got 2"));
	});
}

TEST(Registry, other_number_types_have_the_same_constants_rounded)
{
	for_every_law_by_default([](const auto& law) {
		const Laws::Any<float> single = converted<float>(law);
		EXPECT_EQ(single.index(), ContactLaw(law).index());
		std::vector<Real> rounded;
		std::visit([&](const auto& l) { l.constants([&](const Quantity&, auto c) { rounded.push_back(l.*c); }); }, single);
		std::vector<Real> expected;
		for (const Real number : constants_of(law)) expected.push_back(float(number));
		EXPECT_EQ(rounded, expected);
		const Laws::Any<Real> whole = converted<Real>(law);
		EXPECT_TRUE(same(whole, law));
	});
}

TEST(Registry, constants_out_of_range_are_refused_with_law_rule_and_value)
{
	for_every_law_by_default([](auto law) {
		EXPECT_EQ(complaint([&] { require_in_range(ContactLaw(law)); }), "");
		for (const Real bad : { -1.0, std::nan(""), double(INFINITY) }) {
			law.constants([&](const Quantity& quantity, auto constant) {
				auto changed = law;
				changed.*constant = bad;
				const std::string refusal = complaint([&] { require_in_range(ContactLaw(changed)); });
				EXPECT_TRUE(mentions(refusal, std::string("law ") + law.name + ": " + quantity.meaning + " must ")) << refusal;
				EXPECT_TRUE(mentions(refusal, ", got ")) << refusal;
			});
		}
	});
}

TEST(Registry, a_material_out_of_range_is_refused)
{
	for_every_law_by_default([](auto law) {
		using Law = decltype(law);
		using Given = typename Law::Given;
		Given::quantities([&](const Quantity& quantity, auto member) {
			Given given;
			given.*member = -2;
			EXPECT_TRUE(mentions(complaint([&] { Law::of(given, 0.5); }), std::string(quantity.meaning) + " must "));
		});
		EXPECT_EQ(complaint([] { Law::of(Given{}, -0.5); }), "friction coefficient must not be negative, got -0.5");
	});
	EXPECT_EQ(complaint([] {
		HertzHistory<>::of({ 1, 0, 0, 0 }, 0);
	}),
		"tangential stiffness must be positive [Pa] (friction=0 switches tangential forces off), got 0");
	EXPECT_EQ(
		complaint([] { spring_dashpot(INFINITY, 1, 0.5, 0); }), "normal stiffness must be positive and finite [N/m], got inf");
}

TEST(Registry, explains_a_number_by_the_laws_that_take_it)
{
	EXPECT_EQ(
		explained("normalStiffness"), "normal stiffness, K_n [Pa] (hertzHistory); normal stiffness, k_n [N/m] (springDashpot)");
	EXPECT_EQ(explained("young"), "Young's modulus, E [Pa] (hertzRestitution, cundallStrack, hertzMindlin)");
	EXPECT_EQ(listed({ "a", "b", "c" }, " or ", "'"), "'a', 'b' or 'c'");
	EXPECT_EQ(listed({ "a" }, " or "), "a");
}
