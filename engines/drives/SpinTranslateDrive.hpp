/// A body or clump moves with constant velocity and spin, X(t) = X_0 + V t, orientation turned by omega t.
#pragma once
#include "engines/base/motion.hpp"
#include "engines/drives/Drive.hpp"

namespace graindrive {

class SpinTranslateDrive : public BodyDrive<SpinTranslateDrive> {
public:
	static constexpr const char* class_name = "SpinTranslateDrive";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("velocity", &SpinTranslateDrive::velocity, "V [m/s]");
		visit("spin", &SpinTranslateDrive::spin, "omega [rad/s]");
		visit("dofs", &SpinTranslateDrive::dofs,
			"driven degrees of freedom: letters of 'xyzXYZ' (capitals are rotations); the others stay free");
		visit("origin", &SpinTranslateDrive::origin, "position at the start of the present leg [m]; taken from the body");
		visit("originOrientation", &SpinTranslateDrive::originOrientation, "orientation at that start; taken from the body");
		common_attributes(visit);
	}
	void check() const;
	void action() override;

	Vector3r velocity = Vector3r::Zero(), spin = Vector3r::Zero(), origin = Vector3r::Zero();
	Quaternionr originOrientation = Quaternionr::Identity();
	std::string dofs = "xyzXYZ";

private:
	unsigned driven_dofs() const;
	std::vector<Real> settings() const;
	Vector3r place(Real t) const { return origin + velocity * t; }
	Quaternionr orientation(Real t) const { return rotation(spin, t) * originOrientation; }
	bool is_elsewhere(const yade::State& state) const;
	void begin_leg(const yade::State& state);
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::SpinTranslateDrive, "SpinTranslateDrive")
