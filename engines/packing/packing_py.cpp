/// Python's view of the packing room: uniform_radii, and random_insertion and overlaps in the plane and in space.
#include <boost/python.hpp>
#include <boost/python/numpy.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "engines/packing/random_insertion.hpp"

namespace graindrive {

namespace py = boost::python;
namespace np = boost::python::numpy;

namespace packing {

namespace {

/// A read-only view of array-like doubles of shape (n, columns), or (n,) if columns is 1.
struct Table {
	Table(const py::object& array_like, int columns, const char* name)
		: array(np::from_object(array_like, np::dtype::get_builtin<Real>(), np::ndarray::CARRAY_RO))
	{
		const bool empty = array.get_nd() > 0 && array.shape(0) == 0;
		const bool shaped = columns == 1 ? array.get_nd() == 1 : array.get_nd() == 2 && array.shape(1) == columns;
		if (!empty && !shaped)
			throw std::invalid_argument(std::string(name) + " must be an array of shape (n" +
										(columns == 1 ? ",)" : ", " + std::to_string(columns) + ")"));
		rows = empty ? 0 : array.shape(0);
		entries = reinterpret_cast<const Real*>(array.get_data());
	}

	np::ndarray array;
	Py_intptr_t rows;
	const Real* entries;
};

np::ndarray array_of(const std::vector<Real>& values)
{
	const np::ndarray array = np::empty(py::make_tuple(values.size()), np::dtype::get_builtin<Real>());
	std::copy(values.begin(), values.end(), reinterpret_cast<Real*>(array.get_data()));
	return array;
}

template <int D>
np::ndarray array_of(const Points<D>& points)
{
	const np::ndarray array = np::empty(py::make_tuple(points.size(), D), np::dtype::get_builtin<Real>());
	Real* entry = reinterpret_cast<Real*>(array.get_data());
	for (const Point<D>& p : points) entry = std::copy(p.data(), p.data() + D, entry);
	return array;
}

std::vector<Real> radii_of(const py::object& radii)
{
	const Table table(radii, 1, "radii");
	return { table.entries, table.entries + table.rows };
}

template <int D>
Points<D> centres_of(const py::object& centres)
{
	const Table table(centres, D, "centres");
	Points<D> points;
	for (Py_intptr_t i = 0; i < table.rows; ++i) points.emplace_back(Eigen::Map<const Point<D>>(table.entries + D * i));
	return points;
}

template <int D>
Obstacles<D> obstacles_of(const py::object& rows)
{
	const Table table(rows, D + 1, D == 2 ? "obstacles (x, y, radius)" : "obstacles (x, y, z, radius)");
	Obstacles<D> obstacles;
	for (Py_intptr_t i = 0; i < table.rows; ++i) {
		const Real* row = table.entries + (D + 1) * i;
		obstacles.centres.emplace_back(Eigen::Map<const Point<D>>(row));
		obstacles.radii.push_back(row[D]);
	}
	return obstacles;
}

template <int D>
Box<D> box_of(const py::object& sides, const std::array<bool, D>& periodic)
{
	const std::string form = D == 2 ? "(x_min, x_max, y_min, y_max)" : "(x_min, x_max, y_min, y_max, z_min, z_max)";
	const Table table(sides, 1, ("box " + form).c_str());
	if (table.rows != 2 * D)
		throw std::invalid_argument("box must be " + form + ", got " + std::to_string(table.rows) + " numbers");
	Box<D> box;
	for (int k = 0; k < D; ++k) box.low[k] = table.entries[2 * k], box.high[k] = table.entries[2 * k + 1];
	box.periodic = periodic;
	return box;
}

/// Axes as a word, "xy": those along which a box in space repeats.
std::array<bool, 3> axes_of(const std::string& word)
{
	std::array<bool, 3> named{};
	for (const char letter : word) {
		const std::size_t axis = std::string("xyz").find(letter);
		if (axis == std::string::npos || named[axis])
			throw std::invalid_argument(
				"periodic must name axes of x, y, z, each once, as 'xy', or '' for none, got '" + word + "'");
		named[axis] = true;
	}
	return named;
}

/// A Python function of points, shape (n, 3), asked for one point at a time.
KeepOut<3> keep_out_of(const py::object& function)
{
	if (function.is_none()) return {};
	return [function](const Point<3>& point) {
		const Table distances(function(array_of<3>(Points<3>{ point })), 1, "keep_out's distances");
		if (distances.rows != 1)
			throw std::invalid_argument(
				"keep_out must give a distance per point, shape (n,), got " + std::to_string(distances.rows) + " for one point");
		return distances.entries[0];
	};
}

/// Python's or NumPy's whole number; TypeError for anything else.
std::uint64_t whole(const py::object& value, const char* name)
{
	const py::handle<> index(PyNumber_Index(value.ptr()));
	const std::uint64_t number = PyLong_AsUnsignedLongLong(index.get());
	if (!PyErr_Occurred()) return number;
	PyErr_Clear();
	throw std::invalid_argument(
		std::string(name) + " must be a whole number from 0 to 2^64 - 1, got " + py::extract<std::string>(py::str(value))());
}

np::ndarray radii_in(const py::object& n, Real d_min, Real d_max, const py::object& seed)
{
	return array_of(uniform_radii(whole(n, "n"), d_min, d_max, whole(seed, "seed")));
}

np::ndarray insertion(const py::object& box, bool periodic_x, const py::object& radii, const py::object& obstacles,
	const py::object& seed, long attempts)
{
	return array_of<2>(random_insertion<2>(
		box_of<2>(box, { periodic_x, false }), radii_of(radii), obstacles_of<2>(obstacles), whole(seed, "seed"), attempts));
}

np::ndarray insertion_in_space(const py::object& box, const std::string& periodic, const py::object& radii,
	const py::object& seed, const py::object& keep_out, const py::object& obstacles, long attempts)
{
	return array_of<3>(random_insertion<3>(box_of<3>(box, axes_of(periodic)), radii_of(radii), obstacles_of<3>(obstacles),
		whole(seed, "seed"), attempts, keep_out_of(keep_out)));
}

py::tuple as_tuple(const Overlap& overlap)
{
	return overlap.found ? py::make_tuple(overlap.relative, overlap.first, overlap.second)
	                     : py::make_tuple(0.0, py::object(), py::object());
}

py::tuple deepest(const py::object& box, bool periodic_x, const py::object& centres, const py::object& radii)
{
	return as_tuple(overlaps<2>(box_of<2>(box, { periodic_x, false }), centres_of<2>(centres), radii_of(radii)));
}

py::tuple deepest_in_space(const py::object& box, const std::string& periodic, const py::object& centres, const py::object& radii)
{
	return as_tuple(overlaps<3>(box_of<3>(box, axes_of(periodic)), centres_of<3>(centres), radii_of(radii)));
}

}  // namespace

}  // namespace packing

void bind_packing()
{
	using namespace packing;
	np::initialize();
	py::def("uniform_radii", &radii_in, (py::arg("n"), py::arg("d_min"), py::arg("d_max"), py::arg("seed")),
		"Radii [length], shape (n,), of n disks with diameters uniform in [d_min, d_max); the same for a seed on every "
		"machine.\n\n"
		"Raises ValueError unless 0 < d_min <= d_max.");
	py::def("random_insertion", &insertion,
		(py::arg("box"), py::arg("periodic_x"), py::arg("radii"), py::arg("obstacles"), py::arg("seed"),
			py::arg("attempts") = 100'000L),
		"Centres [length], shape (n, 2), of disks placed at random without overlaps, whole inside the box, in the order of "
		"radii.\n\n"
		"box (x_min, x_max, y_min, y_max); periodic_x joins its left and right sides; obstacles: rows x, y, radius to keep clear "
		"of,\n"
		"() for none. Random sequential addition, largest first; equal disks jam at area fraction 0.547 (Feder 1980), 0.5 is\n"
		"practical. The same for a seed on every machine. Raises ValueError for bad input, and with what was reached if a disk\n"
		"finds no place in `attempts` trials.");
	py::def("overlaps", &deepest, (py::arg("box"), py::arg("periodic_x"), py::arg("centres"), py::arg("radii")),
		"Deepest overlap of a packing: (relative, i, j) with relative = (R_i + R_j - r_ij) / min(R_i, R_j) [-]; (0.0, None, "
		"None) if none.");
	py::def("random_insertion_in_space", &insertion_in_space,
		(py::arg("box"), py::arg("periodic"), py::arg("radii"), py::arg("seed"), py::arg("keep_out") = py::object(),
			py::arg("obstacles") = py::tuple(), py::arg("attempts") = 100'000L),
		"Centres [length], shape (n, 3), of spheres placed at random without overlaps, whole inside the box, in the order of "
		"radii.\n\n"
		"box (x_min, x_max, y_min, y_max, z_min, z_max); periodic names the axes along which it repeats, as 'xy', or ''.\n"
		"keep_out(points (m, 3)) gives signed distances (m,) to a solid, > 0 outside of it, to its nearest image where the box\n"
		"repeats: a sphere of radius R is put where the distance is at least R; None for nothing. It is asked for one point at "
		"a time,\n"
		"where no other sphere is in the way. obstacles: rows x, y, z, radius to keep clear of. Random sequential addition, "
		"largest\n"
		"first; equal spheres jam at volume fraction 0.384 (Zhang, Torquato 2013), 0.35 is practical. The same for a seed on "
		"every\n"
		"machine. Raises ValueError for bad input, and with what was reached if a sphere finds no place in `attempts` trials; "
		"what\n"
		"keep_out raises.");
	py::def("overlaps_in_space", &deepest_in_space, (py::arg("box"), py::arg("periodic"), py::arg("centres"), py::arg("radii")),
		"Deepest overlap of spheres, as `overlaps` of disks; box and periodic as of random_insertion_in_space.");
}

}  // namespace graindrive
