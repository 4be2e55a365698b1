/// Fields of spheres whose sums are known, on a grid in space and on one that is averaged along an axis.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engines/measures/field_sums.hpp"

namespace graindrive {
namespace {

using Matrix3r = Eigen::Matrix<Real, 3, 3>;
constexpr Real length = 4;  // edge of the periodic box about the origin

class Fields {
public:
	explicit Fields(const FieldPlan<3>& plan)
		: plan(plan),
		  sums(std::size_t(plan.grid.size()) * sums_at_a_point<3>(plan.stress), 0)
	{
	}
	void add(const FieldGrain<3>& grain) { add_grain<3>(plan, grain, sums.data()); }
	void add(const FieldContact<3>& contact) { add_contact<3>(plan, contact, sums.data()); }
	FieldMeans<3> at(int point, Real samples = 1) const
	{
		return means_at<3>(sums.data() + std::size_t(point) * sums_at_a_point<3>(plan.stress), samples, plan.stress);
	}
	/// Integral over the window: the value of each point times the size of its bin.
	template <class Value>
	auto integral(Value&& value) const
	{
		auto total = value(at(0));
		for (int p = 1; p < plan.grid.size(); ++p) total += value(at(p));
		Real bin = 1;
		for (int k = 0; k < 3; ++k) bin *= plan.grid.edge(k);
		return decltype(total)(bin * total);
	}
	Real volume() const
	{
		return integral([](const FieldMeans<3>& m) { return m.fraction; });
	}
	Matrix3r stress() const
	{
		return integral([](const FieldMeans<3>& m) -> Matrix3r { return m.contact_stress; });
	}

