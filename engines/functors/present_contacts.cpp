/// Contacts of YADE's own loop at the present positions: the ones that its next step will find, before it is taken.
#include "engines/functors/present_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "engines/functors/contact_law_functors.hpp"
#include "engines/solids/Solid.hpp"
#include "engines/solids/conversions.hpp"

namespace graindrive {

namespace {

using Answer = std::function<laws::PairResponse(const PairGeometry&, const ContactPhys&, int, int)>;

template <class Law>
bool is(const yade::LawFunctor& law, const yade::Scene& scene, Answer& answer)
{
	const auto* ours = dynamic_cast<const Law*>(&law);
	if (!ours) return false;
	answer = [ours, &scene](const PairGeometry& pair, const ContactPhys& phys, int id1, int id2) {
		return ours->answer(scene, pair, phys, id1, id2);
	};
	return true;
}

Answer answer_of(const yade::LawFunctor& law, const yade::Scene& scene)
{
	Answer answer;
	bool found = false;
	std::string ours;
	for_each_law_functor([&](auto kind) {
		using Functor = std::remove_cv_t<std::remove_pointer_t<decltype(kind)>>;
		found = found || is<Functor>(law, scene, answer);
		ours += std::string(ours.empty() ? "" : ", ") + Functor::class_name;
	});
	if (found) return answer;
	throw std::invalid_argument("present_contacts needs one of Graindrive's laws, " + ours + ", got " + law.getClassName());
}

struct Extent {
	int id;
	Real low, width;  ///< [m] along x
};

/// Extents of all bodies along x, sorted by their lower ends; in a periodic cell these lie in [0, period).
std::vector<Extent> extents(const yade::Scene& scene, Real period)
{
	std::vector<Extent> found;
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) {
		if (!scene.bodies->exists(int(id))) continue;
		const yade::Body& body = *(*scene.bodies)[id];
		const auto* sphere = dynamic_cast<const yade::Sphere*>(body.shape.get());
		if (!sphere) continue;
		const Real low = body.state->pos[0] - sphere->radius;
		found.push_back({ int(id), period > 0 ? low - period * std::floor(low / period) : low, 2 * sphere->radius });
	}
	std::sort(found.begin(), found.end(), [](const Extent& a, const Extent& b) { return a.low < b.low; });
	return found;
}

/// Pairs whose extents along x overlap, each once, the smaller id first, in rising order.
std::vector<std::pair<int, int>> pairs_along_x(const std::vector<Extent>& extents, Real period)
{
	std::vector<std::pair<int, int>> pairs;
	const std::size_t n = extents.size();
	for (std::size_t a = 0; a < n; ++a)
		for (std::size_t k = a + 1; k < a + (period > 0 ? n : n - a); ++k) {
			const Extent& b = extents[k % n];
			if (b.low + (k < n ? 0 : period) > extents[a].low + extents[a].width) break;
			pairs.push_back(std::minmax({ extents[a].id, b.id }));
		}
	std::sort(pairs.begin(), pairs.end());
	pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
	return pairs;
}

/// A separation, moved by whole periods to the shortest.
Vector3r nearest_image(Vector3r d, const Vector3r& periods)
{
	for (int axis = 0; axis < 3; ++axis)
		if (periods[axis] > 0) d[axis] -= periods[axis] * std::nearbyint(d[axis] / periods[axis]);
	return d;
}

/// From body 1 to the nearest image of body 2.
Vector3r separation(const yade::Scene& scene, int id1, int id2, const Vector3r& periods)
{
	return nearest_image((*scene.bodies)[id2]->state->pos - (*scene.bodies)[id1]->state->pos, periods);
}

const yade::Interaction* real_interaction(const yade::Body& body, int partner)
{
	const auto found = body.intrs.find(partner);
	return found != body.intrs.end() && found->second->isReal() ? found->second.get() : nullptr;
}

Real radius_of(const yade::Body& body) { return static_cast<const yade::Sphere&>(*body.shape).radius; }

/// The data of a contact: from YADE's interaction, or as a new contact will get them.
class Carried {
public:
	Carried(const yade::Scene& scene, const yade::Interaction* known, Real radius, int id1, int id2,
		const Ip2_FrictMat_FrictMat_ContactPhys& contact_maker)
		: carried_(known ? dynamic_cast<const ContactPhys*>(known->phys.get()) : nullptr)
	{
		const yade::Body &one = *(*scene.bodies)[id1], &two = *(*scene.bodies)[id2];
		if (!carried_)
			made_ = contact_phys_of(scene, radius, id1, id2, contact_maker.friction_between(*one.material, *two.material));
	}
	const ContactPhys& phys() const { return carried_ ? *carried_ : *made_; }

private:
	const ContactPhys* carried_;
	yade::shared_ptr<ContactPhys> made_;
};

/// The contact of a pair of spheres, if they touch and a force between them can matter.
std::optional<PresentContact> contact_of(const yade::Scene& scene, std::pair<int, int> ids, const Vector3r& periods,
	const Ip2_FrictMat_FrictMat_ContactPhys& contact_maker, const Answer& answer)
{
	auto [id1, id2] = ids;
	const yade::Interaction* known = real_interaction(*(*scene.bodies)[id1], id2);
	if (known) id1 = known->getId1(), id2 = known->getId2();
	const yade::Body &one = *(*scene.bodies)[id1], &two = *(*scene.bodies)[id2];
	const auto [normal, overlap] = laws::placement(separation(scene, id1, id2, periods), radius_of(one), radius_of(two));
	if (!(overlap >= 0) || (one.isClumpMember() && one.clumpId == two.clumpId)) return {};
	const Carried carried(scene, known, laws::effective_radius(radius_of(one), radius_of(two)), id1, id2, contact_maker);
	const ContactPhys& phys = carried.phys();
	if (phys.effectiveMass == 0) return {};
	const PairGeometry pair{ normal, overlap, radius_of(one), radius_of(two), false, {} };
	return PresentContact{ id1, id2, pair.normal, overlap, answer(pair, phys, id1, id2) };
}

/// The middle of the bounds along axes in which they end, else 0.
geometry::Vec<3> middle_of(const geometry::Bounds<3>& box)
{
	geometry::Vec<3> middle{};
	for (int axis = 0; axis < 3; ++axis) {
		const Real sum = box.low[axis] + box.high[axis];
		if (std::isfinite(sum)) middle[axis] = sum / 2;
	}
	return middle;
}

/// False if a point is farther than `reach` from the bounds, so that the surface need not be evaluated.
bool is_near(const geometry::Bounds<3>& box, const geometry::Vec<3>& point, Real reach)
{
	for (int axis = 0; axis < 3; ++axis)
		if (point[axis] < box.low[axis] - reach || point[axis] > box.high[axis] + reach) return false;
	return true;
}

/// The contact that Ig2_Solid_Sphere_ScGeom will find for a sphere at `centre`, in the solid's own image.
PairGeometry touch_of(const Solid& solid, const geometry::RigidMotion<3>& place, const Vector3r& centre, Real radius)
{
	const geometry::Nearest<3> nearest = place.nearest(*solid.surface(), vec(centre));
	const Vector3r normal = vector(nearest.normal);
	const Real overlap = radius - nearest.distance;
	return { normal, overlap, radius, radius, true, centre - (radius - overlap / 2) * normal };
}

/// Appends the contacts of a solid with all spheres of the scene.
void append_touches(const yade::Scene& scene, int solid_id, const Vector3r& periods,
	const Ip2_FrictMat_FrictMat_ContactPhys& contact_maker, const Answer& answer, std::vector<PresentContact>& found)
{
	const yade::Body& body = *(*scene.bodies)[solid_id];
	const auto& solid = static_cast<const Solid&>(*body.shape);
	if (!solid.surface()) return;
	const auto place = motion_of(body.state->pos, body.state->ori);
	const geometry::Bounds<3> box = solid.surface()->bounds();
	const Vector3r middle = vector(place.to_world(middle_of(box)));
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) {
		if (!scene.bodies->exists(int(id))) continue;
		const yade::Body& other = *(*scene.bodies)[id];
		if (!dynamic_cast<const yade::Sphere*>(other.shape.get())) continue;
		if (body.isClumpMember() && body.clumpId == other.clumpId) continue;
		const Vector3r centre = middle + nearest_image(other.state->pos - middle, periods);
		if (!is_near(box, place.to_frame(vec(centre)), radius_of(other))) continue;
		const PairGeometry pair = touch_of(solid, place, centre, radius_of(other));
		if (!(pair.overlap >= 0)) continue;
		const Carried carried(scene, real_interaction(body, int(id)), pair.effective_radius(), solid_id, int(id), contact_maker);
		if (carried.phys().effectiveMass == 0) continue;
		found.push_back({ solid_id, int(id), pair.normal, pair.overlap, answer(pair, carried.phys(), solid_id, int(id)) });
	}
}

}  // namespace

