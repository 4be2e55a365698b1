/// A body or clump moves with constant velocity and spin.
#include "engines/drives/SpinTranslateDrive.hpp"

namespace graindrive {

const char* const SpinTranslateDrive::documentation =
	"Moves a body or clump with constant velocity and spin (the Magnus study's intruder: Kumar, Dhiman, Reddy 2019).\n\n"
	"X(t) = X0 + V t and, if all rotations are driven, orientation = rotation(omega t) * orientation(0). `dofs` names the\n"
	"driven degrees of freedom ('xyzXYZ'); the others stay free. If a setting is assigned during a run, and after a pause\n"
	"(dead=True), the motion continues from the present position; X0 and t then begin at that step. Place it after the\n"
	"contacts and before the integrator. Raises ValueError for non-finite values and unknown letters.";

void SpinTranslateDrive::check() const
{
	require(velocity.allFinite(), "SpinTranslateDrive.velocity must be finite", velocity.transpose());
	require(spin.allFinite(), "SpinTranslateDrive.spin must be finite", spin.transpose());
	require(origin.allFinite(), "SpinTranslateDrive.origin must be finite", origin.transpose());
	driven_dofs();
}

unsigned SpinTranslateDrive::driven_dofs() const
{
	static const std::string letters = "xyzXYZ";
	unsigned bits = 0;
	for (const char letter : dofs) {
		const auto bit = letters.find(letter);
		require(bit != std::string::npos, "SpinTranslateDrive.dofs takes letters of 'xyzXYZ'", dofs);
		bits |= 1u << bit;
	}
	return bits;
}

std::vector<Real> SpinTranslateDrive::settings() const
{
	return { Real(body), Real(driven_dofs()), velocity[0], velocity[1], velocity[2], spin[0], spin[1], spin[2] };
}

namespace {

constexpr unsigned all_rotations = yade::State::DOF_RX | yade::State::DOF_RY | yade::State::DOF_RZ;
constexpr Real turned_by_others = 1e-4;  // [rad]; a loop that sums angles rounds off by 1e-6 in ten million steps

bool rotates_all(unsigned dofs) { return (dofs & all_rotations) == all_rotations; }

}  // namespace

/// True if something else has moved the body in a direction that is driven.
bool SpinTranslateDrive::is_elsewhere(const yade::State& state) const
{
	const unsigned driven = driven_dofs();
	const Vector3r expected = place(leg_now());
	for (int i = 0; i < 3; ++i) {
		const Real size = std::abs(origin[i]) + std::abs(velocity[i] * leg_end());
		if (driven & (yade::State::DOF_X << i) && displaced(state.pos[i], expected[i], size)) return true;
	}
	return rotates_all(driven) && state.ori.angularDistance(orientation(leg_now())) > turned_by_others;
}

void SpinTranslateDrive::begin_leg(const yade::State& state)
{
	origin = state.pos, originOrientation = state.ori;
	give_back(driven_dofs());
	BodyDrive::begin_leg(settings());
}

void SpinTranslateDrive::action()
{
	yade::State& state = driven_state();
	feel_grains();
	if (leg_ends(settings()) || is_elsewhere(state)) begin_leg(state);
	// The integrator turns by omega dt; starting each step from the closed form keeps round-off from adding up.
	if (rotates_all(driven_dofs())) state.ori = orientation(leg_now());
	impose(state, driven_dofs(), (place(leg_end()) - state.pos) / scene->dt, spin);
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::SpinTranslateDrive)
