/// Forces on one body or clump by contact angle.
#include "engines/measures/ContactForceBinner.hpp"

#include "engines/base/running_statistics.hpp"

namespace graindrive {

const char* const ContactForceBinner::documentation =
	"Forces of the grains on one body or clump, by the angle of the contact point as seen from the body's centre.\n\n"
	"Per bin: normal force (positive when it pushes inwards) [N], tangential force (positive counter-clockwise) [N],\n"
	"contacts, slipping contacts, force vector [N]; for the whole body: force, torque, contacts. Each has mean and\n"
	"variance over the samples. kernel='bins': 24 bins of 15 degrees (Kumar, Dhiman, Reddy 2019). kernel='gaussian': 64\n"
	"points, 8 degrees (Guillard, Forterre, Pouliquen 2014, Eq. A4). The sum of the bins' forces equals the total force to\n"
	"round-off. The contacts of a clump are those of its members.\n\n"
	"In three dimensions planeNormal is the axis of the angle (for a cylinder, its axis), and counter-clockwise refers to\n"
	"it: for the angle from x up to z use planeNormal=(0, -1, 0). Levers and forces are projected on the plane normal to\n"
	"the axis. The angle is that of the contact point about the axis, at any position along the axis; of a normal force\n"
	"only the part in the plane counts, of a tangential force only the part in the plane and perpendicular to the normal.\n"
	"Force parts along the axis are in axialForce; forceVectors hold the whole force. Normal and tangential stress of a\n"
	"cylinder of radius R and length L (Guillard et al.) are normalForce and tangentialForce over 2 pi R L/bins. A contact\n"
	"on the axis itself has no angle and counts at angle 0.\n\n"
	"Place it after the contacts and before the integrator. Results mislead if contacts are few: a bin's mean is over all\n"
	"samples, including empty ones. Raises ValueError for a count, width or interval out of range.";

void ContactForceBinner::check() const
{
	require(kernel == "bins" || kernel == "gaussian", "ContactForceBinner.kernel must be 'bins' or 'gaussian'", kernel);
	require(reference == "fixed" || reference == "motion", "ContactForceBinner.reference must be 'fixed' or 'motion'", reference);
	require(count >= 0 && count <= 3600, "ContactForceBinner.count must lie in 0..3600", count);
	require(width > 0 && width <= pi / 2, "ContactForceBinner.width must lie in (0, pi/2] rad", width);
	require(kernel == "bins" || width >= 2 * pi / bin_count(),
		"ContactForceBinner.width must be at least the spacing of the points, or their weights do not sum to 1; use more points "
		"or a wider Gaussian",
		width);
	require(every >= 1, "ContactForceBinner.every must be at least 1", every);
	require(planeNormal.norm() > 0, "ContactForceBinner.planeNormal must not be zero", planeNormal.transpose());
	require(direction.cross(planeNormal).norm() > 1e-9 * direction.norm() * planeNormal.norm(),
		"ContactForceBinner.direction must not be zero or along planeNormal", direction.transpose());
}

void ContactForceBinner::callPostLoad()
{
	check();
	if (sample_.size() != row_size()) sample_.assign(row_size(), 0);
}

void ContactForceBinner::clear()
{
	samples = 0;
	meanData.assign(row_size(), 0);
	squaresData.assign(row_size(), 0);
	sample_.assign(row_size(), 0);
}

/// Direction of angle 0 in the plane, as a unit vector; a body at rest keeps the direction that it had.
Vector3r ContactForceBinner::zero_direction()
{
	const Vector3r axis = planeNormal.normalized();
	const auto in_plane = [&](const Vector3r& v) -> Vector3r { return v - v.dot(axis) * axis; };
	if (last_direction_.isZero(0)) last_direction_ = in_plane(direction).normalized();
	if (reference == "motion") {
		const Vector3r velocity = in_plane(body_of(*scene, body, class_name).state->vel);
		if (velocity.norm() > 0) last_direction_ = velocity.normalized();
	} else {
		last_direction_ = in_plane(direction).normalized();
	}
	return last_direction_;
}

namespace {

/// A contact's forces in the plane across an axis; those of disks already lie there and are not changed in any bit.
struct InPlane {
	Vector3r normal, tangential;

