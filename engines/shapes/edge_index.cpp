/// Finds edges near a point or box in an R-tree of Boost.Geometry.
#include "engines/shapes/edge_index.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <limits>

namespace graindrive::shapes {

namespace {

namespace bgi = boost::geometry::index;
using BoostPoint = boost::geometry::model::d2::point_xy<Real>;
using BoostBox = boost::geometry::model::box<BoostPoint>;
using Entry = std::pair<BoostBox, std::size_t>;

BoostBox boost_box(const Box& box) { return { { box.min().x(), box.min().y() }, { box.max().x(), box.max().y() } }; }

std::vector<Entry> numbered(const std::vector<Box>& boxes)
{
	std::vector<Entry> entries;
	for (std::size_t i = 0; i < boxes.size(); ++i) entries.emplace_back(boost_box(boxes[i]), i);
	return entries;
}

std::vector<Box> boxes_of_edges(const Points& corners)
{
	std::vector<Box> boxes;
	for (std::size_t i = 0; i < corners.size(); ++i) boxes.push_back(Box(corners[i]).extend(corners[(i + 1) % corners.size()]));
	return boxes;
}

}  // namespace

Box grown(const Box& box, Real margin)
{
	return { Vector2r(box.min() - Vector2r::Constant(margin)), Vector2r(box.max() + Vector2r::Constant(margin)) };
}

struct BoxIndex::Tree : bgi::rtree<Entry, bgi::quadratic<16>> {
	using bgi::rtree<Entry, bgi::quadratic<16>>::rtree;
};

BoxIndex::BoxIndex(const std::vector<Box>& boxes) : tree_(std::make_unique<Tree>(numbered(boxes))) {}
BoxIndex::~BoxIndex() = default;

std::vector<std::size_t> BoxIndex::near(const Box& place) const
{
	std::vector<std::size_t> found;
	for (auto it = tree_->qbegin(bgi::intersects(boost_box(place))); it != tree_->qend(); ++it) found.push_back(it->second);
	return found;
}

EdgeIndex::EdgeIndex(const Points& corners) : corners_(corners), index_(boxes_of_edges(corners)) {}

Real EdgeIndex::distance(const Vector2r& point, Real most) const
{
	Real nearest = std::numeric_limits<Real>::infinity();
	for (const std::size_t i : near(grown(Box(point), most)))
		nearest = std::min(nearest, distance_to_segment(point, corner(i), corner(i + 1)));
	return nearest <= most ? nearest : std::numeric_limits<Real>::infinity();
}

Real distance_to_segment(const Vector2r& point, const Vector2r& a, const Vector2r& b)
{
	const Vector2r edge = b - a, to = point - a;
	const Real along = std::clamp(to.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
	return (to - along * edge).norm();
}

}  // namespace graindrive::shapes
