/// Python bindings of the functors and of the data of a contact.
#include "engines/functors/Ip2_FrictMat_FrictMat_ContactPhys.hpp"
#include "engines/functors/contact_law_functors.hpp"
#include "engines/functors/present_contacts.hpp"
#include "engines/seam/bind.hpp"
#include "engines/seam/numpy_array.hpp"

namespace graindrive {

void bind_laws();

namespace {

namespace py = boost::python;

py::dict present_contacts_table(
	const yade::Scene& scene, const yade::LawFunctor& law, const Ip2_FrictMat_FrictMat_ContactPhys& contact_maker)
{
	std::vector<int> i, j, slipping;
	std::vector<Real> overlap, slip, slip_vector, normal, normal_force, tangential_force;
	const auto append = [](std::vector<Real>& rows, const Vector3r& v) { rows.insert(rows.end(), v.data(), v.data() + 3); };
	for (const PresentContact& c : present_contacts(scene, law, contact_maker)) {
		i.push_back(c.id1), j.push_back(c.id2), slipping.push_back(c.answer.slipping);
		overlap.push_back(c.overlap);
		slip.push_back(c.answer.slip.dot(Vector3r(-c.normal[1], c.normal[0], 0)));
		append(slip_vector, c.answer.slip);
		append(normal, c.normal);
		append(normal_force, c.answer.normal_force2);
		append(tangential_force, c.answer.tangential_force2);
	}
	py::dict table;
	table["i"] = seam::array_of(i), table["j"] = seam::array_of(j), table["slipping"] = seam::array_of(slipping);
	table["overlap"] = seam::array_of(overlap), table["slip"] = seam::array_of(slip), table["normal"] = seam::array_of(normal, 3);
	table["slip_vector"] = seam::array_of(slip_vector, 3);
	table["normal_force"] = seam::array_of(normal_force, 3);
	table["tangential_force"] = seam::array_of(tangential_force, 3);
	return table;
}

}  // namespace

void bind_functors()
{
	seam::bind<ContactPhys, yade::FrictPhys>(
		"A contact under one of Graindrive's laws: reduced radius and mass of the pair, its tangential spring.");
	seam::bind<Ip2_FrictMat_FrictMat_ContactPhys, yade::IPhysFunctor>(Ip2_FrictMat_FrictMat_ContactPhys::documentation);
	for_each_law_functor([](auto kind) {
		using Functor = std::remove_cv_t<std::remove_pointer_t<decltype(kind)>>;
		seam::bind<Functor, yade::LawFunctor>(Functor::documentation);
	});
	bind_laws();
	py::def("present_contacts", present_contacts_table, (py::arg("scene"), py::arg("law"), py::arg("contact_maker")),
		"Contacts of the disks, spheres and Solids of a scene (O._sceneObj) at the present positions, as YADE's next step will\n"
		"find them with one of our Law2_ functors and our Ip2_. Arrays as in `contact_table`, without point; slip [m] along\n"
		"z x n, which is complete for disks, and slip_vector [m], shape (n, 3), of i against j, for spheres. The scene is not\n"
		"changed. Pairs of frozen bodies and of members of one clump are left out. Raises TypeError for other laws.");
}

}  // namespace graindrive
