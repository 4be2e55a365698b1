/// Python bindings of Solid and its functors.
#include "engines/seam/bind.hpp"
#include "engines/solids/Bo1_Solid_Aabb.hpp"
#include "engines/solids/Ig2_Solid_Sphere_ScGeom.hpp"
#include "engines/solids/solid_checks.hpp"

namespace graindrive {

void bind_surfaces();

namespace {

namespace py = boost::python;
using solids::Described;

boost::shared_ptr<Solid> solid_of(const Described& given)
{
	auto solid = boost::make_shared<Solid>();
	solid->take(given);
	return solid;
}

py::object surface(const Solid& solid)
{
	if (!solid.surface()) return {};
	return py::object(boost::make_shared<Described>(solid.described()));
}

void set_surface(Solid& solid, const Described& given) { solid.take(given); }

}  // namespace

void bind_solids()
{
	bind_surfaces();
	register_solid();
	seam::bind<Solid, yade::Shape>(Solid::documentation)
		.def("__init__", py::make_constructor(&solid_of, py::default_call_policies(), (py::arg("surface"))))
		.add_property("surface", &surface, &set_surface, "the Surface of the recipe; None without one");
	seam::bind<Bo1_Solid_Aabb, yade::BoundFunctor>(Bo1_Solid_Aabb::documentation);
	seam::bind<Ig2_Solid_Sphere_ScGeom, yade::IGeomFunctor>(Ig2_Solid_Sphere_ScGeom::documentation);
	py::def("check_solids", check_solids, (py::arg("scene")),
		"Raises ValueError for a Solid in a scene (O._sceneObj) that YADE's own loop cannot handle; O.run and O.step call it.");
	py::def("solids_outgrow_cell", solids_outgrow_cell, (py::arg("scene")),
		"True if a Solid is endless along an axis of a scene's periodic cell.");
	py::def("take_complaint", take_complaint, "Error message of a functor of solids since the last call, or ''.");
}

}  // namespace graindrive
