/// Boxes of solids, infinite sides as large numbers, in a periodic cell as just under two periods.
#include "engines/solids/Bo1_Solid_Aabb.hpp"

#include <limits>

#include "engines/geometry/rigid_motion.hpp"
#include "engines/solids/conversions.hpp"
#include "engines/solids/solid_checks.hpp"

namespace graindrive {

using namespace geometry;

const char* const Bo1_Solid_Aabb::documentation =
	"Makes the Aabb of a Solid for YADE's collider. Endless sides become +-1e100 m, or just under two periods in a\n"
	"periodic cell.\n\n"
	"A solid whose rotations are all blocked and that does not spin gets the box of its present orientation. Any other\n"
	"solid gets the box of the ball about state.pos that contains it in every orientation, because the collider does not\n"
	"notice rotations. Set the spin of a driven solid before the run, or leave one rotation free. In a periodic cell,\n"
	"whose edges must be perpendicular, a solid must either be endless along an axis, with\n"
	"InsertionSortCollider(allowBiggerThanPeriod=True), or be no longer than half of the cell; for any other O.run raises\n"
	"ValueError.";

namespace {

constexpr Real far_away = 1e100;  // [m]: finite, so that the collider's sums are finite
constexpr Real gap_over_radius = 1.9;

bool may_turn(const yade::State& state)
{
	constexpr unsigned rotations = yade::State::DOF_RX | yade::State::DOF_RY | yade::State::DOF_RZ;
	return (state.blockedDOFs & rotations) != rotations || !state.angVel.isZero(0);
}

/// The radius of the ball about the frame's origin that holds a box.
Real reach(const Bounds<3>& box)
{
	Vec<3> farthest;
	for (int k = 0; k < 3; ++k) farthest[k] = std::max(std::abs(box.low[k]), std::abs(box.high[k]));
	return norm(farthest);
}

/// The radius of the smallest sphere of a scene, infinite without one.
Real smallest_radius(const yade::Scene& scene)
{
	Real smallest = std::numeric_limits<Real>::infinity();
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) {
		if (!scene.bodies->exists(int(id))) continue;
		const auto* sphere = dynamic_cast<const yade::Sphere*>((*scene.bodies)[id]->shape.get());
		if (sphere) smallest = std::min(smallest, sphere->radius);
	}
	return smallest;
}

/// Cuts endless sides to just under two periods.
///
/// The collider moves a bound into the cell by whole periods, counted in an int: a bound at 1e100 never gets there, and its
/// second sort does not end. A box longer than a period overlaps everything along that axis. The first sort walks through the
/// cell from the lower to the upper bound, which must lie less than a sphere below the lower one, so that a sphere that begins in
/// the gap ends behind it; and not above it after the collider has widened the box on each side by its verletDist, by default
/// half of the smallest radius.
void cut_to_periods(yade::Bound& box, const yade::Scene& scene)
{
	const Real gap = gap_over_radius * smallest_radius(scene);
	for (int k = 0; k < 3; ++k) {
		const Real period = scene.cell->hSize(k, k), length = 2 * period - std::min(gap, period / 2);
		const bool low = std::isinf(box.min[k]), high = std::isinf(box.max[k]);
		if (low && high) box.min[k] = period / 2;  // away from the cell's sides, where round-off would wrap it
		if (high)
			box.max[k] = box.min[k] + length;
		else if (low)
			box.min[k] = box.max[k] - length;
	}
}

}  // namespace

Bounds<3> box_around(const Solid& solid, const yade::Se3r& place, const yade::State& state)
{
	const Bounds<3> own = solid.surface()->bounds();
	if (!may_turn(state)) return motion_of(place.position, place.orientation).bounds(own);
	const Vec<3> centre = vec(place.position), all_ways = Vec<3>::all(reach(own));
	return { centre - all_ways, centre + all_ways };
}

void Bo1_Solid_Aabb::go(const yade::shared_ptr<yade::Shape>& shape, yade::shared_ptr<yade::Bound>& bound, const yade::Se3r& place,
	const yade::Body* body)
{
	const auto& solid = static_cast<const Solid&>(*shape);
	if (!bound) bound = boost::static_pointer_cast<yade::Bound>(Singleton<yade::ClassFactory>::instance().createShared("Aabb"));
	bound->min = bound->max = place.position;
	if (!complain_unless_usable(*scene, *body)) return;
	const Bounds<3> box = box_around(solid, place, *body->state);
	for (int k = 0; k < 3; ++k) bound->min[k] = box.low[k], bound->max[k] = box.high[k];
	if (scene->isPeriodic) return cut_to_periods(*bound, *scene);
	for (int k = 0; k < 3; ++k) {
		bound->min[k] = std::max(bound->min[k], -far_away);
		bound->max[k] = std::min(bound->max[k], far_away);
	}
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Bo1_Solid_Aabb)
