/// The search finds every pair within the skin, once, in order: held to all pairs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <set>

#include "engines/loop/spheres/sphere_search.hpp"

namespace graindrive::loop {

namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

struct Crowd {
	std::vector<SphereRow> rows;
	std::uint32_t n_free;
	SphereBox box;
	SphereGrid grid;
	double skin = 0.2;

	Crowd(const std::array<double, 3>& size, const std::array<bool, 3>& periodic, unsigned seed)
	{
		std::mt19937 random(seed);
		const auto in = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
		for (int k = 0; k < 3; ++k) box.low[k] = -1, box.high[k] = size[k] - 1;
		box.periodic = periodic;
		n_free = size[0] * size[1] * size[2];
		const std::uint32_t n_held = 40;
		for (std::uint32_t i = 0; i < n_free + n_held; ++i) {
			SphereRow row{};
			for (int k = 0; k < 3; ++k) row.x[k] = in(box.low[k], box.high[k]);
			row.radius = i < n_free ? in(0.4, 0.5) : in(0.3, 1.2);
			rows.push_back(row);
		}
		grid.lay(rows.data(), n_free, box, 1 + skin);
		std::vector<std::uint32_t> order;
		grid.sort(rows.data(), n_free, order);
		std::vector<SphereRow> sorted(rows);
		for (std::uint32_t at = 0; at < n_free; ++at) sorted[at] = rows[order[at]];
		rows.swap(sorted);
	}

	/// Those nearer than the skin, more or less.
	Pairs all(double more) const
	{
		Pairs pairs;
		for (std::uint32_t a = 0; a < n_free; ++a)
			for (std::uint32_t b = a + 1; b < rows.size(); ++b) {
				double d[3];
				separation(rows[a], rows[b], box, d);
				const double limit = rows[a].radius + rows[b].radius + skin + more;
				if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < limit * limit) pairs.insert({ a, b });
			}
		return pairs;
	}
};

void check_found(const Crowd& crowd, int shares)
{
	SphereSearch search;
	search.begin(crowd.rows.data(), crowd.n_free, crowd.rows.size(), crowd.grid, crowd.box, crowd.skin);
	const SphereKernel kernel = choose_sphere_kernel({ 0, true, Precision::double_ });
	std::vector<std::uint32_t> count(crowd.n_free, 0);
	std::vector<Partner> partners, some;
	std::uint32_t first = 0;
	for (int t = 1; t <= shares; ++t) {
		const std::uint32_t end = t < shares ? search.cell_at(crowd.n_free * t / shares) : crowd.grid.cells();
		search.find(kernel, first, end, count.data(), some);
		partners.insert(partners.end(), some.begin(), some.end());
		first = end;
	}
	Pairs found;
	std::size_t next = 0;
	for (std::uint32_t a = 0; a < crowd.n_free; ++a) {
		std::uint32_t last = a;
		for (std::uint32_t k = 0; k < count[a]; ++k, ++next) {
			const Partner partner = partners[next];
			ASSERT_GT(partner.row(), last) << a;  // in order, and once
			last = partner.row();
			found.insert({ a, last });
			double d[3];
			separation(crowd.rows[a], crowd.rows[last], crowd.box, d);
			bool image = false;
			for (int k = 0; k < 3; ++k) image |= std::abs(d[k] - (crowd.rows[last].x[k] - crowd.rows[a].x[k])) > 1e-9;
			ASSERT_EQ(partner.wrapped(), image) << a << " " << last;
		}
	}
	ASSERT_EQ(next, partners.size());
	const Pairs must = crowd.all(-1e-4), may = crowd.all(1e-4);  // the columns are in single precision
	EXPECT_GT(must.size(), crowd.n_free);
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
