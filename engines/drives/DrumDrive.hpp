/// A set of bodies turns rigidly about an axis: a drum's wall.
#pragma once
#include "engines/base/motion.hpp"
#include "engines/drives/Drive.hpp"

namespace graindrive {

class DrumDrive : public Drive<DrumDrive> {
public:
	static constexpr const char* class_name = "DrumDrive";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("bodies", &DrumDrive::bodies, "ids of the bodies that turn");
		visit("axisPoint", &DrumDrive::axisPoint, "a point on the axis [m]");
		visit("angularVelocity", &DrumDrive::angularVelocity, "Omega along the axis [rad/s]");
		visit("origins", &DrumDrive::origins, "positions at the start of the present leg, relative to axisPoint [m]");
		common_attributes(visit);
	}
	void check() const;
	void action() override;

	std::vector<int> bodies;
	Vector3r axisPoint = Vector3r::Zero(), angularVelocity = Vector3r::Zero();
	std::vector<Vector3r> origins;

private:
	using Turn = Eigen::Matrix<Real, 3, 3>;

	std::vector<Real> settings() const;
	Turn turn(Real t) const { return rotation(angularVelocity, t).toRotationMatrix(); }
	bool is_elsewhere() const;
	void begin_leg();
	Wrench move(std::size_t index, const Turn& turn);

	std::vector<Wrench> grains_;
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::DrumDrive, "DrumDrive")
