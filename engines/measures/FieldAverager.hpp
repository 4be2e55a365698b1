/// Fields around a body or in a fixed window, averaged while the scene runs.
#pragma once
#include "engines/measures/field_sums.hpp"
#include "engines/seam/registered.hpp"
#include "engines/seam/scene_grains.hpp"

namespace graindrive {

class FieldAverager : public Registered<FieldAverager> {
public:
	static constexpr const char* class_name = "FieldAverager";
	static const char* const documentation;

	template <class Visit>
	static void attributes(Visit&& visit)
	{
		using Self = FieldAverager;
		visit("body", &Self::body, "id of the body or clump whose centre is the window's origin; -1: the fixed point `origin`");
		visit("origin", &Self::origin, "origin of the window where there is no body [m]; may be moved while it averages");
		visit("low", &Self::low, "lower left corner of the window from its origin, (x, y, 0) [m]");
		visit("high", &Self::high, "upper right corner of the window from its origin, (x, y, 0) [m]");
		visit("spacing", &Self::spacing, "edge of the square bins, distance of the points in their middles [m]");
		visit("kernel", &Self::kernel, "'diskBin', 'gaussian' or 'sphere'");
		visit("width", &Self::width,
			"w of the Gaussian, or the sphere's radius [m], wide enough to reach a grid point from anywhere; 'diskBin' has none");
		visit("cutoff", &Self::cutoff, "where the Gaussian ends [w]");
		visit("every", &Self::every, "sample every so many steps");
		visit("relative", &Self::relative, "velocities relative to the body's velocity (without its spin)");
		visit("phases", &Self::phases, "number of parts of a period that are averaged apart");
		visit("period", &Self::period, "period of the phases [s]");
		visit("phaseStart", &Self::phaseStart, "time at which phase 0 begins [s]");
		visit("stress", &Self::stress, "average stress and pressure too");
		visit("samplesData", &Self::samplesData, "samples by phase, for save and load");
		visit("sumsData", &Self::sumsData, "running sums, for save and load");
		visit("averagedAs", &Self::averagedAs, "the settings that the sums were made with, for save and load");
	}
	void check() const;
	void action() override;
	bool reads_all_bodies() const override { return false; }

	void clear();
	FieldPlan plan() const;
	/// Number of points along an axis.
	int points(int axis) const { return int(std::lround((high[axis] - low[axis]) / spacing)); }
	/// Phase of a time, 0 to phases - 1.
	int phase_at(Real time) const;
	/// Samples by phase; zeros where settings have changed since.
	std::vector<int> samples() const;
	/// False before the first sample and after a change of what decides the fields, until the next one.
	bool sums_fit() const;
	/// Fields at a point of the grid, place j nx + i; only while `sums_fit`.
	FieldMeans means(int phase, int point) const;

	int body = -1, every = 1, phases = 1;
	Vector3r origin = Vector3r::Zero(), low = Vector3r(-15, -15, 0), high = Vector3r(15, 15, 0);
	Real spacing = 0.5, width = 1, cutoff = 3, period = 1, phaseStart = 0;
	std::string kernel = "gaussian";
	bool relative = false, stress = true;
	std::vector<int> samplesData;
	std::vector<Real> sumsData;
	std::string averagedAs;

private:
	/// Where the window is now and how fast it moves.
	struct Frame {
		Vector3r origin, velocity;
	};
	SceneGrains source_;
	SceneView view_;

	std::size_t sums_in_a_phase() const { return std::size_t(points(0)) * points(1) * sums_at_a_point(stress); }
	std::string description() const;
	Frame frame();
	void leave_out_the_body();
	void add_grains(const FieldPlan& plan, const Frame& frame, Real* sums) const;
	void add_contacts(const FieldPlan& plan, const Frame& frame, Real* sums) const;
};

}  // namespace graindrive
