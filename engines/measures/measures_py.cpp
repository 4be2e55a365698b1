/// Python bindings of the measures: statistics as NumPy arrays.
#include <boost/python/numpy.hpp>

#include "engines/measures/ContactForceBinner.hpp"
#include "engines/seam/bind.hpp"

namespace graindrive {
namespace {

namespace py = boost::python;
namespace np = boost::python::numpy;
using Binner = ContactForceBinner;

np::ndarray as_array(const std::vector<Real>& values, int rows, int columns)
{
	np::ndarray array = columns > 1 ? np::zeros(py::make_tuple(rows, columns), np::dtype::get_builtin<Real>())
	                                : np::zeros(py::make_tuple(rows), np::dtype::get_builtin<Real>());
	std::copy(values.begin(), values.end(), reinterpret_cast<Real*>(array.get_data()));
	return array;
}

template <int channel, bool variance>
np::ndarray of_bins(const Binner& binner)
{
	return as_array(binner.statistic(channel, variance), binner.bin_count(), 1);
}

/// (bins, 3): the channels force_x, force_y, force_z side by side.
template <bool variance>
np::ndarray force_vectors(const Binner& binner)
{
	std::vector<Real> rows(3 * binner.bin_count());
	for (int k = 0; k < 3; ++k) {
		const auto column = binner.statistic(Binner::force_x + k, variance);
		for (int m = 0; m < binner.bin_count(); ++m) rows[3 * m + k] = column[m];
	}
	return as_array(rows, binner.bin_count(), 3);
}

/// The channels force_x, force_y, force_z along `planeNormal`.
np::ndarray axial_force(const Binner& binner)
{
	const Vector3r axis = binner.planeNormal.normalized();
	std::vector<Real> along(binner.bin_count(), 0);
	for (int k = 0; k < 3; ++k) {
		const auto column = binner.statistic(Binner::force_x + k, false);
		for (int m = 0; m < binner.bin_count(); ++m) along[m] += axis[k] * column[m];
	}
	return as_array(along, binner.bin_count(), 1);
}

template <int first, bool variance>
Vector3r of_body(const Binner& binner)
{
	return { binner.total_statistic(first, variance), binner.total_statistic(first + 1, variance),
		binner.total_statistic(first + 2, variance) };
}

template <int which, bool variance>
Real number(const Binner& binner)
{
	return binner.total_statistic(which, variance);
}

template <int first>
Vector3r last_of_body(const Binner& binner)
{
	const auto& row = binner.last_sample();
	if (row.empty()) return Vector3r::Zero();
	const std::size_t at = std::size_t(Binner::channels) * binner.bin_count() + first;
	return { row[at], row[at + 1], row[at + 2] };
}

template <int which>
Real last_number(const Binner& binner)
{
	return binner.last_sample().empty() ? 0 : binner.last_sample()[std::size_t(Binner::channels) * binner.bin_count() + which];
}

np::ndarray angles(const Binner& binner) { return as_array(binner.angles(), binner.bin_count(), 1); }

}  // namespace

void bind_measures()
{
	np::initialize();
	auto cls = seam::bind<Binner>(Binner::documentation);
	cls.def("clear", &Binner::clear, "Delete all samples (at the end of a transient).");
	cls.add_property("angles", angles, "centres of the bins [rad], shape (bins,), in (-pi, pi)");
	cls.add_property("normalForce", of_bins<Binner::normal, false>,
		"mean normal force, positive inwards; in 3D its part across planeNormal [N], shape (bins,)");
	cls.add_property("normalForceVariance", of_bins<Binner::normal, true>, "its variance over samples [N^2], shape (bins,)");
	cls.add_property("tangentialForce", of_bins<Binner::tangential, false>,
		"mean tangential force, counter-clockwise; in 3D its part across planeNormal and the normal [N], shape (bins,)");
	cls.add_property(
		"tangentialForceVariance", of_bins<Binner::tangential, true>, "its variance over samples [N^2], shape (bins,)");
	cls.add_property("contacts", of_bins<Binner::contacts, false>, "mean number of contacts, shape (bins,)");
	cls.add_property("contactsVariance", of_bins<Binner::contacts, true>, "its variance over samples, shape (bins,)");
	cls.add_property("slippingContacts", of_bins<Binner::slipping, false>, "mean number of slipping contacts, shape (bins,)");
	cls.add_property("axialForce", axial_force, "mean force along planeNormal, normal and tangential [N], shape (bins,)");
	cls.add_property("forceVectors", force_vectors<false>, "mean force [N], shape (bins, 3)");
	cls.add_property("forceVectorsVariance", force_vectors<true>, "its variance over samples [N^2], shape (bins, 3)");
	cls.add_property("force", of_body<Binner::total_force, false>, "mean force on the body [N]");
	cls.add_property("normalForceOnBody", of_body<Binner::total_normal, false>, "mean sum of the normal forces on the body [N]");
	cls.add_property("forceVariance", of_body<Binner::total_force, true>, "its variance over samples [N^2]");
	cls.add_property("torque", of_body<Binner::total_torque, false>, "mean torque about the body's centre [N m]");
	cls.add_property("torqueVariance", of_body<Binner::total_torque, true>, "its variance over samples [N^2 m^2]");
	cls.add_property("contactNumber", number<Binner::total_contacts, false>, "mean number of contacts on the body");
	cls.add_property("contactNumberVariance", number<Binner::total_contacts, true>, "its variance over samples");
	cls.add_property("slippingNumber", number<Binner::total_slipping, false>, "mean number of slipping contacts on the body");
	cls.add_property("lastForce", last_of_body<Binner::total_force>, "force on the body at the last sample [N]");
	cls.add_property("lastTorque", last_of_body<Binner::total_torque>, "torque at the last sample [N m]");
	cls.add_property("lastContactNumber", last_number<Binner::total_contacts>, "contacts on the body at the last sample");
}

}  // namespace graindrive
