/// Python's view of the packing room: uniform_radii, random_insertion, overlaps.
#include <boost/python.hpp>
#include <boost/python/numpy.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "engines/packing/random_insertion.hpp"

namespace graindrive {

namespace {

namespace py = boost::python;
namespace np = boost::python::numpy;
using namespace graindrive::packing;

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

np::ndarray array_of(const Points& points)
{
	const np::ndarray array = np::empty(py::make_tuple(points.size(), 2), np::dtype::get_builtin<Real>());
	Real* entry = reinterpret_cast<Real*>(array.get_data());
	for (const Vector2r& p : points) entry = std::copy(p.data(), p.data() + 2, entry);
	return array;
}

std::vector<Real> radii_of(const py::object& radii)
{
	const Table table(radii, 1, "radii");
	return { table.entries, table.entries + table.rows };
}

Points centres_of(const py::object& centres)
{
	const Table table(centres, 2, "centres");
	Points points;
	for (Py_intptr_t i = 0; i < table.rows; ++i) points.emplace_back(table.entries[2 * i], table.entries[2 * i + 1]);
	return points;
}

Obstacles obstacles_of(const py::object& rows)
{
	const Table table(rows, 3, "obstacles (x, y, radius)");
	Obstacles obstacles;
	for (Py_intptr_t i = 0; i < table.rows; ++i) {
		obstacles.centres.emplace_back(table.entries[3 * i], table.entries[3 * i + 1]);
		obstacles.radii.push_back(table.entries[3 * i + 2]);
	}
	return obstacles;
}

Box box_of(const py::object& sides, bool periodic_x)
{
	const Table table(sides, 1, "box (x_min, x_max, y_min, y_max)");
	if (table.rows != 4)
		throw std::invalid_argument("box must be (x_min, x_max, y_min, y_max), got " + std::to_string(table.rows) + " numbers");
	return { table.entries[0], table.entries[1], table.entries[2], table.entries[3], periodic_x };
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
	return array_of(
		random_insertion(box_of(box, periodic_x), radii_of(radii), obstacles_of(obstacles), whole(seed, "seed"), attempts));
}

py::tuple deepest(const py::object& box, bool periodic_x, const py::object& centres, const py::object& radii)
{
	const Overlap overlap = overlaps(box_of(box, periodic_x), centres_of(centres), radii_of(radii));
	return overlap.found ? py::make_tuple(overlap.relative, overlap.first, overlap.second)
	                     : py::make_tuple(0.0, py::object(), py::object());
}

}  // namespace

void bind_packing()
{
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
}

}  // namespace graindrive
