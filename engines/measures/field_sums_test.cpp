/// Fields of simple configurations whose sums are known.
#include "engines/measures/field_sums.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace graindrive {
namespace {

const FieldKernel<2> kernels[] = { DiskBinKernel{}, GaussianKernel<2>{ 1.5, 5 }, SphereKernel<2>{ 1.5 } };

class Fields {
public:
	explicit Fields(const FieldPlan<2>& plan)
		: plan(plan),
		  sums(std::size_t(plan.grid.size()) * sums_at_a_point<2>(plan.stress), 0)
	{
	}
	void add(const FieldGrain<2>& grain) { add_grain<2>(plan, grain, sums.data()); }
	void add(const FieldContact<2>& contact) { add_contact<2>(plan, contact, sums.data()); }
	FieldMeans<2> at(int point, Real samples = 1) const
	{
		return means_at<2>(sums.data() + std::size_t(point) * sums_at_a_point<2>(plan.stress), samples, plan.stress);
	}
	template <class Value>
	auto sum(Value&& value, Real samples = 1) const
	{
		auto total = value(at(0, samples));
		for (int p = 1; p < plan.grid.size(); ++p) total += value(at(p, samples));
		return total;
	}

private:
	FieldPlan<2> plan;
	std::vector<Real> sums;
};

FieldPlan<2> box(const FieldKernel<2>& kernel, Real length, int n, bool stress = true)
{
	return { FieldGrid<2>{ { -length / 2, -length / 2 }, length / n, n, n }, kernel, { length, length }, stress };
}

std::vector<FieldGrain<2>> random_disks(int count, Real length)
{
	std::mt19937 random(17);
	std::uniform_real_distribution<Real> place(-3 * length, 3 * length), radius(0.3, 0.6), speed(-1, 1);
	std::vector<FieldGrain<2>> all(count);
	for (FieldGrain<2>& g : all)
		g = { { place(random), place(random) }, { speed(random), 2 + speed(random) }, 3 * speed(random), radius(random), 0 };
	for (FieldGrain<2>& g : all) g.mass = (1 + speed(random) / 2) * pi * g.radius * g.radius;
	return all;
}

// ---- grains ----

TEST(FieldSums, RandomDisksKeepTheirAreaMassAndMomentum)
{
	const Real length = 10;
	const auto disks = random_disks(200, length);
	Real disk_area = 0, mass = 0;
	Vector2r flow = Vector2r::Zero();
	for (const auto& g : disks) {
		disk_area += pi * g.radius * g.radius, mass += g.mass;
		flow += pi * g.radius * g.radius * g.velocity;
	}
	for (const int n : { 5, 32, 100 }) {
		Fields bins(box(DiskBinKernel{}, length, n));
		for (const auto& g : disks) bins.add(g);
		const Real bin = length / n * length / n;
		EXPECT_NEAR(bin * bins.sum([](const FieldMeans<2>& m) { return m.fraction; }), disk_area, 1e-12 * disk_area);
		EXPECT_NEAR(bin * bins.sum([](const FieldMeans<2>& m) { return m.density; }), mass, 1e-12 * mass);
		// Spin does not change the mean velocity of a grain.
		const Vector2r given = bin * bins.sum([](const FieldMeans<2>& m) -> Vector2r {
			return m.fraction > 0 ? Vector2r(m.fraction * m.velocity) : Vector2r(Vector2r::Zero());
		});
		EXPECT_NEAR((given - flow).norm(), 0, 1e-12 * flow.norm());
	}
	Fields smooth(box(GaussianKernel<2>{ 1.5, 5 }, length, 20));
	for (const auto& g : disks) smooth.add(g);
	EXPECT_NEAR(0.25 * smooth.sum([](const FieldMeans<2>& m) { return m.fraction; }), disk_area, 1e-8 * disk_area);
}

TEST(FieldSums, GaussianOfOneGrain)
{
	const FieldPlan<2> plan{ FieldGrid<2>{ { -2, -2 }, 1, 4, 4 }, GaussianKernel<2>{ 1, 3 }, { 0, 0 }, false };
	Fields fields(plan);
	fields.add(FieldGrain<2>{ { 0.2, -0.1 }, { 3, 4 }, 100, 0.5, 2 });
	const Vector2r point = plan.grid.centre({ 1, 2 });
	const Real w = std::exp(-(point - Vector2r(0.2, -0.1)).squaredNorm()) / (pi * (1 - std::exp(-9)));
	const FieldMeans<2> m = fields.at(2 * 4 + 1);
	EXPECT_NEAR(m.fraction, pi / 4 * w, 1e-16);
	EXPECT_NEAR(m.density, 2 * w, 1e-15);
	EXPECT_EQ((m.velocity - Vector2r(3, 4)).norm(), 0);  // the velocity of the grain's centre: Eq. (3.2) has no spin
	EXPECT_EQ(m.temperature, 0);
}

TEST(FieldSums, RigidRotationIsExact)
{
	// Large disks that rotate rigidly together: in every bin inside one of them the velocity is omega x r, without fluctuations.
	const Real omega = -0.7;
	const FieldPlan<2> plan{ FieldGrid<2>{ { -2, -2 }, 0.1, 40, 40 }, DiskBinKernel{}, { 0, 0 }, false };
	Fields fields(plan);
	const FieldGrain<2> disks[] = { { { -0.6, 0.1 }, {}, omega, 1, pi }, { { 1.1, -0.4 }, {}, omega, 0.7, 1 } };
	for (FieldGrain<2> g : disks) {
		g.velocity = omega * Vector2r(-g.position[1], g.position[0]);
		fields.add(g);
		fields.add(g);  // a second frame
	}
	int whole = 0;
	for (int p = 0; p < plan.grid.size(); ++p) {
		const FieldMeans<2> m = fields.at(p, 2);
		if (m.fraction < 1 - 1e-12) continue;
		const Vector2r r = plan.grid.centre(plan.grid.place(p)), expected = omega * Vector2r(-r[1], r[0]);
		EXPECT_NEAR((m.velocity - expected).norm(), 0, 1e-14);
		EXPECT_NEAR(m.temperature, 0, 1e-28);
		++whole;
	}
	EXPECT_GT(whole, 300);
}

TEST(FieldSums, TemperatureOfTwoFramesIsAboutTheirMean)
{
	for (const Real stream : { 0.0, 1e6 }) {
		Fields fields(box(DiskBinKernel{}, 4, 4));
		const Vector2r u(3e-3, 4e-3);
		for (const Real sign : { -1.0, 1.0, -1.0, 1.0 })
			fields.add(FieldGrain<2>{ { 0.4, -0.3 }, Vector2r(stream, -stream) + sign * u, 0, 0.5, 2 });
		for (int p = 0; p < 16; ++p) {
			const FieldMeans<2> m = fields.at(p, 4);
			if (!(m.fraction > 0)) continue;
			// The ratio of 1e6 to 5e-3 is 2e8: a difference of mean squares would lose all digits.
			EXPECT_NEAR(m.temperature, u.squaredNorm() / 2, stream > 0 ? 1e-6 * u.squaredNorm() : 1e-19);
			EXPECT_NEAR(m.kinetic_stress(0, 1), m.density * u[0] * u[1], stream > 0 ? 1e-5 * m.density * u[0] * u[1] : 1e-19);
		}
	}
}

TEST(FieldSums, KineticStressOfAGas)
{
	const auto disks = random_disks(300, 10);
	Fields fields(box(DiskBinKernel{}, 10, 1));
	Real mass = 0;
	Vector2r momentum = Vector2r::Zero();
	for (FieldGrain<2> g : disks) {
		g.spin = 0;
		fields.add(g);
		mass += g.mass, momentum += g.mass * g.velocity;
	}
	Eigen::Matrix<Real, 2, 2> expected = Eigen::Matrix<Real, 2, 2>::Zero();
	for (const auto& g : disks) {
		const Vector2r v = g.velocity - momentum / mass;
		expected += g.mass / 100 * v * v.transpose();
	}
	EXPECT_NEAR((fields.at(0).kinetic_stress - expected).norm(), 0, 1e-12 * expected.norm());
}

TEST(FieldSums, NoGrainIsNoVelocityAndNoSampleIsNothing)
{
	Fields fields(box(DiskBinKernel{}, 4, 4));
	EXPECT_EQ(fields.at(3).fraction, 0);
	EXPECT_TRUE(std::isnan(fields.at(3).velocity[0]) && std::isnan(fields.at(3).temperature));
	EXPECT_EQ(fields.at(3).contact_stress.norm(), 0);
	EXPECT_TRUE(std::isnan(fields.at(3, 0).fraction));
}

// ---- contacts ----

TEST(FieldSums, OneContactByHand)
{
	const FieldContact<2> c{ { -0.5, 0 }, { 1, 0 }, { 3, 0.5 } };
	const FieldGrid<2> point{ { -0.5, -0.5 }, 1, 1, 1 };  // its middle is the contact
	const auto stress = [&](const FieldKernel<2>& kernel) {
		Fields fields({ point, kernel, { 0, 0 }, true });
		fields.add(c);
		return fields.at(0).contact_stress;
	};
	const auto expect = [](const Eigen::Matrix<Real, 2, 2>& got, Real weight) {
		EXPECT_NEAR(got(0, 0), 3 * weight, 1e-14);    // force along x through a branch along x
		EXPECT_NEAR(got(1, 0), 0.5 * weight, 1e-14);  // friction: force along y, branch along x
		EXPECT_EQ(got(0, 1), 0);
		EXPECT_EQ(got(1, 1), 0);
	};
	expect(stress(SphereKernel<2>{ 2 }), 1 / (4 * pi));
	expect(stress(SphereKernel<2>{ 0.25 }), 0.5 / (pi / 16));  // half of the line
	expect(stress(DiskBinKernel{}), 1);
	expect(stress(GaussianKernel<2>{ 1, 3 }), std::sqrt(pi) * std::erf(0.5) / pi / (1 - std::exp(-9)));
}

TEST(FieldSums, SquareLatticeUnderUniformLoad)
{
	// Forces F_x and F_y through every contact of a lattice of spacing s: sigma_xx = F_x/s, sigma_yy = F_y/s at every point.
	const Real s = 0.98, f_x = 2, f_y = 5;
	const int n = 10;
	for (const FieldKernel<2>& kernel : kernels) {
		const bool smooth = std::holds_alternative<GaussianKernel<2>>(kernel);
		Fields fields(box(kernel, n * s, smooth ? 13 : n));
		for (int i = 0; i < n; ++i)
			for (int j = 0; j < n; ++j) {
				const Vector2r at(s * (i + 0.21), s * (j - 0.4));
				fields.add(FieldContact<2>{ at, { s, 0 }, { f_x, 0 } });
				fields.add(FieldContact<2>{ at, { 0, s }, { 0, f_y } });
			}
		if (std::holds_alternative<SphereKernel<2>>(kernel)) {  // the part inside a circle is right only in the mean over places
			Fields fine(box(kernel, n * s, 20 * n));
			for (int i = 0; i < n; ++i)
				for (int j = 0; j < n; ++j) fine.add(FieldContact<2>{ { s * (i + 0.21), s * (j - 0.4) }, { 0, s }, { 0, f_y } });
			const Real mean = fine.sum([](const FieldMeans<2>& m) { return m.contact_stress(1, 1); }) / (400 * n * n);
			EXPECT_NEAR(mean, f_y / s, 1e-3 * f_y / s);
			continue;
		}
		for (int p = 0; p < (smooth ? 169 : n * n); ++p) {
			const auto stress = fields.at(p).contact_stress;
			EXPECT_NEAR(stress(0, 0), f_x / s, 1e-8);  // Gaussian: 2 exp(-(pi w/s)^2) = 2e-10 and the cut's e^-25
			EXPECT_NEAR(stress(1, 1), f_y / s, 1e-8);
			EXPECT_NEAR(std::abs(stress(0, 1)) + std::abs(stress(1, 0)), 0, 1e-12);
		}
	}
}

TEST(FieldSums, HydrostaticBedCarriesTheWeightAbove)
{
	// Columns of disks under gravity, with sideways forces as large as the vertical ones: the pressure is the weight above over
	// the width.
	const int width = 12, height = 30;
	const Real weight = 0.7;
	const FieldPlan<2> plan{ FieldGrid<2>{ { 0, 4 }, 0.5, 24, 40 }, GaussianKernel<2>{ 1, 3 }, { Real(width), 0 }, true };
	Fields fields(plan);
	for (int i = 0; i < width; ++i)
		for (int j = 0; j < height; ++j) {
			const Real above = weight * (height - 1 - j);  // the force in the contact above disk j
			fields.add(FieldContact<2>{ { i + 0.5, j + 0.5 }, { 0, 1 }, { 0, above } });
			fields.add(FieldContact<2>{ { i + 0.5, j + 0.5 }, { 1, 0 }, { above + weight / 2, 0 } });
		}
	for (int p = 0; p < plan.grid.size(); ++p) {
		const Real depth = height - plan.grid.centre(plan.grid.place(p))[1];
		const Real pressure = fields.at(p).contact_stress.trace() / 2;
		EXPECT_NEAR(pressure, weight * depth, 0.005 * weight * depth) << "depth " << depth;
	}
}

TEST(FieldSums, ContactsAcrossThePeriodicSideCountWhole)
{
	for (const FieldKernel<2>& kernel : kernels) {
		Fields beside(box(kernel, 10, 50)), across(box(kernel, 10, 50));
		beside.add(FieldContact<2>{ { 0.1, 0.3 }, { 0.8, 0.4 }, { 1, 2 } });
		across.add(FieldContact<2>{ { 0.1 + 4.6 - 20, 0.3 - 5.2 }, { 0.8, 0.4 }, { 1, 2 } });  // the same place in the bins
		const auto total = [](const Fields& f) {
			return f.sum([](const FieldMeans<2>& m) -> Eigen::Matrix<Real, 2, 2> { return m.contact_stress; });
		};
		EXPECT_NEAR((total(beside) - total(across)).norm(), 0, 1e-10 * total(beside).norm());
		EXPECT_GT(total(beside).norm(), 0);
	}
}

}  // namespace
}  // namespace graindrive
