/// All grains and contacts of a scene at the present positions, as fields see them, whichever loop runs.
#pragma once
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive {

struct GrainState {
	int id;             ///< of YADE's body
	bool free;          ///< a grain: no member of a clump, and free to move and turn in the plane
	Vector3r position;  ///< of the centre, in any periodic image [m]
	Vector3r velocity;  ///< half a step behind the position, as leapfrog has it [m/s]
	Vector3r spin;      ///< [rad/s]
	Real radius;        ///< [m]
	Real mass;          ///< [kg]
};

constexpr int no_grain = -1;  ///< `GrainContact::second` of a contact with what is no disk or sphere: a flat wall

struct GrainContact {
	int first, second;  ///< places in `SceneView::grains`
	Vector3r normal;    ///< from the first to the second
	Real overlap;       ///< [m]
	Vector3r force;     ///< on the second [N]
};

struct SceneView {
	std::vector<GrainState> grains;
	std::vector<GrainContact> contacts;
	Vector3r periods = Vector3r::Zero();  ///< lengths after which the box repeats [m], 0 where it does not
	bool sheared = false;                 ///< images one period further in y are displaced along x, or move
};

/// A source of grains and contacts: YADE's bodies and interactions, or GrainLoop.
class GrainSource {
public:
	virtual ~GrainSource() = default;
	/// Fills `view`; contacts only if asked for, since they cost time.
	virtual void look(SceneView& view, bool with_contacts) = 0;
};

}  // namespace graindrive
