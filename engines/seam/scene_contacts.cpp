/// Finds who knows the contacts of a scene, and answers for YADE's own loop.
#include "engines/seam/scene_contacts.hpp"

#include "engines/seam/contact_phys.hpp"

namespace graindrive {

yade::Body& body_of(const yade::Scene& scene, int id, const std::string& who)
{
	if (!scene.bodies->exists(id))
		throw std::runtime_error(
			who + ": body " + std::to_string(id) + " does not exist in this scene; give the id that O.bodies.append returned");
	return *(*scene.bodies)[id];
}

ContactSource& SceneContacts::of(yade::Scene* scene)
{
	scene_ = scene;
	auto* loop = running_loop<ContactSource>(*scene);
	return loop ? *loop : *this;
}

/// Asked anew every step: members may be erased, released or added.
const std::vector<int>& SceneContacts::members_of(int body)
{
	const yade::Body& driven = body_of(*scene_, body, "contacts");
	members_.clear();
	if (!driven.isClump())
		members_.push_back(body);
	else
		for (const auto& [id, place] : static_cast<const yade::Clump&>(*driven.shape).members)
			if (scene_->bodies->exists(id)) members_.push_back(id);
	if (members_.empty()) throw std::runtime_error("clump " + std::to_string(body) + " has no members");
	return members_;
}

namespace {

/// Coulomb's bound, where the law itself does not tell: YADE's own laws leave |F_t| exactly at the bound.
bool at_coulomb_bound(const yade::FrictPhys& phys)
{
	const Real bound = phys.tangensOfFrictionAngle * phys.normalForce.norm();
	return bound > 0 && phys.shearForce.norm() >= bound * (1 - 1e-12);
}

}  // namespace

void SceneContacts::contacts_on(int body, std::vector<BodyContact>& contacts)
{
	const Vector3r centre = body_of(*scene_, body, "contacts").state->pos;
	for (const int id : members_of(body)) {
		const yade::Body& member = *(*scene_->bodies)[id];
		for (const auto& [partner, interaction] : member.intrs) {
			if (!interaction->isReal() || !interaction->isActive) continue;
			const auto* geom = dynamic_cast<const yade::ScGeom*>(interaction->geom.get());
			const auto* phys = dynamic_cast<const yade::FrictPhys*>(interaction->phys.get());
			if (!geom || !phys) continue;
			const bool first = interaction->getId1() == id;
			// From the member's own centre: the contact point of YADE lies in body 1's periodic image.
			const Real reach = (first ? geom->refR1 : geom->refR2) - geom->penetrationDepth / 2;
			const Vector3r outward = first ? geom->normal : Vector3r(-geom->normal);
			const Real sign = first ? -1 : 1;  // normalForce and shearForce act on body 2
			const auto* ours = dynamic_cast<const ContactPhys*>(phys);
			contacts.push_back({ id, partner, member.state->pos - centre + reach * outward, sign * phys->normalForce,
				sign * phys->shearForce, ours ? ours->slipping : at_coulomb_bound(*phys) });
		}
	}
}

Wrench SceneContacts::wrench_on(int body)
{
	const Vector3r centre = body_of(*scene_, body, "contacts").state->pos;
	Wrench sum;
	for (const int id : members_of(body)) {
		const Vector3r force = scene_->forces.getForceSingle(id);
		sum.force += force;
		sum.torque += scene_->forces.getTorqueSingle(id) + ((*scene_->bodies)[id]->state->pos - centre).cross(force);
	}
	return sum;
}

}  // namespace graindrive
