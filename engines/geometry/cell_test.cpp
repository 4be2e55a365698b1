/// Images in periodic and sheared cells: against the arithmetic of the loop in two dimensions, and by invariants of shear.
#include "engines/geometry/cell.hpp"

#include "engines/geometry/test_support.hpp"

namespace graindrive::geometry {
namespace {

template <int D>
Cell<D> periodic_cell()
{
	Cell<D> cell;
	const double low[] = { -1.5, 2, 0.3 }, high[] = { 5.5, 5.1, 4 };
	for (int k = 0; k < D; ++k) {
		cell.low[k] = low[k];
		cell.high[k] = high[k];
		cell.periodic[k] = true;
	}
	return cell;
}

/// A sheared cell: images one period further along the last axis move along x.
template <int D>
Cell<D> sheared_cell(double offset = 1.234, double rate = 0.77)
{
	Cell<D> cell = periodic_cell<D>();
	cell.across = D - 1;
	cell.along = 0;
	cell.offset = offset;
	cell.rate = rate;
	return cell;
}

template <class Test>
void in_both(Test test)
{
	test(std::integral_constant<int, 2>());
	test(std::integral_constant<int, 3>());
}

/// Points far from all sides, because at a side round-off decides on which side a point or an image lies.
template <int D>
bool is_inside(const Cell<D>& cell, const Vec<D>& at)
{
	for (int k = 0; k < D; ++k)
		if (at[k] < cell.low[k] + 1e-9 || at[k] > cell.high[k] - 1e-9) return false;
	return true;
}

TEST(Cell, HasTheBitsOfTheLoopInTwoDimensions)
{
	const Cell<2> cell = periodic_cell<2>();
	Cell<2> channel = cell;
	channel.periodic[1] = false;
	RandomPoints<2> random(30);
	for (int i = 0; i < 1000; ++i) {
		const Vec<2> d = random();
		const double x_length = cell.high[0] - cell.low[0], y_length = cell.high[1] - cell.low[1];
		const double x = d[0] - x_length * std::nearbyint(d[0] / x_length), y = d[1] - y_length * std::nearbyint(d[1] / y_length);
		const Image<2> image = cell.nearest(d);
		EXPECT_TRUE(image.at[0] == x && image.at[1] == y);
		EXPECT_EQ(image.wrapped, x != d[0] || y != d[1]);
		EXPECT_TRUE(channel.nearest(d).at[0] == x && channel.nearest(d).at[1] == d[1]);
		EXPECT_EQ(cell.wrap(d).at[0], d[0] - x_length * std::floor((d[0] - cell.low[0]) / x_length));
		EXPECT_EQ(channel.wrap(d).at[1], d[1]);
		EXPECT_TRUE(cell.velocity_change(image) == Vec<2>{});
	}
}

TEST(Cell, NearestImageIsTheShortestOfAllThatAreNear)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		const Cell<D> cell = sheared_cell<D>();
		RandomPoints<D> random(20);
		int near = 0;
		for (int i = 0; i < 2000; ++i) {
			const Vec<D> d = random();
			const Image<D> image = cell.nearest(d);
			double shortest = 1e9;
			for (int n = -12; n <= 12; ++n) {  // layers; along the other axes the nearest image follows by rounding
				Vec<D> other = d;
				other[cell.across] -= n * cell.length(cell.across);
				other[0] -= n * cell.offset;
				for (int k = 0; k < D; ++k)
					if (k != cell.across) other[k] = std::remainder(other[k], cell.length(k));
				shortest = std::min(shortest, norm(other));
			}
			if (shortest > 1.5) continue;  // half of the shortest period is 1.55
			++near;
			EXPECT_NEAR(norm(image.at), shortest, 1e-13);  // a few round-offs of 20 and its multiples
		}
		EXPECT_GT(near, 100);
	});
}

TEST(Cell, SeparationIsAntisymmetric)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		for (const Cell<D>& cell : { periodic_cell<D>(), sheared_cell<D>() }) {
			RandomPoints<D> random(20);
			for (int i = 0; i < 1000; ++i) {
				const Vec<D> d = random();
				EXPECT_TRUE(cell.nearest(-d).at == -cell.nearest(d).at);
				EXPECT_TRUE(cell.velocity_change(cell.nearest(-d)) == -cell.velocity_change(cell.nearest(d)));
			}
		}
	});
}

TEST(Cell, WrapsIntoTheCellAndOnceIsEnough)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		for (const Cell<D>& cell : { periodic_cell<D>(), sheared_cell<D>() }) {
			RandomPoints<D> random(20);
			for (int i = 0; i < 1000; ++i) {
				const Image<D> once = cell.wrap(random());
				if (!is_inside(cell, once.at)) continue;
				const Image<D> twice = cell.wrap(once.at);
				EXPECT_TRUE(twice.at == once.at && !twice.wrapped && twice.periods == Vec<D>{});
			}
			EXPECT_TRUE(cell.wrap(cell.low).at == cell.low);
		}
	});
}

