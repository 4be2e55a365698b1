/// Finds the source of a scene's contacts, and is that source on YADE's own loop.
#pragma once
#include "engines/base/contact_view.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive {

/// Contacts, and their forces, from YADE's interactions.
class SceneContacts : public ContactSource {
public:
	void contacts_on(int body, std::vector<BodyContact>& contacts) override;
	Wrench wrench_on(int body) override;

	/// The source of the scene's contacts: an engine of O.engines that is a ContactSource (GrainLoop), else this object.
	ContactSource& of(yade::Scene* scene);

	/// Ids that make up a body: its clump's members, or itself.
	/// @throws std::runtime_error if there is no such body
	const std::vector<int>& members_of(int body);

private:
	yade::Scene* scene_ = nullptr;
	std::vector<int> members_;
	std::vector<BodyContact> found_;
};

/// The engine of O.engines that answers in place of YADE's own containers (GrainLoop), or null.
///
/// It is told its scene: YADE does so only when the engine's own turn comes, and after O.load it still knows the scene before.
template <class Source>
Source* running_loop(yade::Scene& scene)
{
	for (const auto& engine : scene.engines)
		if (auto* source = dynamic_cast<Source*>(engine.get()); source && !engine->dead) {
			engine->scene = &scene;
			return source;
		}
	return nullptr;
}

/// The body of that id.
/// @throws std::runtime_error naming `who` if it does not exist (any more)
yade::Body& body_of(const yade::Scene& scene, int id, const std::string& who);

}  // namespace graindrive
