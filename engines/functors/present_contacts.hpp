/// Contacts of YADE's own loop at the present positions: the ones that its next step will find, before it is taken.
///
/// YADE's interactions are those of the last step, when positions were a step behind, and there are none before the first.
#pragma once
#include <vector>

#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"
#include "engines/laws/sphere_pair.hpp"

namespace graindrive {

/// One contact of two disks or spheres, in the order of YADE's interaction where there is one, else the smaller id first; or of a
/// Solid, which is body 1, and a sphere.
struct PresentContact {
	int id1, id2;
	Vector3r normal;            ///< from body 1 to that image of body 2 which touches it; out of a Solid
	Real overlap;               ///< [m]
	laws::PairResponse answer;  ///< forces on body 2 and the spring of body 1 against it
};

/// All contacts, by rising ids. Changes nothing. Left out are pairs that YADE does not let collide (members of one clump) and pairs
/// of frozen bodies, which no force moves. Springs are those that the interactions carry, lengthened as the next step will do.
/// @throws std::invalid_argument for a law that is not ours
std::vector<PresentContact> present_contacts(
	const yade::Scene& scene, const yade::LawFunctor& law, const Ip2_FrictMat_FrictMat_ContactPhys& contact_maker);

}  // namespace graindrive