TEST(Cell, PeriodsLeadBack)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		const Cell<D> cell = sheared_cell<D>();
		RandomPoints<D> random(20);
		for (int i = 0; i < 1000; ++i) {
			const Vec<D> given = random();
			const Image<D> image = cell.wrap(given);
			Vec<D> back = image.at;
			for (int k = 0; k < D; ++k) back[k] += image.periods[k] * cell.length(k);
			back[cell.along] += image.periods[cell.across] * cell.offset;
			EXPECT_LT(norm(back - given), 5e-14);  // round-off of coordinates up to 40
		}
	});
}

TEST(Cell, AShearByAWholePeriodIsTheIdentity)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		Cell<D> cell = sheared_cell<D>(0, 0.5);
		const double period_in_time = cell.length(0) / cell.rate;
		Cell<D> later = cell;
		for (int i = 0; i < 64; ++i) later.advance(3 * period_in_time / 64);
		EXPECT_EQ(later.offset, 0);  // 7/64 and its multiples are numbers without round-off
		later.advance(-period_in_time / 4);
		EXPECT_EQ(later.offset, 0.75 * cell.length(0));
		// Displacing images by a whole period does not change them.
		Cell<D> whole = cell;
		whole.offset = cell.length(0);
		RandomPoints<D> random(20);
		for (int i = 0; i < 1000; ++i) {
			const Vec<D> d = random();
			Vec<D> difference = whole.nearest(d).at - cell.nearest(d).at;
			difference[0] = std::remainder(difference[0], cell.length(0));  // half a period may have either sign
			EXPECT_LT(norm(difference), 1e-13);
		}
	});
}

TEST(Cell, UniformShearLooksTheSameFromEveryImage)
{
	in_both([](auto dimension) {
		constexpr int D = decltype(dimension)::value;
		const Cell<D> cell = sheared_cell<D>();
		const double shear_rate = cell.rate / cell.length(cell.across);
		const auto flow = [&](const Vec<D>& at) { return shear_rate * at[cell.across] * Vec<D>::along(cell.along); };
		RandomPoints<D> random(20);
		for (int i = 0; i < 1000; ++i) {
			const Vec<D> a = random(), b = random();
			const Image<D> wrapped = cell.wrap(a), d = cell.nearest(b - a);
			EXPECT_LT(norm(flow(a) + cell.velocity_change(wrapped) - flow(wrapped.at)), 1e-13);
			EXPECT_LT(norm(flow(b) - flow(a) + cell.velocity_change(d) - flow(d.at)), 1e-13);
		}
	});
}

TEST(Cell, AFlowThroughTheCellAgreesWithOneThatIsNeverWrapped)
{
	// Two points move with the flow, one of them wrapped at each step: their separation stays that of unwrapped motion.
	Cell<3> cell = sheared_cell<3>(0, 0.77);
	const double shear_rate = cell.rate / cell.length(2), dt = 0.01;
	Vec<3> free{ 1, 3, 2 }, velocity{ 0.3, 0.2, 1.7 }, held = free, speed = velocity;
	for (int i = 0; i < 2000; ++i) {
		free += dt * velocity;
		held += dt * speed;
		cell.advance(dt);
		const Image<3> image = cell.wrap(held);
		held = image.at;
		speed += cell.velocity_change(image);
	}
	EXPECT_LT(norm(cell.wrap(free).at - held), 1e-11);  // 2000 steps of a round-off each
	EXPECT_NEAR(speed[0], velocity[0] - shear_rate * (free[2] - held[2]), 1e-12);
	EXPECT_GT(free[2] - held[2], 5 * cell.length(2));  // the point has crossed the cell's side
}

TEST(Cell, RefusesWhatIsNoCell)
{
	const auto said = [](auto&& change) {
		Cell<3> cell = sheared_cell<3>();
		change(cell);
		return complaint([&] { cell.check(); });
	};
	EXPECT_EQ(said([](Cell<3>&) {}), "");
	EXPECT_TRUE(mentions(said([](Cell<3>& c) { c.high[1] = 2; }), "low < high along y, got (2, 2); give"));
	EXPECT_TRUE(mentions(said([](Cell<3>& c) { c.low[0] = std::nan(""); }), "along x, got (nan, 5.5)"));
	EXPECT_TRUE(mentions(said([](Cell<3>& c) { c.along = 2; }), "two different periodic axes"));
	EXPECT_TRUE(mentions(said([](Cell<3>& c) { c.across = 3; }), "got 3 and 0; make both axes periodic"));
	EXPECT_TRUE(mentions(said([](Cell<3>& c) { c.periodic[0] = false; }), "got 2 and 0"));
	EXPECT_TRUE(mentions(said([](Cell<3>& c) { c.rate = INFINITY; }), "must be finite, got (1.234, inf, 0)"));
}

}  // namespace
}  // namespace graindrive::geometry