	InPlane(const BodyContact& contact, const Vector3r& axis)
		: normal(across(contact.normal_force, axis)),
		  tangential(across(contact.tangential_force, axis))
	{
		// If the normal is oblique to the axis, projections of tangential directions need not be perpendicular to that of the
		// normal.
		if (contact.normal_force.dot(axis) != 0 && !normal.isZero(0)) tangential = across(tangential, normal.normalized());
	}

private:
	static Vector3r across(const Vector3r& v, const Vector3r& direction) { return v - v.dot(direction) * direction; }
};

}  // namespace

void ContactForceBinner::add(const BodyContact& contact, const Vector3r& e1, const Vector3r& e2, const AngularKernel& around)
{
	const Real theta = std::atan2(contact.lever.dot(e2), contact.lever.dot(e1));
	const Vector3r force = contact.normal_force + contact.tangential_force;
	const InPlane in_plane(contact, planeNormal.normalized());
	const Vector3r outward = std::cos(theta) * e1 + std::sin(theta) * e2, along = std::cos(theta) * e2 - std::sin(theta) * e1;
	// The sign follows from the direction of the normal force, the magnitude from the law; the shape's normal is not used.
	const Real inward_force = in_plane.normal.dot(outward) <= 0 ? in_plane.normal.norm() : -in_plane.normal.norm();
	const Real along_force = in_plane.tangential.dot(along) >= 0 ? in_plane.tangential.norm() : -in_plane.tangential.norm();
	around.shares(theta, shares_);
	for (const auto& [bin, weight] : shares_) {
		sample_[slot(normal, bin)] += weight * inward_force;
		sample_[slot(tangential, bin)] += weight * along_force;
		sample_[slot(contacts, bin)] += weight;
		sample_[slot(slipping, bin)] += contact.slipping ? weight : 0;
		for (int k = 0; k < 3; ++k) sample_[slot(force_x + k, bin)] += weight * force[k];
	}
	const Vector3r torque = contact.lever.cross(force);
	for (int k = 0; k < 3; ++k) {
		sample_[total_slot(total_force + k)] += force[k];
		sample_[total_slot(total_torque + k)] += torque[k];
		sample_[total_slot(total_normal + k)] += contact.normal_force[k];
	}
	sample_[total_slot(total_contacts)] += 1;
	sample_[total_slot(total_slipping)] += contact.slipping;
}

void ContactForceBinner::take_sample()
{
	const Vector3r e1 = zero_direction(), e2 = planeNormal.normalized().cross(e1);
	const AngularKernel around(bin_count(), kernel == "gaussian" ? width : 0);
	found_.clear();
	source_.of(scene).contacts_on(body, found_);
	sample_.assign(row_size(), 0);
	for (const auto& contact : found_) add(contact, e1, e2, around);
}

void ContactForceBinner::action()
{
	if (scene->iter % every != 0) return;
	if (meanData.size() != row_size()) clear();
	take_sample();
	update_statistics(meanData, squaresData, sample_, ++samples);
}

std::vector<Real> ContactForceBinner::angles() const
{
	const AngularKernel around(bin_count(), 0);
	std::vector<Real> all(bin_count());
	for (int m = 0; m < bin_count(); ++m) all[m] = around.angle(m);
	return all;
}

std::vector<Real> ContactForceBinner::statistic(int channel, bool variance) const
{
	std::vector<Real> out(bin_count(), 0);
	for (int m = 0; m < bin_count(); ++m) {
		if (meanData.size() != row_size()) break;
		const std::size_t at = slot(channel, m);
		out[m] = !variance ? meanData[at] : samples > 1 ? squaresData[at] / Real(samples - 1) : 0;
	}
	return out;
}

Real ContactForceBinner::total_statistic(int which, bool variance) const
{
	if (meanData.size() != row_size()) return 0;
	return !variance ? meanData[total_slot(which)] : samples > 1 ? squaresData[total_slot(which)] / Real(samples - 1) : 0;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::ContactForceBinner)
