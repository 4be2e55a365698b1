/// Fields around a body or in a fixed window, averaged while the scene runs.
#include "engines/measures/FieldAverager.hpp"

#include "engines/seam/scene_contacts.hpp"

namespace graindrive {

const char* const FieldAverager::documentation =
	"Area fraction, velocity, granular temperature, density and stress on a grid, averaged while the scene runs.\n\n"
	"kernel='diskBin': exact area of grain and bin in common, velocities with rotation, one velocity for each grain in each\n"
	"bin: the mean over the common area (Kumar, Dhiman, Reddy 2019, Eqs A1-A7). kernel='gaussian': exp(-r^2/w^2), cut at\n"
	"`cutoff` w and normalised there (Tripura et al., Eqs 3.1-3.5; Glasser, Goldhirsch 2001). kernel='sphere': averages in\n"
	"spheres, here disks, of radius `width` (Guillard, Forterre, Pouliquen 2014, Eqs A2, A3). Contact stress by the exact\n"
	"integral of the kernel along the branch vector, kinetic stress by the fluctuations about the mean over all samples; both\n"
	"positive in compression, pressure = tr/2.\n\n"
	"Grains are disks that are free in x, y and rotation, belong to no clump and are not `body`. All others (walls, driven\n"
	"disks, beads of an intruder) bound the grains: they have no part in area fraction, velocity and kinetic stress, and their\n"
	"contacts count from the grain's centre to the contact point (Weinhart, Thornton, Luding, Bokhove 2012, after Goldhirsch\n"
	"2010).\n\n"
	"Arrays have the shape (phases, ny, nx), (..., 2) for vectors, (..., 2, 2) for stress[a, b]: force along a, branch along b.\n"
	"A sample at time t belongs to phase floor(phases frac((t - phaseStart)/period)). Place it after the contacts and before\n"
	"drives and the integrator. Changing what decides the fields begins anew. Misleads where few grains pass: velocity is a\n"
	"mean over grains, not over samples. Raises ValueError for a window, spacing, kernel or number out of range.";

namespace {

constexpr Real most_numbers = 2e8;      // 1.6 GB of sums
constexpr Real phase_tolerance = 1e-6;  // of a phase: YADE's time is a sum of steps, and samples often fall on a phase's start

}  // namespace

void FieldAverager::check() const
{
	require(body >= -1, "FieldAverager.body must be the id of a body or clump, or -1 for a fixed origin", body);
	require(origin.allFinite(), "FieldAverager.origin must be finite", origin.transpose());
	require(low.allFinite(), "FieldAverager.low must be finite", low.transpose());
	require(high.allFinite(), "FieldAverager.high must be finite", high.transpose());
	require(std::isfinite(spacing) && spacing > 0, "FieldAverager.spacing must be positive and finite", spacing);
	for (int k = 0; k < 2; ++k) {
		const Real bins = (high[k] - low[k]) / spacing;
		require(bins > 0.5 && bins < 1e6, "FieldAverager.high must exceed low, by up to 1e6 spacings, in x and y; number of bins",
			bins);
		require(std::abs(bins - std::round(bins)) < 1e-6,
			"FieldAverager: the window must hold a whole number of bins in x and y; change spacing, low or high; number of bins",
			bins);
	}
	require(kernel == "diskBin" || kernel == "gaussian" || kernel == "sphere",
		"FieldAverager.kernel must be 'diskBin', 'gaussian' or 'sphere'", kernel);
	require(std::isfinite(width) && width > 0, "FieldAverager.width must be positive and finite", width);
	require(std::isfinite(cutoff) && cutoff > 0, "FieldAverager.cutoff must be positive and finite [w]", cutoff);
	if (kernel != "diskBin") {
		const Real reach = kernel == "gaussian" ? width * cutoff : width;
		require(reach >= spacing / std::sqrt(2.0),
			"FieldAverager: a kernel must reach a point of the grid from anywhere; width, times cutoff for the gaussian, must be "
			"at least 0.71 spacing; take a wider kernel or a smaller spacing; reach",
			reach);
	}
	require(every >= 1, "FieldAverager.every must be at least 1", every);
	require(phases >= 1 && phases <= 10000, "FieldAverager.phases must lie in 1..10000", phases);
	require(std::isfinite(period) && period > 0, "FieldAverager.period must be positive and finite", period);
	require(std::isfinite(phaseStart), "FieldAverager.phaseStart must be finite", phaseStart);
	require(!relative || body >= 0, "FieldAverager.relative needs a body to be relative to; FieldAverager.body", body);
	const Real numbers = Real(phases) * Real(sums_in_a_phase());
	require(numbers <= most_numbers,
		"FieldAverager: phases, bins and what is summed (5 numbers, 14 with stress) must make at most 2e8 numbers; take larger "
		"bins",
		numbers);
}

void FieldAverager::clear()
{
	samplesData.assign(phases, 0);
	sumsData.assign(phases * sums_in_a_phase(), 0);
	averagedAs = description();
}

/// All that decides what a sum means; a fixed origin may be moved while it averages, as a body moves.
std::string FieldAverager::description() const
{
	std::ostringstream words;
	words.precision(17);
	words << kernel << ' ' << width << ' ' << cutoff << ' ' << body << ' ' << relative << ' ' << stress << ' ' << phases << ' '
		  << period << ' ' << phaseStart << ' ' << spacing << ' ' << low.transpose() << ' ' << high.transpose();
	return words.str();
}

bool FieldAverager::sums_fit() const
{
	return averagedAs == description() && samplesData.size() == std::size_t(phases) &&
	       sumsData.size() == phases * sums_in_a_phase();
}

FieldPlan FieldAverager::plan() const
{
	FieldKernel chosen = DiskBinKernel{};
	if (kernel == "gaussian") chosen = GaussianKernel{ width, cutoff };
	if (kernel == "sphere") chosen = SphereKernel{ width };
	return { FieldGrid{ low.head<2>(), spacing, points(0), points(1) }, chosen, view_.periods.head<2>(), stress };
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
	const Frame now = frame();
	leave_out_the_body();
	const int phase = phase_at(scene->time);
	Real* sums = sumsData.data() + phase * sums_in_a_phase();
	const FieldPlan by = plan();
	add_grains(by, now, sums);
	if (stress) add_contacts(by, now, sums);
	++samplesData[phase];
}

/// A clump is true in YADE at every step; a single disk is asked of the loop, which may not have written it.
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

void FieldAverager::leave_out_the_body()
{
	for (GrainState& grain : view_.grains)
		if (grain.id == body) grain.free = false;
}

void FieldAverager::add_grains(const FieldPlan& plan, const Frame& frame, Real* sums) const
{
	for (const GrainState& g : view_.grains) {
		if (!g.free) continue;
		const Vector3r position = g.position - frame.origin, velocity = g.velocity - frame.velocity;
		add_grain(plan, { position.head<2>(), velocity.head<2>(), g.spin[2], g.radius, g.mass }, sums);
	}
}

void FieldAverager::add_contacts(const FieldPlan& plan, const Frame& frame, Real* sums) const
{
	for (const GrainContact& c : view_.contacts) {
		const GrainState& first = view_.grains[c.first];
		const GrainState* second = c.second == no_grain ? nullptr : &view_.grains[c.second];
		const auto add = [&](const GrainState& from, const Vector3r& branch, const Vector3r& force) {
			add_contact(plan, { (from.position - frame.origin).head<2>(), branch.head<2>(), force.head<2>() }, sums);
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

FieldMeans FieldAverager::means(int phase, int point) const
{
	const std::size_t at = phase * sums_in_a_phase() + std::size_t(point) * sums_at_a_point(stress);
	return means_at(sumsData.data() + at, samplesData[phase], stress);
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_GUID(graindrive::FieldAverager, "FieldAverager")