	FieldPlan<3> plan;

private:
	std::vector<Real> sums;
};

/// A grid of cubes of length/n in the periodic box; along the axis `averaged` it is averaged over a window from `from` to `to`.
FieldPlan<3> box(const FieldKernel<3>& kernel, int n, int averaged = -1, Real from = -length / 2, Real to = length / 2)
{
	FieldGrid<3> grid{ Vector3r::Constant(-length / 2), length / n, { n, n, n } };
	if (averaged >= 0) {
		grid.averaged = averaged, grid.length = to - from;
		grid.low[averaged] = from, grid.bins[averaged] = 1;
	}
	return { grid, kernel, Vector3r::Constant(length), true };
}

std::vector<FieldGrain<3>> random_spheres(int count)
{
	std::mt19937 random(17);
	std::uniform_real_distribution<Real> place(-3 * length, 3 * length), radius(0.2, 0.5), speed(-1, 1);
	const auto vector = [&](auto& of) { return Vector3r(of(random), of(random), of(random)); };
	std::vector<FieldGrain<3>> all(count);
	for (FieldGrain<3>& g : all) {
		g = { vector(place), Vector3r(0, 0, 2) + vector(speed), 0, radius(random), 0 };
		g.mass = (1 + speed(random) / 2) * ball_volume<3>(g.radius);
	}
	return all;
}

std::vector<FieldContact<3>> random_contacts(int count)
{
	std::mt19937 random(5);
	std::uniform_real_distribution<Real> place(-3 * length, 3 * length), part(-0.6, 0.6);
	const auto vector = [&](auto& of) { return Vector3r(of(random), of(random), of(random)); };
	std::vector<FieldContact<3>> all(count);
	for (FieldContact<3>& c : all) c = { vector(place), vector(part), vector(part) };
	return all;
}

struct Sort {
	const char* name;
	FieldKernel<3> whole, averaged;
	int n;                         // bins along an edge of the box
	Real grain_error, line_error;  // errors of sums over points against integrals, over the greatest value
};
// A Gaussian cut at 5 w, on points w/2.5 apart, has errors of exp(-(2.5 pi)^2) = 2e-27 by Poisson summation and exp(-25) = 1e-11
// by the cut. Spheres: an overlap has a kink in its second derivative, so its error is about (spacing/R)^3; a line's fraction in
// a sphere jumps.
const Sort sorts[] = {
	{ "gaussian", GaussianKernel<3>{ 0.5, 5 }, AveragedGaussianKernel{ { 0.5, 5 } }, 20, 1e-9, 1e-9 },
	{ "sphere", SphereKernel<3>{ 0.7 }, AveragedSphereKernel{ 0.7 }, 32, 1e-4, 5e-3 },
};

// ---- what is conserved ----

TEST(FieldSumsInSpace, SpheresKeepTheirVolumeMassAndMomentum)
{
	const auto spheres = random_spheres(30);
	Real volume = 0, mass = 0;
	Vector3r flow = Vector3r::Zero();
	for (const auto& g : spheres) {
		volume += ball_volume<3>(g.radius), mass += g.mass;
		flow += ball_volume<3>(g.radius) * g.velocity;
	}
	for (const Sort& sort : sorts)
		for (const int axis : { -1, 0, 1, 2 }) {
			Fields fields(box(axis < 0 ? sort.whole : sort.averaged, sort.n, axis));
			for (const auto& g : spheres) fields.add(g);
			EXPECT_NEAR(fields.volume(), volume, sort.grain_error * volume) << sort.name << axis;
			const Real found = fields.integral([](const FieldMeans<3>& m) { return m.density; });
			EXPECT_NEAR(found, mass, sort.grain_error * mass) << sort.name << axis;
			const Vector3r given = fields.integral([](const FieldMeans<3>& m) -> Vector3r {
				return m.fraction > 0 ? Vector3r(m.fraction * m.velocity) : Vector3r(Vector3r::Zero());
			});
			EXPECT_NEAR((given - flow).norm(), 0, sort.grain_error * flow.norm()) << sort.name << axis;
		}
}

TEST(FieldSumsInSpace, AContactsStressOverSpaceIsForceTimesBranch)
{
	const FieldContact<3> contacts[] = { { { 1.9, -1.8, 0.3 }, { 0.3, -0.4, 0.6 }, { 1, 2, -3 } },
		{ { 0.1, 1.7 + 3 * length, -0.3 - length }, { 0, 0.9, 0 },
			{ 0.3, 4, 0.2 } } };  // the line along y is a point on a grid averaged over y
	for (const Sort& sort : sorts)
		for (const FieldContact<3>& c : contacts)
			for (const int axis : { -1, 0, 1, 2 }) {
				Fields fields(box(axis < 0 ? sort.whole : sort.averaged, sort.n, axis));
				fields.add(c);
				const Matrix3r expected = c.force * c.branch.transpose();
				EXPECT_NEAR((fields.stress() - expected).norm(), 0, sort.line_error * expected.norm()) << sort.name << axis;
			}
}

TEST(FieldSumsInSpace, CutGaussianIntegratesToOneInClosedForm)
{
	for (const Real c : { 1e-3, 0.7, 2.0, 3.0 }) {
		const GaussianKernel<3> kernel{ 1.3, c };
		Real sum = 0;
		const int n = 100000;
		for (int k = 0; k < n; ++k) {
			const Real step = kernel.radius() / n, r = (k + 0.5) * step;
			sum += 4 * pi * r * r * step * kernel.norm() * std::exp(-r * r / (1.3 * 1.3));
		}
		EXPECT_NEAR(sum, 1, 1e-9);
	}
}

// ---- single grains and contacts ----

TEST(FieldSumsInSpace, OneGrainByHand)
{
	const FieldGrain<3> grain{ { 0.2, -0.1, 0.3 }, { 3, 4, 5 }, 100, 0.25, 2 };
	const FieldGrid<3> grid{ { -2, -1, -1 }, 1, { 4, 2, 3 } };
	const Vector3r point(-0.5, 0.5, 0.5);  // place (1, 1, 1)
	const Real square = (point - grain.position).squaredNorm(), volume = pi / 48;
	const auto seen = [&](const FieldKernel<3>& kernel) {
		Fields fields({ grid, kernel, Vector3r::Zero(), true });
		fields.add(grain);
		return fields.at((1 * 2 + 1) * 4 + 1);
	};
	const Real w = std::exp(-square) / (std::pow(pi, 1.5) * std::erf(3) - 2 * pi * 3 * std::exp(-9));
	const FieldMeans<3> gaussian = seen(GaussianKernel<3>{ 1, 3 }), sphere = seen(SphereKernel<3>{ 1.25 });
	EXPECT_NEAR(gaussian.fraction, volume * w, 1e-16);
	EXPECT_NEAR(gaussian.density, 2 * w, 1e-15);
	EXPECT_EQ((gaussian.velocity - grain.velocity).norm(), 0);
	EXPECT_EQ(gaussian.temperature, 0);
	EXPECT_NEAR(sphere.fraction, volume / (4 * pi / 3 * 1.25 * 1.25 * 1.25), 1e-17);  // inside, at a distance of 0.94
	EXPECT_EQ((sphere.velocity - grain.velocity).norm(), 0);
}

TEST(FieldSumsInSpace, OneContactByHand)
{
	const FieldContact<3> c{ { -0.5, 0, 0 }, { 1, 0, 0 }, { 3, 0.5, -0.25 } };
	const auto stress = [&](const FieldKernel<3>& kernel, int averaged) {
		FieldGrid<3> point{ Vector3r::Constant(-0.5), 1, { 1, 1, 1 } };  // its middle is the contact
		if (averaged >= 0) point.averaged = averaged, point.length = 1;
		Fields fields({ point, kernel, Vector3r::Zero(), true });
		fields.add(c);
		return fields.at(0).contact_stress;
	};
	const auto expect = [](const Matrix3r& got, Real weight) {
		const Matrix3r expected = weight * Vector3r(3, 0.5, -0.25) * Vector3r::UnitX().transpose();  // [a, b]: force a, branch b
		EXPECT_NEAR((got - expected).norm(), 0, 1e-14);
	};
	const Real big = 4 * pi / 3 * 8, small = 4 * pi / 3 / 64;
	expect(stress(SphereKernel<3>{ 2 }, -1), 1 / big);
	expect(stress(SphereKernel<3>{ 0.25 }, -1), 0.5 / small);  // half of the line is inside
	const Real norm = GaussianKernel<3>{ 1, 3 }.norm();
	expect(stress(GaussianKernel<3>{ 1, 3 }, -1), norm * std::sqrt(pi) * std::erf(0.5));
	// Averaged over x, along the line: the length of the axis inside the sphere, over the window's length of 1.
	expect(stress(AveragedSphereKernel{ 2 }, 0), 4 / big);
	expect(stress(AveragedGaussianKernel{ { 1, 3 } }, 0), norm * std::sqrt(pi) * std::erf(3));
	// Averaged over z: the area of the circle between x = -1/2 and 1/2, a rectangle and two segments.
	expect(stress(AveragedSphereKernel{ 2 }, 2), (std::sqrt(3.75) + 8 * std::asin(0.25)) / big);
}

TEST(FieldSumsInSpace, TemperatureIsAThirdOfTheMeanSquare)
{
	for (const Sort& sort : sorts)
		for (const int axis : { -1, 1 }) {
			Fields fields(box(axis < 0 ? sort.whole : sort.averaged, 4, axis));
			const Vector3r u(3e-3, 4e-3, -12e-3), stream(1, -2, 3);
			for (const Real sign : { -1.0, 1.0, -1.0, 1.0 })
				fields.add(FieldGrain<3>{ { 0.4, -0.3, 0.6 }, stream + sign * u, 0, 0.5, 2 });
			int seen = 0;
			for (int p = 0; p < fields.plan.grid.size(); ++p) {
				const FieldMeans<3> m = fields.at(p, 4);
				if (!(m.fraction > 1e-6)) continue;
				EXPECT_NEAR(m.temperature, u.squaredNorm() / 3, 1e-12 * u.squaredNorm());
				EXPECT_NEAR((m.kinetic_stress - m.density * u * u.transpose()).norm(), 0, 1e-12 * m.density * u.squaredNorm());
				++seen;
			}
			EXPECT_GT(seen, 4);
		}
}

TEST(FieldSumsInSpace, CubicLatticeUnderUniformLoad)
{
	// Forces F_k through every contact of a lattice of spacing s: sigma_kk = F_k/s^2 at every point.
	const Real s = 0.5;
	const Vector3r force(2, 5, 3);
	for (const int axis : { -1, 1, 2 }) {
		const Sort& sort = sorts[0];
		Fields fields(box(axis < 0 ? sort.whole : sort.averaged, 7, axis));
		for (int p = 0; p < 512; ++p) {
			const Vector3r at = s * Vector3r(p % 8 + 0.21, p / 8 % 8 - 0.4, p / 64);
			for (int k = 0; k < 3; ++k) fields.add(FieldContact<3>{ at, s * Vector3r::Unit(k), force[k] * Vector3r::Unit(k) });
		}
		const Matrix3r expected = (force / (s * s)).asDiagonal();
		// The lattice gives a ripple of 6 exp(-(pi w/s)^2) = 3e-4 at most; each line smooths it along itself.
		for (int p = 0; p < fields.plan.grid.size(); ++p)
			EXPECT_NEAR((fields.at(p).contact_stress - expected).norm(), 0, 3e-4 * expected.norm());
	}
}

// ---- averaged along an axis ----

TEST(FieldSumsInSpace, AveragedFieldsAreTheMeanOfTheSlices)
{
	const auto spheres = random_spheres(12);
	const auto contacts = random_contacts(12);
	for (const Sort& sort : sorts)
		for (const int axis : { 0, 1, 2 }) {
			Fields slices(box(sort.whole, sort.n)), averaged(box(sort.averaged, sort.n, axis));
			for (const auto& g : spheres) slices.add(g), averaged.add(g);
			for (const auto& c : contacts) slices.add(c), averaged.add(c);
			Real worst_fraction = 0, worst_velocity = 0, worst_stress = 0, greatest_fraction = 0, greatest_stress = 0;
			for (int p = 0; p < averaged.plan.grid.size(); ++p) {
				FieldGrid<3>::Place place = averaged.plan.grid.place(p);
				Real fraction = 0;
				Vector3r flow = Vector3r::Zero();
				Matrix3r stress = Matrix3r::Zero();
				for (place[axis] = 0; place[axis] < sort.n; ++place[axis]) {
					const FieldMeans<3> m = slices.at(slices.plan.grid.point(place));
					fraction += m.fraction / sort.n, stress += m.contact_stress / sort.n;
					if (m.fraction > 0) flow += m.fraction * m.velocity / sort.n;
				}
				const FieldMeans<3> m = averaged.at(p);
				worst_fraction = std::max(worst_fraction, std::abs(m.fraction - fraction));
				worst_velocity = std::max(worst_velocity, m.fraction > 0 ? (m.fraction * m.velocity - flow).norm() : 0);
				worst_stress = std::max(worst_stress, (m.contact_stress - stress).norm());
				greatest_fraction = std::max(greatest_fraction, fraction);
				greatest_stress = std::max(greatest_stress, stress.norm());
			}
			// Near the rim the part of a line in a sphere grows as the square root of the slice's distance, so the error is
			// (spacing/R)^(3/2) = 0.08.
			const Real line_error = sort.line_error < 1e-6 ? sort.line_error : 0.05;
			EXPECT_LT(worst_fraction, 10 * sort.grain_error * greatest_fraction) << sort.name << axis;
			EXPECT_LT(worst_velocity, 40 * sort.grain_error * greatest_fraction) << sort.name << axis;
			EXPECT_LT(worst_stress, line_error * greatest_stress) << sort.name << axis;
			EXPECT_GT(greatest_stress, 0);
		}
}

TEST(FieldSumsInSpace, WindowsSideBySideAddUpToTheWhole)
{
	const auto spheres = random_spheres(20);
	const auto contacts = random_contacts(20);
	for (const Sort& sort : sorts) {
		Fields whole(box(sort.averaged, 8, 1)), lower(box(sort.averaged, 8, 1, -2, 0.7)), upper(box(sort.averaged, 8, 1, 0.7, 2));
		for (Fields* fields : { &whole, &lower, &upper }) {
			for (const auto& g : spheres) fields->add(g);
			for (const auto& c : contacts) fields->add(c);
		}
		for (int p = 0; p < 64; ++p) {
			const FieldMeans<3> all = whole.at(p), one = lower.at(p), other = upper.at(p);
			EXPECT_NEAR(0.675 * one.fraction + 0.325 * other.fraction, all.fraction, 1e-14);
			EXPECT_NEAR((0.675 * one.contact_stress + 0.325 * other.contact_stress - all.contact_stress).norm(), 0,
				1e-12 * (1 + all.contact_stress.norm()));
		}
		EXPECT_GT(lower.volume(), 0);
		EXPECT_GT(upper.volume(), 0);
		EXPECT_NEAR(lower.volume() + upper.volume(), whole.volume(), 1e-12 * whole.volume());
	}
}

TEST(FieldSumsInSpace, AGrainOnThePeriodicSideCountsOnce)
{
	for (const Sort& sort : sorts)
		for (const Real y : { -length / 2, length / 2, 7.5 * length, 0.0 })
			for (const Real from : { -length / 2, -length / 2 - 0.1, length / 2 }) {
				Fields fields(box(sort.averaged, sort.n, 1, from, from + length));
				fields.add(FieldGrain<3>{ { 0.3, y, -1.9 }, {}, 0, 0.5, 1 });
				EXPECT_NEAR(fields.volume(), pi / 6, sort.grain_error * pi) << sort.name << y;
			}
}

TEST(FieldSumsInSpace, ImagesAreSeenAlongAllAxes)
{
	const Sort& sort = sorts[0];
	Fields beside(box(sort.whole, 10)), across(box(sort.whole, 10));
	beside.add(FieldContact<3>{ { 0.1, 0.3, 0.2 }, { 0.8, 0.4, -0.5 }, { 1, 2, 3 } });
	across.add(FieldContact<3>{ { 0.1 - 2, 0.3 + 2 + 3 * length, 0.2 - 2 - length }, { 0.8, 0.4, -0.5 }, { 1, 2, 3 } });
	for (int p = 0; p < beside.plan.grid.size(); ++p) {  // shifted by half the box, five bins, along every axis
		FieldGrid<3>::Place place = beside.plan.grid.place(p);
		const Matrix3r here = beside.at(p).contact_stress;
		for (int& k : place) k = (k + 5) % 10;
		EXPECT_NEAR((across.at(beside.plan.grid.point(place)).contact_stress - here).norm(), 0, 1e-12);
	}
}

}  // namespace
}  // namespace graindrive
