/// The search finds every pair within the skin exactly once and in order, compared with a loop over all pairs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <set>

#include "engines/loop/pair_geometry.hpp"
#include "engines/loop/spheres/sphere_search.hpp"

namespace graindrive::loop {

namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

struct Crowd {
	State<3> state;
	SphereGrid grid;

	Crowd(const std::array<double, 3>& size, const std::array<bool, 3>& periodic, unsigned seed)
	{
		std::mt19937 random(seed);
		const auto in = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
		Cell<3>& cell = state.scene.cell;
		for (int k = 0; k < 3; ++k) cell.low[k] = -1, cell.high[k] = size[k] - 1, cell.periodic[k] = periodic[k];
		const std::uint32_t n_free = size[0] * size[1] * size[2], n_members = 40;
		for (std::uint32_t i = 0; i < n_free + n_members; ++i) {
			Grain<3> grain;
			for (int k = 0; k < 3; ++k) grain.place[k] = in(cell.low[k], cell.high[k]);
			grain.radius = i < n_free ? in(0.4, 0.5) : in(0.3, 1.2);
			grain.body = i < n_free ? free_grain : i % 3;
			if (i >= n_free) state.members.push_back({ {}, {}, grain.body });
			state.scene.grains.push_back(grain);
			state.index_of.push_back(i);
		}
		state.scene.bodies.resize(3);
		state.body_fixed = { 1, 1, 0 };
		state.skin = 0.2;
		state.derive();
		for (const Grain<3>& g : state.scene.grains) {
			SphereRow row{};
			row.x = g.place, row.radius = g.radius;
			state.rows.push_back(row);
		}
		grid.lay(state.rows.data(), n_free, cell, 1 + state.skin);
		std::vector<std::uint32_t> order;
		grid.sort(state.rows.data(), n_free, order);
		const RowVector<3> unsorted(state.rows);
		for (std::uint32_t at = 0; at < n_free; ++at) state.rows[at] = unsorted[order[at]];
	}

	int body(std::uint32_t row) const { return row < state.n_free ? free_grain : state.members[row - state.n_free].body; }
	bool may_meet(std::uint32_t a, std::uint32_t b) const
	{
		if (body(a) == free_grain || body(b) == free_grain) return true;
		return body(a) != body(b) && !(state.body_fixed[body(a)] && state.body_fixed[body(b)]);
	}

	/// All pairs nearer than the skin plus `more`.
	Pairs all(double more) const
	{
		Pairs pairs;
		for (std::uint32_t a = 0; a < state.n; ++a)
			for (std::uint32_t b = a + 1; b < state.n; ++b) {
				const SphereRow &one = state.rows[a], &other = state.rows[b];
				const double limit = one.radius + other.radius + state.skin + more;
				if (may_meet(a, b) && geometry::norm(separation<3>(one, other, state.scene.cell)) < limit) pairs.insert({ a, b });
			}
		return pairs;
	}
};

void check_found(const Crowd& crowd, int shares)
{
	SphereSearch search;
	search.begin(crowd.state, crowd.grid);
	const SphereKernel kernel = choose_sphere_kernel({ 0, true, Precision::double_ });
	std::vector<std::uint32_t> count(crowd.state.n_free, 0);
	std::vector<Partner> partners, some;
	std::uint32_t first = 0;
	for (int t = 1; t <= shares; ++t) {
		const std::uint32_t end = t < shares ? search.cell_at(crowd.state.n_free * t / shares) : crowd.grid.cells();
		search.find(kernel, first, end, count.data(), some);
		partners.insert(partners.end(), some.begin(), some.end());
		first = end;
	}
	Pairs found;
	std::size_t next = 0;
	for (std::uint32_t a = 0; a < crowd.state.n_free; ++a) {
		std::uint32_t last = a;
		for (std::uint32_t k = 0; k < count[a]; ++k, ++next) {
			const Partner partner = partners[next];
			ASSERT_GT(partner.row(), last) << a;  // in order, and once
			last = partner.row();
			found.insert({ a, last });
			const Vec<3> d = crowd.state.rows[last].x - crowd.state.rows[a].x;
			const bool image = geometry::norm(crowd.state.scene.cell.nearest(d).at - d) > 1e-9;
			ASSERT_EQ(partner.wrapped(), image) << a << " " << last;
		}
	}
	ASSERT_EQ(next, partners.size());
	for (const MemberPair& pair : search.among_members()) EXPECT_TRUE(found.insert({ pair.owner, pair.member }).second);
	const Pairs must = crowd.all(-1e-4), may = crowd.all(1e-4);  // the columns are in single precision
	EXPECT_GT(must.size(), crowd.state.n_free);
	EXPECT_TRUE(std::includes(found.begin(), found.end(), must.begin(), must.end()));
	EXPECT_TRUE(std::includes(may.begin(), may.end(), found.begin(), found.end()));
}

}  // namespace

TEST(SphereSearch, finds_what_all_pairs_find)
{
	const std::array<double, 3> long_one = { 50, 8, 6 }, wide_one = { 24, 23, 5 }, small = { 4, 4, 4 };
	for (const auto& size : { long_one, wide_one, small })
		for (const auto& periodic : { std::array<bool, 3>{ false, false, false }, std::array<bool, 3>{ true, true, false },
				 std::array<bool, 3>{ true, true, true } })
			check_found(Crowd(size, periodic, 7), 3);
}

TEST(SphereSearch, every_processor_finds_them)
{
	for (const Processor processor : processors_supported()) {
		setenv("GRAINDRIVE_PROCESSOR", name_of(processor).c_str(), 1);
		check_found(Crowd({ 22, 21, 4 }, { true, false, false }, 9), 1);
	}
	unsetenv("GRAINDRIVE_PROCESSOR");
}

}  // namespace graindrive::loop
