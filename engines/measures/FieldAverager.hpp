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
		visit("origin", &Self::origin, "origin of the window if body is -1 [m]; may be moved during the average");
		visit("low", &Self::low, "lowest corner of the window, relative to its origin [m]; z is used only in three dimensions");
		visit("high", &Self::high, "highest corner of the window, relative to its origin [m]; z only in three dimensions");
		visit("spacing", &Self::spacing, "side of the bins, squares or cubes, and distance between their middles [m]");
		visit("kernel", &Self::kernel, "'diskBin' (in the plane only), 'gaussian' or 'sphere'");
		visit("width", &Self::width,
			"w of the Gaussian, or the sphere's radius [m]; it must reach a grid point from any position; 'diskBin' has none");
		visit("cutoff", &Self::cutoff, "distance at which the Gaussian is cut off [w]");
		visit("every", &Self::every, "number of steps between two samples");
		visit("relative", &Self::relative, "true: velocities are relative to the body's velocity (without its spin)");
		visit("phases", &Self::phases, "number of parts of a period that are averaged separately");
		visit("period", &Self::period, "period of the phases [s]");
		visit("phaseStart", &Self::phaseStart, "time at which phase 0 begins [s]");
		visit("stress", &Self::stress, "average stress and pressure too");
		visit("samplesData", &Self::samplesData, "samples by phase, for save and load");
		visit("sumsData", &Self::sumsData, "running sums, for save and load");
		visit("averagedAs", &Self::averagedAs, "settings of the sums, for save and load");
		visit("dimensions", &Self::dimensions, "2: disks in the plane of x and y; 3: spheres");
		visit("averageAlong", &Self::averageAlong,
			"'x', 'y' or 'z', in three dimensions: one mean over the window's whole length along that axis in place of points; "
			"'': none");
	}
	void check() const;
	void action() override;
	bool reads_all_bodies() const override { return false; }

	void clear();
	template <int D>
	FieldPlan<D> plan() const;
	/// The axis that fields are averaged over, -1 if none.
	int averaged_axis() const { return averageAlong.empty() ? -1 : averageAlong[0] - 'x'; }
	/// True for an axis along which the grid has points.
	bool has_points_along(int axis) const { return axis < dimensions && axis != averaged_axis(); }
	/// Number of points along an axis; 1 where the grid has none.
	int points(int axis) const { return has_points_along(axis) ? int(std::lround((high[axis] - low[axis]) / spacing)) : 1; }
	/// Number of points of the grid.
	std::size_t all_points() const { return std::size_t(points(0)) * points(1) * points(2); }
	/// Calls act(D) with the dimension as a type, std::integral_constant<int, D>.
	template <class Act>
	auto in_dimension(Act&& act) const
	{
		return dimensions == 3 ? act(std::integral_constant<int, 3>()) : act(std::integral_constant<int, 2>());
	}
	/// Phase of a time, 0 to phases - 1.
	int phase_at(Real time) const;
	/// Samples by phase; zeros where settings have changed since.
	std::vector<int> samples() const;
	/// False before the first sample, and after a change of a setting that affects the fields until the next sample.
	bool sums_fit() const;
	/// Fields at a point of the grid (FieldGrid::point); only while `sums_fit`.
	template <int D>
	FieldMeans<D> means(int phase, int point) const;

	int body = -1, every = 1, phases = 1, dimensions = 2;
	Vector3r origin = Vector3r::Zero(), low = Vector3r(-15, -15, 0), high = Vector3r(15, 15, 0);
	Real spacing = 0.5, width = 1, cutoff = 3, period = 1, phaseStart = 0;
	std::string kernel = "gaussian", averageAlong;
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

	int numbers_at_a_point() const;
	std::size_t sums_in_a_phase() const { return all_points() * numbers_at_a_point(); }
	std::string description() const;
	void check_window() const;
	void check_kernel() const;
	Frame frame();
	void leave_out_what_is_no_grain();
	void require_a_plane() const;
	template <int D>
	void add_sample(const Frame& frame, Real* sums) const;
	template <int D>
	void add_grains(const FieldPlan<D>& plan, const Frame& frame, Real* sums) const;
	template <int D>
	void add_contacts(const FieldPlan<D>& plan, const Frame& frame, Real* sums) const;
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::FieldAverager, "FieldAverager")
