/// Fields around a body or in a fixed window, averaged while the scene runs.
#include "engines/measures/FieldAverager.hpp"

#include "engines/seam/scene_contacts.hpp"

namespace graindrive {

const char* const FieldAverager::documentation =
	"Area or solid fraction, velocity, granular temperature, density and stress on a grid, averaged during the run.\n\n"
	"kernel='diskBin': exact area of overlap between grain and bin, velocities with rotation; each grain has one velocity\n"
	"in each bin, the mean over the area of overlap (Kumar, Dhiman, Reddy 2019, Eqs A1-A7). kernel='gaussian':\n"
	"exp(-r^2/w^2), cut off at `cutoff` w and normalised (Tripura et al., Eqs 3.1-3.5; Glasser, Goldhirsch 2001).\n"
	"kernel='sphere': averages in spheres (in two dimensions in disks) of radius `width` (Guillard, Forterre, Pouliquen\n"
	"2014, Eqs A2, A3). Contact stress comes from the exact integral of the kernel along the branch vector, kinetic stress\n"
	"from the fluctuations about the mean over all samples; both are positive in compression, and pressure =\n"
	"tr/dimensions.\n\n"
	"dimensions=2: disks, which are free in x, y and in their rotation about z; areaFraction, density [kg/m^2], stress\n"
	"[N/m]. dimensions=3: spheres, which are free in all six degrees; solidFraction, density [kg/m^3], stress [N/m^2]. A\n"
	"grain belongs to no clump and is not `body`. All other bodies (walls, driven disks, beads of an intruder) are\n"
	"boundaries: they do not contribute to area fraction, velocity and kinetic stress, and their contacts count from the\n"
	"grain's centre to the contact point (Weinhart, Thornton, Luding, Bokhove 2012, after Goldhirsch 2010).\n\n"
	"averageAlong='y', in three dimensions: grid points in x and z, fields averaged over y, with the kernel's integral\n"
	"over y in closed form. If the window is as long as the period along y, the result is the mean of the\n"
	"three-dimensional fields over the period. In any other window only grains whose centres lie in it count, and only the\n"
	"parts of branch vectors that lie in it; it is then best to place 'low' and 'high' at the walls.\n\n"
	"Arrays have the shape (phases, ny, nx), in three dimensions (phases, nz, ny, nx) without the axis averaged over;\n"
	"(..., D) for vectors, (..., D, D) for stress[a, b]: force along a, branch along b; D = dimensions, also if an axis is\n"
	"averaged over. A sample at time t belongs to phase floor(phases frac((t - phaseStart)/period)). Place it after the\n"
	"contacts and before drives and the integrator. Changing a setting that affects the fields clears all samples. Results\n"
	"mislead where few grains pass: velocity is a mean over grains, not over samples. Raises ValueError for a window,\n"
	"spacing, kernel or number out of range.";

namespace {

constexpr Real most_numbers = 2e8;      // 1.6 GB of sums
constexpr Real phase_tolerance = 1e-6;  // of a phase: YADE's time is a sum of steps, and samples often fall on a phase's start

}  // namespace

void FieldAverager::check() const
{
	require(body >= -1, "FieldAverager.body must be the id of a body or clump, or -1 for a fixed origin", body);
	require(dimensions == 2 || dimensions == 3, "FieldAverager.dimensions must be 2 or 3", dimensions);
	require(averageAlong.empty() || averageAlong == "x" || averageAlong == "y" || averageAlong == "z",
		"FieldAverager.averageAlong must be 'x', 'y', 'z' or '' for no axis", averageAlong);
	require(averageAlong.empty() || dimensions == 3, "FieldAverager.averageAlong needs dimensions=3; FieldAverager.dimensions",
		dimensions);
	check_window();
	check_kernel();
	require(every >= 1, "FieldAverager.every must be at least 1", every);
	require(phases >= 1 && phases <= 10000, "FieldAverager.phases must lie in 1..10000", phases);
	require(std::isfinite(period) && period > 0, "FieldAverager.period must be positive and finite", period);
	require(std::isfinite(phaseStart), "FieldAverager.phaseStart must be finite", phaseStart);
	require(!relative || body >= 0, "FieldAverager.relative needs a body; FieldAverager.body", body);
	const Real numbers = Real(phases) * points(0) * points(1) * points(2) * numbers_at_a_point();
	require(numbers <= most_numbers,
		"FieldAverager: phases times bins times summed numbers (5, 14 with stress; in three dimensions 6 and 24) must be at "
		"most "
		"2e8 numbers; take larger bins",
		numbers);
}

void FieldAverager::check_window() const
{
	require(origin.allFinite(), "FieldAverager.origin must be finite", origin.transpose());
	require(low.allFinite(), "FieldAverager.low must be finite", low.transpose());
	require(high.allFinite(), "FieldAverager.high must be finite", high.transpose());
	require(std::isfinite(spacing) && spacing > 0, "FieldAverager.spacing must be positive and finite", spacing);
	for (int k = 0; k < dimensions; ++k) {
		if (!has_points_along(k)) {
			require(high[k] > low[k], "FieldAverager.high must exceed low along averageAlong; high - low", high[k] - low[k]);
			continue;
		}
		const std::string axes = dimensions == 2 ? "x and y" : "x, y and z";
		const Real bins = (high[k] - low[k]) / spacing;
		require(bins > 0.5 && bins < 1e6,
			("FieldAverager.high must exceed low, by up to 1e6 spacings, in " + axes + "; number of bins").c_str(), bins);
		require(std::abs(bins - std::round(bins)) < 1e-6,
			("FieldAverager: the window must hold a whole number of bins in " + axes +
				"; change spacing, low or high; number of bins")
				.c_str(),
			bins);
	}
}

void FieldAverager::check_kernel() const
{
	require(kernel == "diskBin" || kernel == "gaussian" || kernel == "sphere",
		"FieldAverager.kernel must be 'diskBin', 'gaussian' or 'sphere'", kernel);
	require(kernel != "diskBin" || dimensions == 2,
		"FieldAverager.kernel='diskBin' uses areas of disks and needs dimensions=2; take 'gaussian' or 'sphere' for "
		"spheres; "
		"FieldAverager.dimensions",
		dimensions);
	require(std::isfinite(width) && width > 0, "FieldAverager.width must be positive and finite", width);
	require(std::isfinite(cutoff) && cutoff > 0, "FieldAverager.cutoff must be positive and finite [w]", cutoff);
	if (kernel == "diskBin") return;
	const bool square = dimensions == 2 || !averageAlong.empty();
	const Real reach = kernel == "gaussian" ? width * cutoff : width, diagonal = std::sqrt(square ? 2.0 : 3.0);
	require(reach >= spacing * diagonal / 2,
		(std::string(
			 "FieldAverager: a kernel must reach a grid point from any position; width, times cutoff for the gaussian, must "
			 "be at least ") +
			(square ? "0.71" : "0.87") + " spacing; take a wider kernel or a smaller spacing; reach")
			.c_str(),
		reach);
}

int FieldAverager::numbers_at_a_point() const
{
	return in_dimension([&](auto d) { return sums_at_a_point<d()>(stress); });
}

void FieldAverager::clear()
{
	samplesData.assign(phases, 0);
	sumsData.assign(phases * sums_in_a_phase(), 0);
	averagedAs = description();
}

/// All settings that affect the sums; a fixed origin may be moved during the average, as a body moves.
std::string FieldAverager::description() const
{
	std::ostringstream words;
	words.precision(17);
	words << kernel << ' ' << width << ' ' << cutoff << ' ' << body << ' ' << relative << ' ' << stress << ' ' << phases << ' '
		  << period << ' ' << phaseStart << ' ' << spacing << ' ' << low.transpose() << ' ' << high.transpose();
	if (dimensions == 3) words << " 3D " << averageAlong;
	return words.str();
}

bool FieldAverager::sums_fit() const
{
	return averagedAs == description() && samplesData.size() == std::size_t(phases) &&
	       sumsData.size() == phases * sums_in_a_phase();
}

template <>
FieldPlan<2> FieldAverager::plan<2>() const
{
	FieldKernel<2> chosen = DiskBinKernel{};
	if (kernel == "gaussian") chosen = GaussianKernel<2>{ width, cutoff };
	if (kernel == "sphere") chosen = SphereKernel<2>{ width };
	return { FieldGrid<2>{ low.head<2>(), spacing, { points(0), points(1) } }, chosen, view_.periods.head<2>(), stress };
}

template <>
FieldPlan<3> FieldAverager::plan<3>() const
{
	FieldGrid<3> grid{ low, spacing, { points(0), points(1), points(2) } };
	FieldKernel<3> chosen = SphereKernel<3>{ width };
	if (kernel == "gaussian") chosen = GaussianKernel<3>{ width, cutoff };
	if (const int axis = averaged_axis(); axis >= 0) {
		grid.averaged = axis;
		grid.length = high[axis] - low[axis];
		chosen = AveragedSphereKernel{ width };
		if (kernel == "gaussian") chosen = AveragedGaussianKernel{ { width, cutoff } };
	}
	return { grid, chosen, view_.periods, stress };
}

int FieldAverager::phase_at(Real time) const
{
	const Real cycles = (time - phaseStart) / period;
	return int(std::floor(phases * (cycles - std::floor(cycles)) + phase_tolerance)) % phases;
}

void FieldAverager::action()
{
	if (scene->iter % every != 0) return;
	if (!sums_fit()) clear();
	source_.of(scene).look(view_, stress);
	require(!view_.sheared,
		"FieldAverager does not support a sheared cell; use ShearDrive's averages, or a box; O.cell.hSize[0][1]",
		scene->cell->hSize(0, 1));
	const Frame now = frame();
	leave_out_what_is_no_grain();
	if (dimensions == 2) require_a_plane();
	const int phase = phase_at(scene->time);
	Real* sums = sumsData.data() + phase * sums_in_a_phase();
	in_dimension([&](auto d) { add_sample<d()>(now, sums); });
	++samplesData[phase];
}

template <int D>
void FieldAverager::add_sample(const Frame& frame, Real* sums) const
{
	const FieldPlan<D> by = plan<D>();
	add_grains(by, frame, sums);
	if (stress) add_contacts(by, frame, sums);
}

/// YADE's state of a clump is up to date at every step; that of a single disk is read from the loop, which may not have written
/// it.
FieldAverager::Frame FieldAverager::frame()
{
	if (body < 0) return { origin, Vector3r::Zero() };
	const yade::State* state = body_of(*scene, body, class_name).state.get();
	Frame now{ state->pos, state->vel };
	for (const GrainState& grain : view_.grains)
		if (grain.id == body) now = { grain.position, grain.velocity };
	if (!relative) now.velocity.setZero();
	return now;
}

/// A view's free grains are free in the plane; in space a grain must also be free along z and about x and y.
void FieldAverager::leave_out_what_is_no_grain()
{
	constexpr unsigned out_of_plane = yade::State::DOF_Z | yade::State::DOF_RX | yade::State::DOF_RY;
	bool disks = false, spheres = false;
	for (GrainState& grain : view_.grains) {
		if (grain.id == body) grain.free = false;
		if (dimensions == 2 || !grain.free) continue;
		grain.free = !(body_of(*scene, grain.id, class_name).state->blockedDOFs & out_of_plane);
		(grain.free ? spheres : disks) = true;
	}
	if (disks && !spheres)
		throw std::runtime_error("FieldAverager.dimensions=3 reads spheres that are free in all six degrees of freedom, but "
								 "every grain of this scene is "
								 "blocked along z or about x or y; set dimensions=2 for disks");
}

/// Refuses spheres at different heights, whose areas would be added up.
void FieldAverager::require_a_plane() const
{
	const GrainState* first = nullptr;
	for (const GrainState& grain : view_.grains) {
		if (!grain.free) continue;
		if (!first) first = &grain;
		if (std::abs(grain.position[2] - first->position[2]) <= grain.radius) continue;
		throw std::runtime_error("FieldAverager.dimensions=2 reads disks in a plane of one z, but the centres of grains " +
								 std::to_string(first->id) + " and " + std::to_string(grain.id) +
								 " differ in z by more than a radius; set dimensions=3");
	}
}

template <int D>
void FieldAverager::add_grains(const FieldPlan<D>& plan, const Frame& frame, Real* sums) const
{
	for (const GrainState& g : view_.grains) {
		if (!g.free) continue;
		const Vector3r position = g.position - frame.origin, velocity = g.velocity - frame.velocity;
		add_grain<D>(plan, { position.head<D>(), velocity.head<D>(), g.spin[2], g.radius, g.mass }, sums);
	}
}

template <int D>
void FieldAverager::add_contacts(const FieldPlan<D>& plan, const Frame& frame, Real* sums) const
{
	for (const GrainContact& c : view_.contacts) {
		const GrainState& first = view_.grains[c.first];
		const GrainState* second = c.second == no_grain ? nullptr : &view_.grains[c.second];
		const auto add = [&](const GrainState& from, const Vector3r& branch, const Vector3r& force) {
			add_contact<D>(plan, { (from.position - frame.origin).head<D>(), branch.head<D>(), force.head<D>() }, sums);
		};
		if (!second)
			first.free ? add(first, (first.radius - c.overlap) * c.normal, c.force) : void();
		else if (first.free && second->free)
			add(first, (first.radius + second->radius - c.overlap) * c.normal, c.force);
		else if (first.free)
			add(first, (first.radius - c.overlap / 2) * c.normal, c.force);
		else if (second->free)
			add(*second, (c.overlap / 2 - second->radius) * c.normal, -c.force);
	}
}

std::vector<int> FieldAverager::samples() const { return sums_fit() ? samplesData : std::vector<int>(phases, 0); }

template <int D>
FieldMeans<D> FieldAverager::means(int phase, int point) const
{
	const std::size_t at = phase * sums_in_a_phase() + std::size_t(point) * sums_at_a_point<D>(stress);
	return means_at<D>(sumsData.data() + at, samplesData[phase], stress);
}

template FieldMeans<2> FieldAverager::means<2>(int, int) const;
template FieldMeans<3> FieldAverager::means<3>(int, int) const;

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::FieldAverager)
