/// The ledger's entry `time step` is leapfrog's energy error, which has a closed form.
///
/// The work of an elastic force F(delta) = U'(delta), summed by the trapezoid over steps, differs from -Delta U by Delta delta^3
/// F''/12. Over an impact, with dv/dt = (F + damping)/m, that sums to
///
///   dt^2/12 [F' v^2 + F^2/m] - dt^2/6 sum F' c v^2 dt/m,
///
/// in which the bracket is 0 before and after the impact. What remains is (omega dt)^2/6 of the energy that the dashpot
/// dissipates, and, because a contact begins and ends within a step and F'' is not finite there, noise with mean 0 that falls as
/// dt^(5/2) or faster.
#include <gtest/gtest.h>

#include "engines/loop/test_scenes.hpp"

using namespace graindrive;
using namespace graindrive::loop;
using namespace graindrive::loop::test;

namespace {

const laws::HertzHistory<Real> paper{ 2e6, 2.46e6, 2500, 2500, 0 };  // Tripura et al., section 2
constexpr double speed = 1, paper_step = 1e-4;

/// Two disks that approach and touch at some moment within a step.
Scene<2> impact(double dt, double phase, double damping)
{
	Scene<2> s;
	s.law = laws::HertzHistory<Real>{ paper.k_n, paper.k_t, damping, damping, 0 };
	s.friction = false;
	s.dt = dt;
	s.grains = { disk(0, 0), disk(1 + speed * dt * (1 + phase), 0) };
	s.grains[0].velocity[0] = speed / 2, s.grains[1].velocity[0] = -speed / 2;
	return s;
}

struct Impact {
	double entry = 0, predicted = 0;  // over the energy before the impact
	double change = 0;                // change of the kinetic energy by the impact
};

Impact outcome(const Scene<2>& scene)
{
	Stepper<2> loop(scene);
	loop.track_energy(true);
	const double mass = scene.grains[0].mass / 2, before = 0.5 * mass * speed * speed;
	const auto& law = std::get<laws::HertzHistory<Real>>(scene.law);
	Impact result;
	for (int k = 0; k * scene.dt < 0.03; ++k) {
		const Grain<2> a = loop.grain(0), b = loop.grain(1);
		const double h = std::sqrt(0.25 * std::max(0.0, 1 - (b.place[0] - a.place[0]))), stiffness = 1.5 * law.k_n * h,
					 dashpot = law.gamma_n * mass * h;
		loop.step();
		const double v = (a.velocity[0] - b.velocity[0] + loop.grain(0).velocity[0] - loop.grain(1).velocity[0]) / 2;
		result.predicted -= scene.dt * scene.dt / 6 * stiffness * dashpot * v * v / mass * scene.dt / before;
	}
	EXPECT_EQ(loop.contacts().size(), 0u);
	const double after = loop.grain(0).velocity[0] - loop.grain(1).velocity[0];
	result.entry = loop.energy_ledger()->energies().time_step / before;
	result.change = 0.5 * mass * after * after / before - 1;
	return result;
}

/// Mean over the moments within a step, its standard error, and the mean of the prediction.
struct Sample {
	double mean = 0, error = 0, predicted = 0, spread = 0;
};

Sample over_phases(double dt, double damping, double Impact::*what)
{
	constexpr int n = 100;
	double sum = 0, squares = 0, predicted = 0;
	for (int k = 0; k < n; ++k) {
		const Impact impact_ = outcome(impact(dt, (k + 0.5) / n, damping));
		sum += impact_.*what, squares += impact_.*what * (impact_.*what), predicted += impact_.predicted;
	}
	const double mean = sum / n, spread = std::sqrt(squares / n - mean * mean);
	return { mean, spread / std::sqrt(double(n)), predicted / n, spread };
}

}  // namespace

TEST(TimeStepEntry, of_damped_impacts_is_the_trapezoids_error)
{
	for (const double dt : { paper_step, paper_step / 2, paper_step / 4 }) {
		const Sample entry = over_phases(dt, paper.gamma_n, &Impact::entry);
		// The prediction is summed by the trapezoid rule too, so its relative error is (omega dt)^2, 1e-3.
		EXPECT_NEAR(entry.mean, entry.predicted, 4 * entry.error + 2e-3 * std::abs(entry.predicted)) << "dt = " << dt;
		EXPECT_GT(std::abs(entry.predicted), 10 * entry.error);
	}
}

TEST(TimeStepEntry, of_elastic_impacts_is_what_they_lose_or_gain)
{
	// Before and after the impact all energy is kinetic. Leapfrog changes it, by more than 1e-6 at the paper's time step.
	const Sample at_paper_step = over_phases(paper_step, 0, &Impact::change),
				 halved = over_phases(paper_step / 2, 0, &Impact::change);
	EXPECT_GT(at_paper_step.spread, 1e-6);
	EXPECT_LT(halved.spread, at_paper_step.spread / std::pow(2, 2.5) * 1.5);
	for (const double phase : { 0.1, 0.4, 0.8 }) {
		const Impact one = outcome(impact(paper_step, phase, 0));
		EXPECT_NEAR(one.entry, one.change, 1e-13);  // round-off of some 100 steps
	}
}
