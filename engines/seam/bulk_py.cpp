/// Bodies and contacts of a scene as NumPy arrays, without a Python loop.
#include <boost/python/numpy.hpp>

#include "engines/seam/contact_phys.hpp"
#include "engines/seam/numpy_array.hpp"

namespace graindrive {
namespace {

namespace py = boost::python;
namespace np = boost::python::numpy;

using seam::array_of;

void append(std::vector<Real>& rows, const Vector3r& v) { rows.insert(rows.end(), v.data(), v.data() + 3); }

/// Spheres only (a clump is seen through its members), in the order of their ids.
py::dict bodies(const yade::Scene& scene)
{
	std::vector<int> id, clump;
	std::vector<Real> position, velocity, spin, radius, mass;
	for (std::size_t i = 0; i < scene.bodies->size(); ++i) {
		if (!scene.bodies->exists(int(i))) continue;
		const yade::Body& body = *(*scene.bodies)[i];
		const auto* sphere = dynamic_cast<const yade::Sphere*>(body.shape.get());
		if (!sphere) continue;
		id.push_back(int(i));
		clump.push_back(body.clumpId);
		radius.push_back(sphere->radius);
		mass.push_back(body.state->mass);
		append(position, body.state->pos);
		append(velocity, body.state->vel);
		append(spin, body.state->angVel);
	}
	py::dict table;
	table["id"] = array_of(id), table["clump"] = array_of(clump), table["radius"] = array_of(radius),
	table["mass"] = array_of(mass);
	table["position"] = array_of(position, 3), table["velocity"] = array_of(velocity, 3), table["spin"] = array_of(spin, 3);
	return table;
}

py::dict contacts(const yade::Scene& scene)
{
	std::vector<int> i, j, slipping;
	std::vector<Real> point, normal, normal_force, tangential_force, overlap, slip;
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) {
		if (!scene.bodies->exists(int(id))) continue;
		for (const auto& [partner, interaction] : (*scene.bodies)[id]->intrs) {
			if (interaction->getId1() != int(id) || !interaction->isReal()) continue;  // each contact once, from its first body
			const auto* geom = dynamic_cast<const yade::ScGeom*>(interaction->geom.get());
			const auto* phys = dynamic_cast<const yade::FrictPhys*>(interaction->phys.get());
			if (!geom || !phys) continue;
			const auto* ours = dynamic_cast<const ContactPhys*>(phys);
			i.push_back(interaction->getId1());
			j.push_back(interaction->getId2());
			slipping.push_back(ours ? ours->slipping : 0);
			overlap.push_back(geom->penetrationDepth);
			slip.push_back(ours ? ours->slip.dot(Vector3r(-geom->normal[1], geom->normal[0], 0)) : 0);
			append(point, geom->contactPoint);
			append(normal, geom->normal);
			append(normal_force, phys->normalForce);
			append(tangential_force, phys->shearForce);
		}
	}
	py::dict table;
	table["i"] = array_of(i), table["j"] = array_of(j), table["slipping"] = array_of(slipping),
	table["overlap"] = array_of(overlap), table["slip"] = array_of(slip);
	table["point"] = array_of(point, 3), table["normal"] = array_of(normal, 3);
	table["normal_force"] = array_of(normal_force, 3), table["tangential_force"] = array_of(tangential_force, 3);
	return table;
}

}  // namespace

void bind_bulk()
{
	np::initialize();
	py::def("body_table", bodies, (py::arg("scene")),
		"Spheres of a scene (O._sceneObj) as arrays: id, clump, radius [m], mass [kg], shape (n,); position [m], velocity "
		"[m/s],\n"
		"spin [rad/s], shape (n, 3). A clump appears through its members.");
	py::def("contact_table", contacts, (py::arg("scene")),
		"Interactions of a scene (O._sceneObj), those of the last step, as arrays: i, j, slipping, overlap [m], slip [m] of i "
		"along\n"
		"z x n (of our laws, else 0), shape (n,); point [m] (in i's periodic image), normal n from i to j, normal_force and "
		"tangential_force on j [N], shape (n, 3).");
}

}  // namespace graindrive
