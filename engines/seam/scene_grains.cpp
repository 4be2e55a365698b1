/// Finds the source of all grains of a scene, and is that source on YADE's own loop.
#include "engines/seam/scene_grains.hpp"

#include "engines/seam/scene_contacts.hpp"

namespace graindrive {

bool is_free_grain(const yade::Body& body)
{
	constexpr unsigned in_plane = yade::State::DOF_X | yade::State::DOF_Y | yade::State::DOF_RZ;
	return !body.isClumpMember() && !(body.state->blockedDOFs & in_plane);
}

GrainSource& SceneGrains::of(yade::Scene* scene)
{
	scene_ = scene;
	auto* loop = running_loop<GrainSource>(*scene);
	return loop ? *loop : *this;
}

void SceneGrains::look(SceneView& view, bool with_contacts)
{
	view.grains.clear();
	view.contacts.clear();
	view.periods = scene_->isPeriodic ? Vector3r(scene_->cell->hSize.diagonal()) : Vector3r(Vector3r::Zero());
	view.sheared = scene_->isPeriodic && (scene_->cell->hSize(0, 1) != 0 || !scene_->cell->velGrad.isZero(0));
	add_grains(view);
	if (!with_contacts) return;
	for (std::size_t id = 0; id < scene_->bodies->size(); ++id) {
		if (!scene_->bodies->exists(int(id))) continue;
		for (const auto& [partner, interaction] : (*scene_->bodies)[id]->intrs)
			if (interaction->getId1() == int(id)) add_contact(*interaction, view);  // each once, from its first body
	}
}

void SceneGrains::add_grains(SceneView& view)
{
	place_of_id_.assign(scene_->bodies->size(), no_grain);
	for (std::size_t id = 0; id < scene_->bodies->size(); ++id) {
		if (!scene_->bodies->exists(int(id))) continue;
		const yade::Body& body = *(*scene_->bodies)[id];
		const auto* sphere = dynamic_cast<const yade::Sphere*>(body.shape.get());
		if (!sphere) continue;
		const yade::State& s = *body.state;
		place_of_id_[id] = int(view.grains.size());
		view.grains.push_back({ int(id), is_free_grain(body), s.pos, s.vel, s.angVel, sphere->radius, s.mass });
	}
}

void SceneGrains::add_contact(const yade::Interaction& interaction, SceneView& view) const
{
	if (!interaction.isReal() || !interaction.isActive) return;
	const auto* geom = dynamic_cast<const yade::ScGeom*>(interaction.geom.get());
	const auto* phys = dynamic_cast<const yade::FrictPhys*>(interaction.phys.get());
	if (!geom || !phys) return;
	const Vector3r force = phys->normalForce + phys->shearForce;  // on body 2
	const int first = place_of_id_[interaction.getId1()], second = place_of_id_[interaction.getId2()];
	if (first != no_grain)
		view.contacts.push_back({ first, second, geom->normal, geom->penetrationDepth, force });
	else if (second != no_grain)  // a wall or facet stands first in YADE's pair, the grain in ours
		view.contacts.push_back({ second, no_grain, -geom->normal, geom->penetrationDepth, -force });
}

}  // namespace graindrive
