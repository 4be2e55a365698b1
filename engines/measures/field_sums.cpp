/// The sums at every point of a field: adds grains and contacts, and computes fields.
#include "engines/measures/field_sums.hpp"

#include <limits>

namespace graindrive {

namespace {

template <int D>
using Vector = Eigen::Matrix<Real, D, 1>;
template <int D>
using Matrix = Eigen::Matrix<Real, D, D>;

/// One part of weight w > 0 joins a running mean: returns w (v - mean before)(v - mean after)^T, to be added to the deviations.
template <int D>
Matrix<D> join_mean(Real weight, Real sum_of_weights, const Vector<D>& v, Real* mean)
{
	Eigen::Map<Vector<D>, Eigen::Unaligned> running(mean);
	const Vector<D> before = v - running;
	running += weight / sum_of_weights * before;
	return weight * before * (v - running).transpose();
}

template <int D>
void add_part(Real* sums, Real share, Real grain_density, const Vector<D>& v, bool stress)
{
	using Sum = FieldSum<D>;
	sums[Sum::fraction] += share;
	sums[Sum::density] += share * grain_density;
	sums[Sum::square] += join_mean<D>(share, sums[Sum::fraction], v, sums + Sum::velocity).trace();
	if (!stress) return;
	const Matrix<D> deviation = join_mean<D>(share * grain_density, sums[Sum::density], v, sums + Sum::momentum);
	Real* kinetic = sums + Sum::kinetic;
	for (int a = 0; a < D; ++a)
		for (int b = a; b < D; ++b) *kinetic++ += deviation(a, b);
}

/// The part of a scene that counts in a grid averaged along an axis: all within the window, moved to the axis's middle.
template <int D>
class AveragedAxis {
public:
	explicit AveragedAxis(const FieldPlan<D>& plan)
		: axis(plan.grid.averaged),
		  low(axis < 0 ? 0 : plan.grid.low[axis]),
		  high(axis < 0 ? 0 : low + plan.grid.length),
		  middle(axis < 0 ? 0 : plan.grid.centre({})[axis]),
		  periods(plan.periods)
	{
		if (axis < 0 || !(periods[axis] > 0)) return;
		// A window as long as the period contains all grains and lines exactly once, wherever it cuts them.
		whole = std::abs(plan.grid.length - periods[axis]) <= 1e-9 * periods[axis];
		if (whole) periods[axis] = 0;
	}

