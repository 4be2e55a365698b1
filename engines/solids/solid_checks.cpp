/// The rules for solids, and the common error message.
#include "engines/solids/solid_checks.hpp"

#include <mutex>

#include "engines/solids/Bo1_Solid_Aabb.hpp"

namespace graindrive {

namespace {

struct Complaint {
	std::mutex mutex;
	std::string text;
};

Complaint& the_complaint()
{
	static Complaint one;
	return one;
}

std::string named(const yade::Body& body, const std::string& rule)
{
	return "the Solid of body " + std::to_string(body.id) + " " + rule;
}

geometry::Bounds<3> box_of(const yade::Body& body)
{
	return box_around(static_cast<const Solid&>(*body.shape), { body.state->pos, body.state->ori }, *body.state);
}

/// YADE's collider finds the images of bodies shorter than half of the cell only.
void require_fits(const yade::Scene& scene, const yade::Body& body)
{
	const geometry::Bounds<3> box = box_of(body);
	for (int k = 0; k < 3; ++k) {
		const Real length = box.high[k] - box.low[k], half = scene.cell->hSize(k, k) / 2;
		if (length <= half || std::isinf(length)) continue;
		std::ostringstream message;
		message << named(body, "must be endless or no longer than half of the periodic cell along ") << "xyz"[k] << ", " << half
				<< ", got " << length << "; YADE's collider would miss contacts. Make the cell longer, or the solid endless";
		throw std::invalid_argument(message.str());
	}
}

void require_usable(const yade::Scene& scene, const yade::Body& body)
{
	if (!static_cast<const Solid&>(*body.shape).surface())
		throw std::invalid_argument(named(body, "needs a surface, got none; give Solid(surface) or Solid(recipe='...')"));
	if (scene.isPeriodic) require_fits(scene, body);
}

bool has_collider(const yade::Scene& scene)
{
	for (const auto& engine : scene.engines)
		if (!engine->dead && engine->getClassName() == "InsertionSortCollider") return true;
	return false;
}

template <class Visit>
void for_each_solid(const yade::Scene& scene, Visit&& visit)
{
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) {
		if (!scene.bodies->exists(int(id))) continue;
		const yade::Body& body = *(*scene.bodies)[id];
		if (is_solid(body.shape.get())) visit(body);
	}
}

/// A sampled distance is a bound from below beyond its grid: a sphere larger than the grid's margin would touch nothing there.
void require_small_spheres(const yade::Scene& scene, const yade::Body& solid)
{
	const double largest = static_cast<const Solid&>(*solid.shape).surface()->largest_sphere();
	if (std::isinf(largest)) return;
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) {
		if (!scene.bodies->exists(int(id))) continue;
		const auto* sphere = dynamic_cast<const yade::Sphere*>((*scene.bodies)[id]->shape.get());
		if (!sphere || sphere->radius <= largest) continue;
		std::ostringstream message;
		message << named(solid, "is sampled for spheres of radii up to ") << largest
				<< ", the distance that its grid keeps around it, got " << sphere->radius << " of body " << id
				<< "; sample it in a wider box";
		throw std::invalid_argument(message.str());
	}
}

void require_perpendicular_cell(const yade::Scene& scene)
{
	const auto& edges = scene.cell->hSize;
	for (int row = 0; row < 3; ++row)
		for (int column = 0; column < 3; ++column)
			if (row != column && edges(row, column) != 0)
				throw std::invalid_argument("a periodic cell with a Solid must have perpendicular edges, got a sheared one; "
											"leave O.cell.velGrad at zero");
}

}  // namespace

void check_solids(const yade::Scene& scene)
{
	if (!has_collider(scene)) return;
	for_each_solid(scene, [&](const yade::Body& body) {
		if (scene.isPeriodic) require_perpendicular_cell(scene);
		require_usable(scene, body);
		require_small_spheres(scene, body);
	});
}

bool solids_outgrow_cell(const yade::Scene& scene)
{
	bool outgrow = false;
	if (scene.isPeriodic && has_collider(scene))
		for_each_solid(scene, [&](const yade::Body& body) {
			const geometry::Bounds<3> box = box_of(body);
			outgrow = outgrow || !geometry::is_finite(box.high) || !geometry::is_finite(box.low);
		});
	return outgrow;
}

bool complain_unless_usable(yade::Scene& scene, const yade::Body& body)
{
	try {
		require_usable(scene, body);
		return true;
	} catch (const std::exception& error) {
		complain(scene, error.what());
		return false;
	}
}

void complain(yade::Scene& scene, const std::string& text)
{
	Complaint& complaint = the_complaint();
	const std::lock_guard<std::mutex> lock(complaint.mutex);
	if (complaint.text.empty()) complaint.text = text;
	scene.stopAtIter = scene.iter + 1;
}

std::string take_complaint()
{
	Complaint& complaint = the_complaint();
	const std::lock_guard<std::mutex> lock(complaint.mutex);
	return std::exchange(complaint.text, {});
}

}  // namespace graindrive
