/// Gives a clump the centre of mass of the body that it represents; YADE uses the centre of its members' masses.
#include <boost/python.hpp>

#include "engines/seam/registered.hpp"
#include "engines/seam/scene_contacts.hpp"

namespace graindrive {
namespace {

namespace py = boost::python;

/// YADE also turns a new clump to its principal axes, even out of the plane; places in the clump refer to both.
void centre_clump(const yade::Scene& scene, int id, const Vector3r& centre)
{
	yade::Body& body = body_of(scene, id, "centre_clump");
	require(body.isClump(), "centre_clump takes the id of a clump, as O.bodies.appendClumped returns it", id);
	require(centre.allFinite(), "centre_clump: the centre must be finite", centre.transpose());
	for (auto& [member, place] : static_cast<yade::Clump&>(*body.shape).members) {
		const yade::State& state = *body_of(scene, member, "centre_clump").state;
		place.position = state.pos - centre;
		std::copy(state.ori.coeffs().data(), state.ori.coeffs().data() + 4, place.orientation);
	}
	body.state->pos = body.state->refPos = centre;
	body.state->ori = body.state->refOri = Quaternionr::Identity();
}

}  // namespace

void bind_clumps()
{
	py::def("centre_clump", centre_clump, (py::arg("scene"), py::arg("clump"), py::arg("centre")),
		"Set the position of a clump of a scene (O._sceneObj) to `centre` [m] and its orientation to the identity; its members\n"
		"do not move.\n\n"
		"This is for bodies whose centre of mass is not that of their beads. The caller must set mass and inertia about that\n"
		"centre. Raises RuntimeError for a body that does not exist, ValueError for a body that is no clump.");
}

}  // namespace graindrive
