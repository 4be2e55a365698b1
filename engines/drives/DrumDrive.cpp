/// A set of bodies turns rigidly about an axis.
#include "engines/drives/DrumDrive.hpp"

namespace graindrive {

const char* const DrumDrive::documentation =
	"Turns a set of bodies rigidly about an axis through `axisPoint` (the drum of Oba, Otsuki 2025).\n\n"
	"X_i(t) = axisPoint + R(Omega t) (X_i(0) - axisPoint), spin Omega. Each body gets the velocity of the chord that takes it\n"
	"there, so that radii and angles keep the closed form to round-off. Place it after the contacts and before the integrator.\n"
	"Raises ValueError for non-finite values.";

void DrumDrive::check() const
{
	require(axisPoint.allFinite(), "DrumDrive.axisPoint must be finite", axisPoint.transpose());
	require(angularVelocity.allFinite(), "DrumDrive.angularVelocity must be finite", angularVelocity.transpose());
	require(origins.empty() || origins.size() == bodies.size(),
		"DrumDrive.bodies cannot change once the drum turns; make a new DrumDrive", bodies.size());
}

void DrumDrive::take_origins()
{
	origins.clear();
	for (const int id : bodies) origins.push_back(state_of(id).pos - axisPoint);
}

/// Sends one body along its chord; answers the grains' force on it, with the torque about the axis point.
Wrench DrumDrive::move(std::size_t index, const Eigen::Matrix<Real, 3, 3>& turn)
{
	yade::State& state = state_of(bodies[index]);
	Wrench grains = wrench_on(bodies[index]);
	const Vector3r velocity = (axisPoint + turn * origins[index] - state.pos) / scene->dt;
	impose(state, yade::State::DOF_ALL, velocity, angularVelocity, grains);
	grains.torque += (state.pos - axisPoint).cross(grains.force);
	return grains;
}

void DrumDrive::action()
{
	if (begins()) take_origins();
	const Eigen::Matrix<Real, 3, 3> turn = rotation(angularVelocity, end_of_step()).toRotationMatrix();
	Wrench sum;
	for (std::size_t i = 0; i < bodies.size(); ++i) {
		const Wrench one = move(i, turn);
		sum.force += one.force;
		sum.torque += one.torque;
	}
	force = sum.force, torque = sum.torque;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::DrumDrive, "DrumDrive")
