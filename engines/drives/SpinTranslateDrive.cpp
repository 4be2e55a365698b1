/// A body or clump moves with constant velocity and spin.
#include "engines/drives/SpinTranslateDrive.hpp"

namespace graindrive {

const char* const SpinTranslateDrive::documentation =
	"Moves a body or clump with constant velocity and spin (the Magnus study's intruder: Kumar, Dhiman, Reddy 2019).\n\n"
	"X(t) = X0 + V t and, if all rotations are driven, orientation = rotation(omega t) * orientation(0). `dofs` names what is\n"
	"driven ('xyzXYZ'); the rest stays free. Place it after the contacts and before the integrator. Raises ValueError for\n"
	"non-finite values and unknown letters.";

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

void SpinTranslateDrive::action()
{
	yade::State& state = driven_state();
	if (begins()) origin = state.pos, originOrientation = state.ori;
	const unsigned driven = driven_dofs();
	constexpr unsigned all_rotations = yade::State::DOF_RX | yade::State::DOF_RY | yade::State::DOF_RZ;
	// The integrator turns by omega dt; starting each step from the closed form keeps round-off from adding up.
	if ((driven & all_rotations) == all_rotations) state.ori = rotation(spin, elapsed) * originOrientation;
	const Vector3r target = origin + velocity * end_of_step();
	impose(state, driven, (target - state.pos) / scene->dt, spin);
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::SpinTranslateDrive, "SpinTranslateDrive")
