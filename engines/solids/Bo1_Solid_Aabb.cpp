/// Boxes of solids, infinite sides as large numbers.
#include "engines/solids/Bo1_Solid_Aabb.hpp"

#include "engines/geometry/rigid_motion.hpp"
#include "engines/solids/conversions.hpp"
#include "engines/solids/solid_checks.hpp"

namespace graindrive {

using namespace geometry;

const char* const Bo1_Solid_Aabb::documentation =
	"Makes the Aabb of a Solid for YADE's collider. Sides without end become +-1e100 m.\n\n"
	"A solid whose rotations are all blocked and that does not spin has the box of its present orientation. Any other has the "
	"box of\n"
	"the ball about state.pos in which it turns: the collider does not see that bodies turn. Set the spin of a driven solid "
	"before\n"
	"the run, or leave one rotation free.\n"
	"In a periodic cell, whose edges must be perpendicular, a solid must go on without end along an axis, with\n"
	"InsertionSortCollider(allowBiggerThanPeriod=True), or be no longer than half of the cell; O.run raises ValueError for "
	"another.";

namespace {

constexpr Real far_away = 1e100;  // [m]: finite, so that the collider's sums are numbers

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
	for (int k = 0; k < 3; ++k) {
		bound->min[k] = std::max(box.low[k], -far_away);
		bound->max[k] = std::min(box.high[k], far_away);
	}
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::Bo1_Solid_Aabb, "Bo1_Solid_Aabb")
