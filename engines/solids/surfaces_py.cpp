/// Surfaces as Python sees them: distances and normals of many points at once, and the recipes of sampled functions.
#include "engines/seam/bind.hpp"
#include "engines/seam/numpy_array.hpp"
#include "engines/solids/sampled_recipe.hpp"
#include "engines/solids/Solid.hpp"

namespace graindrive {

namespace {

namespace py = boost::python;
namespace np = boost::python::numpy;
using geometry::Vec;
using solids::Described;

np::ndarray numbers(const py::object& array_like)
{
	return np::from_object(array_like, np::dtype::get_builtin<Real>(), np::ndarray::CARRAY_RO);
}

std::vector<Vec<3>> points_of(const py::object& array_like)
{
	const np::ndarray given = numbers(array_like);
	if (given.get_nd() != 2 || given.shape(1) != 3) {
		const std::string shape = py::extract<std::string>(py::str(given.attr("shape")));
		throw std::invalid_argument(
			"points must be an array of shape (n, 3), one x, y, z a row, got shape " + shape + "; give [[x, y, z]] for one");
	}
	const Real* entry = reinterpret_cast<const Real*>(given.get_data());
	std::vector<Vec<3>> points;
	for (Py_intptr_t i = 0; i < given.shape(0); ++i, entry += 3) {
		points.push_back({ entry[0], entry[1], entry[2] });
		if (!geometry::is_finite(points.back()))
			throw std::invalid_argument(
				"points must be finite numbers, got one that is not in row " + std::to_string(i) + "; correct it");
	}
	return points;
}

boost::shared_ptr<Described> described(const std::string& recipe)
{
	return boost::make_shared<Described>(Described{ recipe, solids::surface_of(recipe) });
}

np::ndarray distance(const Described& d, const py::object& points)
{
	std::vector<Real> distances;
	for (const Vec<3>& at : points_of(points)) distances.push_back(d.surface->nearest(at).distance);
	return seam::array_of(distances);
}

np::ndarray row_array(const std::vector<Vec<3>>& rows)
{
	std::vector<Real> flat;
	for (const Vec<3>& row : rows) flat.insert(flat.end(), row.coordinate, row.coordinate + 3);
	return seam::array_of(flat, 3);
}

np::ndarray normal(const Described& d, const py::object& points)
{
	std::vector<Vec<3>> normals;
	for (const Vec<3>& at : points_of(points)) normals.push_back(d.surface->nearest(at).normal);
	return row_array(normals);
}

py::tuple bounds(const Described& d)
{
	const geometry::Bounds<3> box = d.surface->bounds();
	const np::ndarray both = row_array({ box.low, box.high });
	return py::make_tuple(both[0], both[1]);
}

std::string sampled_recipe(const py::object& count, const py::object& low, const py::object& spacing, const py::object& distances)
{
	geometry::SampleGrid<3> grid;
	for (int k = 0; k < 3; ++k) {
		grid.count[k] = py::extract<std::size_t>(count[k]);
		grid.low[k] = py::extract<Real>(low[k]);
		grid.spacing[k] = py::extract<Real>(spacing[k]);
	}
	const np::ndarray given = numbers(distances);
	const Real* first = reinterpret_cast<const Real*>(given.get_data());
	return solids::sampled_recipe(grid, { first, first + py::len(given) });
}

py::list kinds()
{
	py::list all;
	for (const std::string& name : solids::kinds()) all.append(name);
	return all;
}

struct SurfacePickle : py::pickle_suite {
	static py::tuple getinitargs(const Described& d) { return py::make_tuple(d.recipe); }
};

std::string representation(const Described& d)
{
	constexpr std::size_t most = 200;
	return "Surface('" + (d.recipe.size() > most ? d.recipe.substr(0, most) + "...'" : d.recipe + "'") + ")";
}

bool same(const Described& a, const Described& b) { return a.recipe == b.recipe; }

}  // namespace

void bind_surfaces()
{
	py::class_<Described, boost::shared_ptr<Described>>("Surface",
		"A solid body by the distance to its surface and the normal there, made from a recipe; graindrive.solids.surfaces makes "
		"them.\n\n"
		"Surface(recipe): as `recipe` of another one. Raises ValueError for a recipe that is none, naming the word and its "
		"place.",
		py::no_init)
		.def("__init__", py::make_constructor(&described, py::default_call_policies(), (py::arg("recipe"))))
		.def_readonly("recipe", &Described::recipe, "text from which Surface(recipe) makes the same surface, to the last bit")
		.def("distance", &distance, (py::arg("points")),
			"Distances [m] of points, shape (n, 3) [m], from the surface, > 0 outside the solid: shape (n,).\n\n"
			"Raises ValueError for another shape and for numbers that are not finite.")
		.def("normal", &normal, (py::arg("points")),
			"Outward unit normals at the points of the surface nearest to `points`, shape (n, 3): shape (n, 3).")
		.def("bounds", &bounds,
			"A box (low, high), each of shape (3,) [m], that contains the whole solid; its sides may be infinite.")
		.def("__repr__", &representation)
		.def("__eq__", &same)
		.def_pickle(SurfacePickle());
	py::def("sampled_recipe", &sampled_recipe, (py::arg("count"), py::arg("low"), py::arg("spacing"), py::arg("distances")),
		"The recipe of distances at the nodes of a grid, x fastest; see graindrive.solids.surfaces.sampled.");
	py::def("surface_kinds", &kinds, "The names with which a recipe may begin.");
}

}  // namespace graindrive
