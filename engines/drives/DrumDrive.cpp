/// A set of bodies turns rigidly about an axis.
#include "engines/drives/DrumDrive.hpp"

namespace graindrive {

const char* const DrumDrive::documentation =
	"Turns a set of bodies rigidly about an axis through `axisPoint` (the drum of Oba, Otsuki 2025).\n\n"
	"X_i(t) = axisPoint + R(Omega t) (X_i(0) - axisPoint), spin Omega. Each body gets the velocity of the chord to its\n"
	"next position, so that radii and angles follow the closed form to round-off. If axisPoint or angularVelocity are\n"
	"assigned during a run, and after a pause (dead=True), the motion continues from the present positions. Place it after\n"
	"the contacts and before the integrator. Raises ValueError for non-finite values.";

namespace {

constexpr std::size_t numbers_before_ids = 6;  // in `settings`: axis point and angular velocity

std::string ids_of(const std::vector<int>& bodies)
{
	std::string ids;
	for (const int id : bodies) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
	return ids.empty() ? "none" : ids;
}

}  // namespace

void DrumDrive::check() const
{
	require(axisPoint.allFinite(), "DrumDrive.axisPoint must be finite", axisPoint.transpose());
	require(angularVelocity.allFinite(), "DrumDrive.angularVelocity must be finite", angularVelocity.transpose());
	const auto turning = leg.begin() + std::min(leg.size(), numbers_before_ids);
	require(leg.empty() || (origins.size() == bodies.size() && std::equal(turning, leg.end(), bodies.begin(), bodies.end())),
		"DrumDrive.bodies cannot change once the drum turns; make a new DrumDrive", ids_of(bodies));
}

std::vector<Real> DrumDrive::settings() const
{
	std::vector<Real> all(axisPoint.data(), axisPoint.data() + 3);
	all.insert(all.end(), angularVelocity.data(), angularVelocity.data() + 3);
	all.insert(all.end(), bodies.begin(), bodies.end());
	return all;
}

/// True if something else has moved one of the bodies.
bool DrumDrive::is_elsewhere() const
{
	const Turn now = turn(leg_now());
	for (std::size_t i = 0; i < bodies.size(); ++i) {
		const Vector3r offset = state_of(bodies[i]).pos - axisPoint - now * origins[i];
		if (displaced(offset.norm(), 0, axisPoint.norm() + origins[i].norm())) return true;
	}
	return false;
}

void DrumDrive::begin_leg()
{
	origins.clear();
	for (const int id : bodies) origins.push_back(state_of(id).pos - axisPoint);
	Drive::begin_leg(settings());
}

/// Moves one body along its chord; returns the grains' force on it, with the torque about the axis point.
Wrench DrumDrive::move(std::size_t index, const Turn& turn)
{
	yade::State& state = state_of(bodies[index]);
	Wrench grains = grains_[index];
	const Vector3r velocity = (axisPoint + turn * origins[index] - state.pos) / scene->dt;
	impose(state, yade::State::DOF_ALL, velocity, angularVelocity, grains);
	grains.torque += (state.pos - axisPoint).cross(grains.force);
	return grains;
}

void DrumDrive::action()
{
	grains_.clear();
	for (const int id : bodies) state_of(id), grains_.push_back(wrench_on(id));
	if (leg_ends(settings()) || is_elsewhere()) begin_leg();
	const Turn at_end = turn(leg_end());
	Wrench sum;
	for (std::size_t i = 0; i < bodies.size(); ++i) {
		const Wrench one = move(i, at_end);
		sum.force += one.force;
		sum.torque += one.torque;
	}
	force = sum.force, torque = sum.torque;
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::DrumDrive)
