/// A body or clump oscillates along one axis.
#include "engines/drives/OscillationDrive.hpp"

namespace graindrive {

const char* const OscillationDrive::documentation =
	"Oscillates a body or clump along x, y or z; its other degrees of freedom are not changed.\n\n"
	"form='displacement': x(t) = x0 + A [sin(2 pi t/T + phi) - sin phi]\n"
	"form='velocity':     v(t) = A sin(2 pi t/T + phi), x its integral\n\n"
	"Both are possible readings of Tripura et al., whose text gives the velocity but uses the displacement. t starts at\n"
	"the drive's first step. If amplitude, period, form, direction or body are assigned during a run, the motion continues\n"
	"from the present position with the present angle 2 pi t/T + phi, or with the `phase` that is assigned; x0, t and phi\n"
	"then begin at that step. After a pause (dead=True) it also continues from the present position. Place it after the\n"
	"contacts and before the integrator. Raises ValueError for a period <= 0, a negative or non-finite amplitude, an\n"
	"unknown form, or a direction that is not an axis.";

void OscillationDrive::check() const
{
	require(std::isfinite(amplitude) && amplitude >= 0, "OscillationDrive.amplitude must be finite and not negative", amplitude);
	require(std::isfinite(period) && period > 0, "OscillationDrive.period must be positive", period);
	require(std::isfinite(phase), "OscillationDrive.phase must be finite", phase);
	require(form == "displacement" || form == "velocity", "OscillationDrive.form must be 'displacement' or 'velocity'", form);
	require(std::isfinite(origin), "OscillationDrive.origin must be finite", origin);
	axis();
}

/// Only an axis can be blocked in YADE's State while the directions across it stay free.
int OscillationDrive::axis() const
{
	int index = -1, count = direction.allFinite() ? 0 : 3;
	for (int i = 0; i < 3; ++i)
		if (direction[i] != 0) index = i, ++count;
	require(count == 1, "OscillationDrive.direction must be along x, y or z (only an axis leaves the others free)",
		direction.transpose());
	return index;
}

namespace {

constexpr std::size_t period_setting = 1;  // its index in `settings`

}  // namespace

std::vector<Real> OscillationDrive::settings() const
{
	return { Real(body), period, amplitude, Real(axis()), direction[axis()] > 0 ? 1.0 : -1.0, form == "velocity" ? 1.0 : 0.0 };
}

Oscillation OscillationDrive::motion() const
{
	const bool by_displacement = form == "displacement";
	const Real sign = direction[axis()] > 0 ? 1 : -1;
	return { sign * amplitude, period, legPhase,
		by_displacement ? Oscillation::Form::displacement : Oscillation::Form::velocity };
}

/// The angle at the start of a leg, which continues from the leg before with that leg's period.
void OscillationDrive::begin_leg(Real place)
{
	legPhase = first_leg() || phaseAssigned ? phase : legPhase + 2 * pi * leg_now() / leg[period_setting];
	phaseAssigned = false;
	origin = place;
	give_back(yade::State::DOF_X << axis());
	BodyDrive::begin_leg(settings());
}

void OscillationDrive::action()
{
	yade::State& state = driven_state();
	feel_grains();
	const Real& place = state.pos[axis()];
	const bool ends = leg_ends(settings()) || phaseAssigned;
	if (ends || displaced(place, origin + motion().displacement(leg_now()), std::abs(origin) + motion().reach()))
		begin_leg(place);
	Vector3r velocity = Vector3r::Zero();
	velocity[axis()] = (origin + motion().displacement(leg_end()) - place) / scene->dt;
	impose(state, yade::State::DOF_X << axis(), velocity, Vector3r::Zero());
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::OscillationDrive)
