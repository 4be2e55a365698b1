/// Decides how our laws treat a contact of YADE: as two disks or spheres, or as a solid and a sphere.
#pragma once
#include "engines/laws/sphere_pair.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive {

/// Where two bodies touch.
struct PairGeometry {
	Vector3r normal;         ///< from body 1 to body 2
	Real overlap;            ///< [m]
	Real radius1, radius2;   ///< [m]; of a solid there is none
	bool solid = false;      ///< body 1 is a Solid
	Vector3r contact_point;  ///< of a solid, the middle of the overlap in its own image [m]
	Vector3r image_velocity =
		Vector3r::Zero();  ///< of the image of body 2 that is met, against body 2, where the cell deforms [m/s]

	Real effective_radius() const { return solid ? radius2 : laws::effective_radius(radius1, radius2); }
};

/// The pair of a contact; a solid always stands first. Walls, facets and boxes of YADE's count as spheres of
/// the radius that their Ig2_ gives them, which is the sphere's.
PairGeometry pair_geometry(const yade::Scene& scene, const yade::ScGeom& geom, const yade::Interaction& contact);

}  // namespace graindrive