	/// Calls visit(shift) for every image that may be in the window.
	template <class Visit>
	void visit_images(const FieldGrid<D>& grid, Vector<D> centre, Vector<D> reach, Real kernel_reach, Visit&& visit) const
	{
		for (int k = 0; k < D; ++k)
			if (k != axis) reach[k] += kernel_reach;
		if (whole) centre[axis] = middle;
		grid.visit_images(centre, reach, periods, visit);
	}
	/// False for a grain outside of the window; others are moved to the axis's middle.
	bool takes(Vector<D>& at) const
	{
		if (axis < 0) return true;
		const bool inside = whole || (low <= at[axis] && at[axis] < high);
		at[axis] = middle;
		return inside;
	}
	/// Cuts a line to its part in the window, moves that to the axis's middle, and returns the fraction of it that is left.
	Real cut(Vector<D>& from, Vector<D>& branch) const
	{
		if (axis < 0) return 1;
		Real begin = 0, part = 1;
		if (!whole) {
			begin = branch[axis] == 0
			            ? 0
			            : std::clamp(((branch[axis] > 0 ? low : high) - from[axis]) / branch[axis], Real(0), Real(1));
			using Along = Eigen::Matrix<Real, 1, 1>;
			part = fraction_in_box(Along(from[axis]), Along(branch[axis]), Along(low), Along(high));
		}
		from += begin * branch;
		branch *= part;
		from[axis] = middle, branch[axis] = 0;
		return part;
	}

private:
	int axis;
	Real low, high, middle;
	Vector<D> periods;
	bool whole = false;
};

/// v + omega x r = (v_x - omega r_y, v_y + omega r_x); the sign in Kumar et al., (A2), is a misprint. Kernels in space have no
/// lever.
template <int D>
Vector<D> velocity_at(const FieldGrain<D>& grain, const Vector<D>& lever)
{
	if constexpr (D == 2) return grain.velocity + grain.spin * Vector2r(-lever[1], lever[0]);
	return grain.velocity;
}

}  // namespace

template <int D>
void add_grain(const FieldPlan<D>& plan, const FieldGrain<D>& grain, Real* sums)
{
	const int width = sums_at_a_point<D>(plan.stress);
	const Real grain_density = grain.mass / ball_volume<D>(grain.radius);
	const AveragedAxis<D> axis(plan);
	std::visit(
		[&](const auto& kernel) {
			const auto add = [&](int point, Real share, const Vector<D>& lever) {
				add_part<D>(sums + std::size_t(point) * width, share, grain_density, velocity_at<D>(grain, lever), plan.stress);
			};
			axis.visit_images(
				plan.grid, grain.position, Vector<D>::Zero(), kernel.reach(grain.radius), [&](const Vector<D>& shift) {
					Vector<D> at = grain.position + shift;
					if (axis.takes(at)) kernel.grain(plan.grid, at, grain.radius, add);
				});
		},
		plan.kernel);
}

template <int D>
void add_contact(const FieldPlan<D>& plan, const FieldContact<D>& c, Real* sums)
{
	if (c.branch.isZero(0)) return;
	const Vector<D> middle = c.from + c.branch / 2, half = c.branch.cwiseAbs() / 2;
	const AveragedAxis<D> axis(plan);
	std::visit(
		[&](const auto& kernel) {
			axis.visit_images(plan.grid, middle, half, kernel.reach(0), [&](const Vector<D>& shift) {
				Vector<D> from = c.from + shift, branch = c.branch;
				const Real part = axis.cut(from, branch);
				if (!(part > 0)) return;
				kernel.line(plan.grid, from, branch, [&](int point, Real share) {
					Real* stress = sums + std::size_t(point) * FieldSum<D>::all + FieldSum<D>::contact;
					for (int a = 0; a < D; ++a)
						for (int b = 0; b < D; ++b) stress[D * a + b] += part * share * c.force[a] * c.branch[b];
				});
			});
		},
		plan.kernel);
}

template <int D>
FieldMeans<D> means_at(const Real* sums, Real samples, bool stress)
{
	using Sum = FieldSum<D>;
	constexpr Real none = std::numeric_limits<Real>::quiet_NaN();
	FieldMeans<D> m{ none, none, none, Vector<D>::Constant(none), Matrix<D>::Constant(none), Matrix<D>::Constant(none) };
	if (!(samples > 0)) return m;
	m.fraction = sums[Sum::fraction] / samples;
	m.density = sums[Sum::density] / samples;
	if (sums[Sum::fraction] > 0) {
		m.velocity = Vector<D>::Map(sums + Sum::velocity);
		m.temperature = sums[Sum::square] / sums[Sum::fraction] / D;
	}
	if (!stress) return m;
	const Real *contact = sums + Sum::contact, *kinetic = sums + Sum::kinetic;
	for (int a = 0; a < D; ++a) {
		for (int b = 0; b < D; ++b) m.contact_stress(a, b) = *contact++ / samples;
		for (int b = a; b < D; ++b) m.kinetic_stress(a, b) = m.kinetic_stress(b, a) = *kinetic++ / samples;
	}
	return m;
}

template void add_grain<2>(const FieldPlan<2>&, const FieldGrain<2>&, Real*);
template void add_grain<3>(const FieldPlan<3>&, const FieldGrain<3>&, Real*);
template void add_contact<2>(const FieldPlan<2>&, const FieldContact<2>&, Real*);
template void add_contact<3>(const FieldPlan<3>&, const FieldContact<3>&, Real*);
template FieldMeans<2> means_at<2>(const Real*, Real, bool);
template FieldMeans<3> means_at<3>(const Real*, Real, bool);

}  // namespace graindrive