std::vector<PresentContact> present_contacts(
	const yade::Scene& scene, const yade::LawFunctor& law, const Ip2_FrictMat_FrictMat_ContactPhys& contact_maker)
{
	const Answer answer = answer_of(law, scene);
	const Vector3r periods = scene.isPeriodic ? Vector3r(scene.cell->hSize.colwise().norm()) : Vector3r(Vector3r::Zero());
	if (scene.isPeriodic && scene.cell->hSize(0, 1) != 0)
		throw std::invalid_argument("present_contacts does not support a tilted cell; read O.interactions after a step");
	std::vector<PresentContact> found;
	for (const auto& pair : pairs_along_x(extents(scene, periods[0]), periods[0]))
		if (const auto contact = contact_of(scene, pair, periods, contact_maker, answer)) found.push_back(*contact);
	for (std::size_t id = 0; id < scene.bodies->size(); ++id)
		if (scene.bodies->exists(int(id)) && is_solid((*scene.bodies)[id]->shape.get()))
			append_touches(scene, int(id), periods, contact_maker, answer, found);
	std::sort(found.begin(), found.end(), [](const PresentContact& a, const PresentContact& b) {
		return std::minmax({ a.id1, a.id2 }) < std::minmax({ b.id1, b.id2 });
	});
	return found;
}

}  // namespace graindrive
