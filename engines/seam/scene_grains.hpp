/// Finds the source of all grains of a scene, and is that source on YADE's own loop.
#pragma once
#include "engines/base/grain_view.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive {

/// Grains from YADE's bodies, contacts from YADE's interactions, periods from YADE's cell.
class SceneGrains : public GrainSource {
public:
	void look(SceneView& view, bool with_contacts) override;

	/// The source of the scene's grains: an engine of O.engines that is a GrainSource (GrainLoop), else this object.
	GrainSource& of(yade::Scene* scene);

private:
	yade::Scene* scene_ = nullptr;
	std::vector<int> place_of_id_;

	void add_grains(SceneView& view);
	void add_contact(const yade::Interaction& interaction, SceneView& view) const;
};

/// True for what counts as a grain: no member of a clump, and free in x, y and in its rotation about z.
bool is_free_grain(const yade::Body& body);

}  // namespace graindrive
