/// Finds the source of a scene's contacts, and is that source on YADE's own loop.
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

/// Called at every step, because members may be erased, released or added.
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

/// False while YADE's InteractionLoop is dead: contacts then stay as they were, but no force acts.
bool contacts_act(const yade::Scene& scene)
{
	bool dead = false;
	for (const auto& engine : scene.engines) {
		if (engine->getClassName() != "InteractionLoop") continue;
		if (!engine->dead) return true;
		dead = true;
	}
	return !dead;
}

/// Coulomb's bound, if the law itself does not report slipping: YADE's own laws leave |F_t| exactly at the bound.
bool at_coulomb_bound(const yade::FrictPhys& phys)
{
	const Real bound = phys.tangensOfFrictionAngle * phys.normalForce.norm();
	return bound > 0 && phys.shearForce.norm() >= bound * (1 - 1e-12);
}

/// A force that is unknown must not count as zero.
[[noreturn]] void refuse_contact(int body, const yade::Interaction& interaction)
{
	throw std::runtime_error("the force of a contact on body " + std::to_string(body) + " is not known: it is a " +
							 interaction.geom->getClassName() + " with " + interaction.phys->getClassName() +
							 "; drives and measures read ScGeom with FrictPhys and what derives from them");
}

/// From the centre of a contact's body to where the law lets the tangential force act, in the body's own periodic image: YADE's
/// contact point lies in that of body 1. Graindrive's laws leave their lever in the contact; YADE's act at the contact point.
Vector3r lever_of(const yade::Body& member, bool first, const yade::ScGeom& geom, const ContactPhys* ours)
{
	if (!dynamic_cast<const yade::Sphere*>(member.shape.get())) return geom.contactPoint - member.state->pos;  // box, facet
	const Real reach = (first ? geom.refR1 : geom.refR2) - (ours ? ours->leverLoss : geom.penetrationDepth / 2);
	return (first ? reach : -reach) * geom.normal;
}

}  // namespace

void SceneContacts::contacts_on(int body, std::vector<BodyContact>& contacts)
{
	const Vector3r centre = body_of(*scene_, body, "contacts").state->pos;
	const std::vector<int>& members = members_of(body);
	if (!contacts_act(*scene_)) return;
	for (const int id : members) {
		const yade::Body& member = *(*scene_->bodies)[id];
		for (const auto& [partner, interaction] : member.intrs) {
			if (!interaction->isReal() || !interaction->isActive) continue;
			const auto* geom = dynamic_cast<const yade::ScGeom*>(interaction->geom.get());
			const auto* phys = dynamic_cast<const yade::FrictPhys*>(interaction->phys.get());
			if (!geom || !phys) refuse_contact(id, *interaction);
			const bool first = interaction->getId1() == id;
			const Real sign = first ? -1 : 1;  // normalForce and shearForce act on body 2
			const auto* ours = dynamic_cast<const ContactPhys*>(phys);
			const Vector3r lever = member.state->pos - centre + lever_of(member, first, *geom, ours);
			contacts.push_back({ id, partner, lever, sign * phys->normalForce, sign * phys->shearForce,
				ours ? ours->slipping : at_coulomb_bound(*phys) });
		}
	}
}

/// Only the contacts' forces: YADE's force container also holds forces of other sources (ForceEngine, O.forces.setPermF).
Wrench SceneContacts::wrench_on(int body)
{
	found_.clear();
	contacts_on(body, found_);
	Wrench sum;
	for (const BodyContact& contact : found_) {
		const Vector3r force = contact.normal_force + contact.tangential_force;
		sum.force += force;
		sum.torque += contact.lever.cross(force);
	}
	return sum;
}

}  // namespace graindrive
