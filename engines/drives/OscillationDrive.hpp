/// A body or clump oscillates along one axis, x(t) = x_0 + u(t); every other degree of freedom stays as it was.
#pragma once
#include "engines/base/motion.hpp"
#include "engines/drives/Drive.hpp"

namespace graindrive {

class OscillationDrive : public BodyDrive<OscillationDrive> {
public:
	static constexpr const char* class_name = "OscillationDrive";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("amplitude", &OscillationDrive::amplitude, "A: of displacement [m], or of velocity [m/s] with form='velocity'");
		visit("period", &OscillationDrive::period, "T [s]");
		visit("phase", &OscillationDrive::phase, "phi at the start [rad]; if assigned during a run, the phase from then on");
		visit("direction", &OscillationDrive::direction, "axis of the motion: along x, y or z");
		visit("form", &OscillationDrive::form, "'displacement' or 'velocity': the quantity that is A sin(2 pi t/T + phi)");
		visit("origin", &OscillationDrive::origin, "coordinate at the start of the present leg [m]; taken from the body");
		visit("legPhase", &OscillationDrive::legPhase, "phase at the start of the present leg [rad]");
		visit("phaseAssigned", &OscillationDrive::phaseAssigned, "true if `phase` was assigned since the last step");
		common_attributes(visit);
	}
	void check() const;
	void action() override;
	void assigned(const std::string& name) { phaseAssigned = phaseAssigned || name == "phase"; }

	Real amplitude = 0, period = 1, phase = 0, origin = 0, legPhase = 0;
	bool phaseAssigned = false;
	Vector3r direction = Vector3r::UnitX();
	std::string form = "displacement";

private:
	int axis() const;
	std::vector<Real> settings() const;
	Oscillation motion() const;
	void begin_leg(Real place);
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::OscillationDrive, "OscillationDrive")
