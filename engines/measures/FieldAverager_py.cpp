/// Python binding of FieldAverager: fields as NumPy arrays.
#include <boost/python/numpy.hpp>

#include "engines/measures/FieldAverager.hpp"
#include "engines/seam/bind.hpp"
#include "engines/seam/numpy_array.hpp"

namespace graindrive {
namespace {

namespace py = boost::python;
namespace np = boost::python::numpy;
using Averager = FieldAverager;

/// (phases, nz, ny, nx) without the axes along which the grid has no points, and `rank` times the dimension behind them.
py::tuple shape_of(const Averager& averager, int rank)
{
	py::list shape;
	shape.append(averager.phases);
	for (int axis = 2; axis >= 0; --axis)
		if (averager.has_points_along(axis)) shape.append(averager.points(axis));
	for (int k = 0; k < rank; ++k) shape.append(averager.dimensions);
	return py::tuple(shape);
}

/// An array of numbers (rank 0), vectors (1) or tensors (2) that `write(means, out)` takes from the fields at each point.
template <class Write>
np::ndarray array_of(const Averager& averager, int rank, Write&& write)
{
	const std::vector<Real> values = averager.in_dimension([&](auto d) {
		constexpr int D = d();
		const std::size_t points = averager.all_points(), numbers = rank == 0 ? 1 : rank == 1 ? D : D * D;
		std::vector<Real> all(averager.phases * points * numbers);
		Real* out = all.data();
		const bool known = averager.sums_fit();
		for (int phase = 0; phase < averager.phases; ++phase)
			for (std::size_t point = 0; point < points; ++point, out += numbers)
				write(known ? averager.means<D>(phase, int(point)) : means_at<D>(nullptr, 0, averager.stress), out);
		return all;
	});
	return seam::array_of(values).reshape(shape_of(averager, rank));
}

/// A name that belongs to the other dimension.
void require_dimensions(const Averager& averager, int dimensions, const char* complaint)
{
	if (averager.dimensions != dimensions)
		throw std::invalid_argument(std::string(complaint) + ", got dimensions=" + std::to_string(averager.dimensions));
}

np::ndarray fraction(const Averager& averager)
{
	return array_of(averager, 0, [](const auto& m, Real* out) { *out = m.fraction; });
}

np::ndarray area_fraction(const Averager& averager)
{
	require_dimensions(averager, 2, "FieldAverager.areaFraction needs dimensions=2; in three dimensions read solidFraction");
	return fraction(averager);
}

np::ndarray solid_fraction(const Averager& averager)
{
	require_dimensions(averager, 3, "FieldAverager.solidFraction needs dimensions=3; in two dimensions read areaFraction");
	return fraction(averager);
}

np::ndarray density(const Averager& averager)
{
	return array_of(averager, 0, [](const auto& m, Real* out) { *out = m.density; });
}

np::ndarray temperature(const Averager& averager)
{
	return array_of(averager, 0, [](const auto& m, Real* out) { *out = m.temperature; });
}

np::ndarray velocity(const Averager& averager)
{
	return array_of(averager, 1, [](const auto& m, Real* out) { std::copy_n(m.velocity.data(), m.velocity.size(), out); });
}

void require_stress(const Averager& averager)
{
	if (!averager.stress)
		throw std::invalid_argument("FieldAverager averages stress and pressure only with stress=True, got stress=False");
}

template <bool contact, bool kinetic>
np::ndarray stress(const Averager& averager)
{
	require_stress(averager);
	return array_of(averager, 2, [](const auto& m, Real* out) {
		for (int a = 0; a < m.velocity.size(); ++a)
			for (int b = 0; b < m.velocity.size(); ++b)
				*out++ = (contact ? m.contact_stress(a, b) : 0) + (kinetic ? m.kinetic_stress(a, b) : 0);
	});
}

np::ndarray pressure(const Averager& averager)
{
	require_stress(averager);
	return array_of(averager, 0,
		[](const auto& m, Real* out) { *out = (m.contact_stress.trace() + m.kinetic_stress.trace()) / Real(m.velocity.size()); });
}

np::ndarray samples(const Averager& averager) { return seam::array_of(averager.samples()); }

/// The axes that the grid has points along, in their order.
std::string axes(const Averager& averager)
{
	std::string names;
	for (int axis = 0; axis < 3; ++axis)
		if (averager.has_points_along(axis)) names += char('x' + axis);
	return names;
}

template <int axis>
np::ndarray coordinates(const Averager& averager)
{
	if (!averager.has_points_along(axis))
		throw std::invalid_argument(
			std::string("FieldAverager has no points along ") + char('x' + axis) + "; its axes are " + axes(averager));
	std::vector<Real> values(averager.points(axis));
	for (std::size_t k = 0; k < values.size(); ++k) values[k] = averager.low[axis] + (Real(k) + 0.5) * averager.spacing;
	return seam::array_of(values);
}

}  // namespace

void bind_fields()
{
	np::initialize();
	auto cls = seam::bind<Averager>(Averager::documentation);
	cls.def("clear", &Averager::clear, "Delete all samples (at the end of a transient).");
	cls.add_property("axes", axes, "axes of the grid: 'xy' in two dimensions, 'xyz' in three, without the axis averageAlong");
	cls.add_property("x", coordinates<0>, "middles of the bins, relative to the window's origin [m], shape (nx,)");
	cls.add_property("y", coordinates<1>, "middles of the bins, relative to the window's origin [m], shape (ny,)");
	cls.add_property("z", coordinates<2>, "middles of the bins, relative to the window's origin [m], shape (nz,)");
	cls.add_property("samples", samples, "samples so far, shape (phases,)");
	cls.add_property(
		"areaFraction", area_fraction, "mean area fraction of disks [-], shape (phases, ny, nx); in two dimensions only");
	cls.add_property("solidFraction", solid_fraction,
		"mean volume of spheres over volume [-], shape (phases, nz, ny, nx) without the axis averaged over; in three dimensions "
		"only");
	cls.add_property(
		"density", density, "mean mass per area [kg/m^2], in three dimensions per volume [kg/m^3]; shape as fractions");
	cls.add_property("velocity", velocity, "mean velocity [m/s], shape (phases, ny, nx, 2); nan where no grain was");
	cls.add_property("temperature", temperature,
		"granular temperature <|v - <v>|^2>/dimensions [m^2/s^2], shape (phases, ny, nx); nan where no grain was");
	cls.add_property("totalStress", stress<true, true>,
		"contact and kinetic stress [N/m], in three dimensions [N/m^2], positive in compression, shape (phases, ny, nx, 2, 2)");
	cls.add_property("contactStress", stress<true, false>,
		"stress carried by contacts [N/m], in three dimensions [N/m^2], shape (phases, ny, nx, 2, 2)");
	cls.add_property("kineticStress", stress<false, true>,
		"stress by fluctuations [N/m], in three dimensions [N/m^2], shape (phases, ny, nx, 2, 2)");
	cls.add_property(
		"pressure", pressure, "trace of the stress over dimensions [N/m], in three dimensions [N/m^2], shape (phases, ny, nx)");
}

}  // namespace graindrive
