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

/// An array of shape (phases, ny, nx, *shape) whose numbers `write(means, out)` takes from the fields at each point.
template <class Write>
np::ndarray array_of(const Averager& averager, const py::tuple& shape, int numbers, Write&& write)
{
	const int nx = averager.points(0), ny = averager.points(1);
	std::vector<Real> values(std::size_t(averager.phases) * ny * nx * numbers);
	Real* out = values.data();
	const bool known = averager.sums_fit();
	for (int phase = 0; phase < averager.phases; ++phase)
		for (int point = 0; point < nx * ny; ++point, out += numbers)
			write(known ? averager.means(phase, point) : means_at(nullptr, 0, averager.stress), out);
	return seam::array_of(values).reshape(py::tuple(py::make_tuple(averager.phases, ny, nx) + shape));
}

template <Real FieldMeans::*which>
np::ndarray numbers(const Averager& averager)
{
	return array_of(averager, py::tuple(), 1, [](const FieldMeans& m, Real* out) { *out = m.*which; });
}

np::ndarray velocity(const Averager& averager)
{
	return array_of(
		averager, py::make_tuple(2), 2, [](const FieldMeans& m, Real* out) { out[0] = m.velocity[0], out[1] = m.velocity[1]; });
}

void require_stress(const Averager& averager)
{
	if (!averager.stress)
		throw std::invalid_argument("FieldAverager averages stress and pressure with stress=True only, got stress=False");
}

template <bool contact, bool kinetic>
np::ndarray stress(const Averager& averager)
{
	require_stress(averager);
	return array_of(averager, py::make_tuple(2, 2), 4, [](const FieldMeans& m, Real* out) {
		for (int k = 0; k < 4; ++k)
			out[k] = (contact ? m.contact_stress(k / 2, k % 2) : 0) + (kinetic ? m.kinetic_stress(k / 2, k % 2) : 0);
	});
}

np::ndarray pressure(const Averager& averager)
{
	require_stress(averager);
	return array_of(averager, py::tuple(), 1,
		[](const FieldMeans& m, Real* out) { *out = (m.contact_stress.trace() + m.kinetic_stress.trace()) / 2; });
}

np::ndarray samples(const Averager& averager) { return seam::array_of(averager.samples()); }

template <int axis>
np::ndarray coordinates(const Averager& averager)
{
	std::vector<Real> values(averager.points(axis));
	for (std::size_t k = 0; k < values.size(); ++k) values[k] = averager.low[axis] + (Real(k) + 0.5) * averager.spacing;
	return seam::array_of(values);
}

}  // namespace

void bind_fields()
{
	np::initialize();
	auto cls = seam::bind<Averager>(Averager::documentation);
	cls.def("clear", &Averager::clear, "Forget all samples (at the end of a transient).");
	cls.add_property("x", coordinates<0>, "middles of the bins from the window's origin [m], shape (nx,)");
	cls.add_property("y", coordinates<1>, "middles of the bins from the window's origin [m], shape (ny,)");
	cls.add_property("samples", samples, "samples so far, shape (phases,)");
	cls.add_property("areaFraction", numbers<&FieldMeans::area_fraction>, "mean area fraction [-], shape (phases, ny, nx)");
	cls.add_property("density", numbers<&FieldMeans::density>, "mean mass per area [kg/m^2], shape (phases, ny, nx)");
	cls.add_property("velocity", velocity, "mean velocity [m/s], shape (phases, ny, nx, 2); nan where no grain was");
	cls.add_property("temperature", numbers<&FieldMeans::temperature>,
		"granular temperature <|v - <v>|^2>/2 [m^2/s^2], shape (phases, ny, nx); nan where no grain was");
	cls.add_property("totalStress", stress<true, true>,
		"contact and kinetic stress [N/m], positive in compression, shape (phases, ny, nx, 2, 2)");
	cls.add_property("contactStress", stress<true, false>, "stress carried by contacts [N/m], shape (phases, ny, nx, 2, 2)");
	cls.add_property("kineticStress", stress<false, true>, "stress by fluctuations [N/m], shape (phases, ny, nx, 2, 2)");
	cls.add_property("pressure", pressure, "half the trace of the stress [N/m], shape (phases, ny, nx)");
}

}  // namespace graindrive
