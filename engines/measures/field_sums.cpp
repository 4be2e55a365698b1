/// The sums at every point of a field: grains and contacts join, fields are read.
#include "engines/measures/field_sums.hpp"

#include <limits>

namespace graindrive {

namespace {

/// One part of weight w > 0 joins a running mean: returns w (v - mean before)(v - mean after)^T, to be added to the deviations.
Eigen::Matrix<Real, 2, 2> join_mean(Real weight, Real sum_of_weights, const Vector2r& v, Real* mean)
{
	Eigen::Map<Vector2r, Eigen::Unaligned> running(mean);
	const Vector2r before = v - running;
	running += weight / sum_of_weights * before;
	return weight * before * (v - running).transpose();
}

void add_part(Real* sums, Real share, Real mass_per_area, const Vector2r& v, bool stress)
{
	sums[FieldSum::area] += share;
	sums[FieldSum::density] += share * mass_per_area;
	sums[FieldSum::square] += join_mean(share, sums[FieldSum::area], v, sums + FieldSum::velocity).trace();
	if (!stress) return;
	const auto deviation = join_mean(share * mass_per_area, sums[FieldSum::density], v, sums + FieldSum::momentum);
	sums[FieldSum::kinetic] += deviation(0, 0);
	sums[FieldSum::kinetic + 1] += deviation(0, 1);
	sums[FieldSum::kinetic + 2] += deviation(1, 1);
}

}  // namespace

void add_grain(const FieldPlan& plan, const FieldGrain& grain, Real* sums)
{
	const int width = sums_at_a_point(plan.stress);
	const Real mass_per_area = grain.mass / (pi * grain.radius * grain.radius);
	std::visit(
		[&](const auto& kernel) {
			const Real reach = kernel.reach(grain.radius);
			plan.grid.visit_images(grain.position, { reach, reach }, plan.periods, [&](const Vector2r& shift) {
				kernel.grain(plan.grid, grain.position + shift, grain.radius, [&](int point, Real share, const Vector2r& lever) {
					// v + omega x r = (v_x - omega r_y, v_y + omega r_x); the sign in Kumar et al., (A2), is a misprint.
					const Vector2r v = grain.velocity + grain.spin * Vector2r(-lever[1], lever[0]);
					add_part(sums + std::size_t(point) * width, share, mass_per_area, v, plan.stress);
				});
			});
		},
		plan.kernel);
}

void add_contact(const FieldPlan& plan, const FieldContact& c, Real* sums)
{
	if (c.branch.isZero(0)) return;
	const Vector2r middle = c.from + c.branch / 2;
	std::visit(
		[&](const auto& kernel) {
			const Vector2r reach = c.branch.cwiseAbs() / 2 + Vector2r::Constant(kernel.reach(0));
			plan.grid.visit_images(middle, reach, plan.periods, [&](const Vector2r& shift) {
				kernel.line(plan.grid, c.from + shift, c.branch, [&](int point, Real share) {
					Real* stress = sums + std::size_t(point) * FieldSum::all + FieldSum::contact;
					for (int a = 0; a < 2; ++a)
						for (int b = 0; b < 2; ++b) stress[2 * a + b] += share * c.force[a] * c.branch[b];
				});
			});
		},
		plan.kernel);
}

FieldMeans means_at(const Real* sums, Real samples, bool stress)
{
	constexpr Real none = std::numeric_limits<Real>::quiet_NaN();
	FieldMeans m{ none, none, none, Vector2r::Constant(none), {}, {} };
	m.contact_stress.setConstant(none);
	m.kinetic_stress.setConstant(none);
	if (!(samples > 0)) return m;
	m.area_fraction = sums[FieldSum::area] / samples;
	m.density = sums[FieldSum::density] / samples;
	if (sums[FieldSum::area] > 0) {
		m.velocity = { sums[FieldSum::velocity], sums[FieldSum::velocity + 1] };
		m.temperature = sums[FieldSum::square] / sums[FieldSum::area] / 2;
	}
	if (!stress) return m;
	m.contact_stress << sums[FieldSum::contact], sums[FieldSum::contact + 1], sums[FieldSum::contact + 2],
		sums[FieldSum::contact + 3];
	m.kinetic_stress << sums[FieldSum::kinetic], sums[FieldSum::kinetic + 1], sums[FieldSum::kinetic + 1],
		sums[FieldSum::kinetic + 2];
	m.contact_stress /= samples;
	m.kinetic_stress /= samples;
	return m;
}

}  // namespace graindrive
