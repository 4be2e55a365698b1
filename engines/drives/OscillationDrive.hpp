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
		visit("phase", &OscillationDrive::phase, "phi at the start [rad]");
		visit("direction", &OscillationDrive::direction, "axis of the motion: along x, y or z");
		visit("form", &OscillationDrive::form, "'displacement' or 'velocity': which of the two is A sin(2 pi t/T + phi)");
		visit("origin", &OscillationDrive::origin, "coordinate at the start [m]; taken from the body at the first step");
		common_attributes(visit);
	}
	void check() const;
	void action() override;

	Real amplitude = 0, period = 1, phase = 0, origin = 0;
	Vector3r direction = Vector3r::UnitX();
	std::string form = "displacement";

private:
	int axis() const;
	Oscillation motion() const;
};

}  // namespace graindrive
