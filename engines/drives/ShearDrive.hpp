/// Shears a periodic cell of disks homogeneously, at constant height or under a constant pressure, and measures the stress.
#pragma once
#include "engines/base/cell_stress.hpp"
#include "engines/seam/registered.hpp"
#include "engines/seam/scene_grains.hpp"

namespace graindrive {

class ShearDrive : public Registered<ShearDrive> {
public:
	static constexpr const char* class_name = "ShearDrive";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		using Self = ShearDrive;
		visit("shearRate", &Self::shearRate, "dv_x/dy of the mean flow [1/s]");
		visit("pressure", &Self::pressure, "P that the cell's height adapts to [N/m]; 0: constant height");
		visit("pressureDamping", &Self::pressureDamping, "g_p in dL/dt = (p - P) L/g_p [N s/m]");
		visit("height", &Self::height, "height that the cell approaches and keeps [m]; 0: its present height");
		visit("heightRate", &Self::heightRate, "largest rate of this change of height, |dL/dt|/L [1/s]");
		visit("every", &Self::every, "number of steps between two measurements, which also correct the height");
		visit("bins", &Self::bins, "number of parts of the height in which velocities are averaged");
		visit("growth", &Self::growth, "dL/dt / L of the last step [1/s]");
		visit("lastPressure", &Self::lastPressure, "p = (s_xx + s_yy)/2 at the last measurement, contacts and motion [N/m]");
		visit("lastShearStress", &Self::lastShearStress, "tau = -s_xy at the last measurement [N/m]");
		visit("samples", &Self::samples, "number of measurements since clear()");
		visit("sums", &Self::sums,
			"sums of samples: contact stress xx, xy, yx, yy, kinetic stress xx, xy, yx, yy [N/m], contacts of a grain [-], area "
			"fraction [-], growth [1/s], p and tau [N/m], p^2 and tau^2 [N^2/m^2]");
		visit("profileSums", &Self::profileSums, "for each part of the height: sum of v_x relative to the mean flow [m/s]");
		visit("profileCounts", &Self::profileCounts, "for each part of the height: number of grains in the sum");
	}
	void check() const;
	void action() override;
	bool reads_all_bodies() const override { return false; }
	void clear();

	Real shearRate = 0, pressure = 0, pressureDamping = 1, height = 0, heightRate = 1, growth = 0;
	Real lastPressure = 0, lastShearStress = 0;
	int every = 5, bins = 10;
	long samples = 0;
	std::vector<Real> sums, profileSums, profileCounts;

private:
	SceneGrains source_;
	SceneView view_;

	void measure();
	void add_to_profile();
	Real growth_wanted() const;
	void set_flow();
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::ShearDrive, "ShearDrive")
