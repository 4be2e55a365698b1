/// Python's view of the shapes room: `Outline`, `Clump` and the functions that make them.
#include <boost/make_shared.hpp>
#include <boost/python.hpp>
#include <boost/python/numpy.hpp>

#include <stdexcept>

#include "engines/shapes/built_in.hpp"
#include "engines/shapes/clump.hpp"
#include "engines/shapes/read_outline.hpp"
#include "engines/shapes/solid.hpp"

namespace graindrive {

namespace py = boost::python;
namespace np = boost::python::numpy;

namespace shapes {

namespace {

np::ndarray array_of(const Points& points)
{
	const np::ndarray array = np::empty(py::make_tuple(points.size(), 2), np::dtype::get_builtin<Real>());
	Real* entry = reinterpret_cast<Real*>(array.get_data());
	for (const Vector2r& p : points) *entry++ = p.x(), *entry++ = p.y();
	return array;
}

Points points_of(const py::object& array_like)
{
	const np::ndarray given = np::from_object(array_like, np::dtype::get_builtin<Real>(), np::ndarray::CARRAY_RO);
	if (given.get_nd() != 2 || given.shape(1) != 2)
		throw std::invalid_argument("vertices must be an array of shape (n, 2), one x, y a row");
	const Real* entry = reinterpret_cast<const Real*>(given.get_data());
	Points points;
	for (Py_intptr_t i = 0; i < given.shape(0); ++i, entry += 2) points.emplace_back(entry[0], entry[1]);
	return points;
}

/// A number or a sequence of numbers, of Python's or NumPy's kinds.
std::vector<Real> sizes_of(const py::object& sizes)
{
	const np::ndarray given = np::from_object(sizes, np::dtype::get_builtin<Real>(), np::ndarray::CARRAY_RO);
	if (given.get_nd() > 1) throw std::invalid_argument("sizes must be a number or a sequence of numbers");
	const Real* first = reinterpret_cast<const Real*>(given.get_data());
	return { first, first + (given.get_nd() == 0 ? 1 : given.shape(0)) };
}

boost::shared_ptr<Outline> make_outline(const py::object& vertices) { return boost::make_shared<Outline>(points_of(vertices)); }
np::ndarray vertices(const Outline& outline) { return array_of(outline.vertices()); }
Real area(const Outline& outline) { return solid_of(outline).area; }
Real second_moment(const Outline& outline) { return solid_of(outline).second_moment; }

py::tuple centroid(const Outline& outline)
{
	const Vector2r at = solid_of(outline).centroid;
	return py::make_tuple(at.x(), at.y());
}

Outline named(const std::string& name, const py::object& sizes, Real orientation)
{
	return outline_of(name, sizes_of(sizes), orientation);
}
np::ndarray clump_beads(const Clump& clump) { return array_of(clump.beads); }

py::list names()
{
	py::list list;
	for (const std::string& name : shape_names()) list.append(name);
	return list;
}

void bind_outline()
{
	py::class_<Outline>("Outline",
		"Outer edge of an intruder: a checked simple polygon, or an exact circle (from outline_of('disk')).\n\n"
		"Outline(vertices): array-like of shape (n, 2) [length], in either sense. Clockwise order is reversed; repeated, closing "
		"and\n"
		"collinear vertices are dropped. Raises ValueError, naming the vertex, for vertices that are not finite or beyond 1e50, "
		"for\n"
		"a shape so far out that its coordinates do not resolve 1e-8 of its extent, for fewer than 3 different vertices or more\n"
		"than 5,000, for no area, and for edges that cross or touch.",
		py::no_init)
		.def("__init__", py::make_constructor(&make_outline, py::default_call_policies(), (py::arg("vertices"))))
		.add_property("vertices", &vertices, "corners, counter-clockwise, shape (n, 2) [length]; a disk is drawn with 360")
		.add_property("area", &area, "exact area [length^2]")
		.add_property("centroid", &centroid, "exact centroid, tuple (x, y) [length]")
		.add_property("second_moment", &second_moment, "I_z / m of the uniform solid about its centroid [length^2]")
		.add_property("fall_height", &fall_height,
			"l of the wiggle paper's cavity model (its Table 1): from the lowest point with a vertical tangent to the top "
			"[length]")
		.add_property("about_centroid", &Outline::about_centroid,
			"the outline with its solid's centroid at (0, 0), in full precision even if it lies far from the origin")
		.add_property("extent", &Outline::extent, "larger side of the box around the outline [length]")
		.add_property("disk_radius", &Outline::disk_radius, "radius of an exact circle [length]; 0 for a polygon")
		.def("turned", &Outline::turned, (py::arg("angle")), "The outline turned counter-clockwise about (0, 0) by angle [rad].");
}

void bind_clump()
{
	py::class_<Clump>(
		"Clump", "Beads along an outline with the mass and inertia of the solid inside; made by clump_of.", py::no_init)
		.add_property("beads", &clump_beads, "centres relative to the solid's centroid, counter-clockwise, shape (n, 2) [length]")
		.def_readonly("bead_radius", &Clump::bead_radius, "[length]")
		.def_readonly("mass", &Clump::mass, "[mass]")
		.def_readonly("inertia", &Clump::inertia, "moment of inertia about the centroid [mass length^2]");
	py::def("clump_of", &clump_of, (py::arg("outline"), py::arg("bead_diameter"), py::arg("mass"), py::arg("spacing") = 1.0),
		"Beads that touch the outline from inside, so that their envelope is the outline with corners rounded by the bead "
		"radius.\n\n"
		"bead_diameter [length], mass [mass] of the whole clump, spacing: largest distance of beads in bead diameters, in (0, "
		"1].\n"
		"Beads stand at every corner of the inset (arcs at reflex corners) and at equal steps between, within 1e-5 of their "
		"radius\n"
		"of touching; beads and inertia are as exact for an outline far from (0, 0) as for one about it.\n"
		"Raises ValueError for a value out of range, for a shape too thin for the beads, and for more than 1e5 beads.");
}

}  // namespace

}  // namespace shapes

void bind_shapes()
{
	using namespace shapes;
	np::initialize();
	bind_outline();
	bind_clump();
	py::def("outline_of", &named, (py::arg("name"), py::arg("sizes") = py::tuple(), py::arg("orientation") = 0.0),
		"Intruder of the wiggle paper by name, about its centroid, turned counter-clockwise by orientation [rad].\n\n"
		"disk (OS1) diameter 7; square (OS2) side 6.5; tall (OS3) width, height 4.5, 9.5; wide (OS4) 9.5, 4.5; triangle (OS5)\n"
		"side 9.5, equilateral, apex up. sizes: a number or a sequence, () for these [d]. Outer sizes, beads included.\n"
		"Raises ValueError for an unknown name, a wrong number of sizes or one that is not positive.");
	py::def("shape_names", &names, "Names that outline_of knows, without the aliases OS1 to OS5.");
	py::def("read_outline", &read_outline, (py::arg("path")),
		"Outline from a regular file of at most 4 MiB: one WKT POLYGON without holes, alone or quoted in a table, or a CSV of\n"
		"vertices (x, y a line, # comments, optional header that names x and y).\n\n"
		"Raises ValueError naming the file and the line or vertex.");
}

}  // namespace graindrive
