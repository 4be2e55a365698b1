/// Flows with closed forms: rest, rigid rotation, decaying vortices, channel flow of three fluids, and grains that flow down an
/// incline.
#include "engines/continuum/two_phase_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace graindrive::continuum {
namespace {

double full_of_it(double, double) { return 1; }

/// Velocity along x by height in the column i.
template <class Compare>
void for_column(const TwoPhaseFlow& flow, int i, double low, double high, Compare&& compare)
{
	const Grid& grid = flow.grid();
	for (int j = 0; j < grid.ny; ++j)
		if (grid.centre_y(j) > low && grid.centre_y(j) < high)
			compare(grid.centre_y(j), flow.state().velocity.x[grid.at(i, j)], grid.at(i, j));
}

// ---- rest

Fluids granular()
{
	Fluids fluids;
	const double grain = 4 / pi;
	fluids.rheology = laws::GranularFluid<laws::MuOfI>{ laws::MuOfI(), std::sqrt(grain) };
	fluids.density = 0.825 * grain;
	fluids.gas_density = 1e-3 * fluids.density;
	fluids.largest_viscosity = 8000;
	fluids.gas_viscosity = 8e-3;
	return fluids;
}

/// A drum of 24 cells across, half full.
struct Drum {
	double diameter = 48, spacing = 2, spin = 0, gravity = -1;
	Grid grid{ 40, 40, 2, -40, -40, false };

	TwoPhaseFlow flow(
		const Fluids& fluids, const FlowSettings& given, const std::function<double(double, double)>& fraction) const
	{
		FlowSettings how = given;
		how.gravity_y = gravity;
		const double radius = diameter / 2;
		const Distance distance = [radius](double x, double y) { return radius - std::hypot(x, y); };
		const Domain domain(grid, distance, 2 * spacing, { 0, 0, spin, 0, 0 });
		return TwoPhaseFlow(grid, domain, fluids, how, fraction, WallLayer(grid, domain, distance, 2 * spacing));
	}
};

double below_middle(double, double y) { return y < 0; }

double fastest(const TwoPhaseFlow& flow)
{
	double most = 0;
	for (const Values* part : { &flow.state().velocity.x, &flow.state().velocity.y })
		for (const double value : *part) most = std::max(most, std::abs(value));
	return most;
}

FlowSettings usual_steps(Viscosity viscosity)
{
	FlowSettings how;
	how.viscosity = viscosity;
	how.time_step = viscosity == Viscosity::full ? 0.02 : 1e-4;
	return how;
}

TEST(TwoPhaseFlow, grains_at_rest_below_gas_stay_at_rest)
{
	for (const Viscosity viscosity : { Viscosity::split, Viscosity::full }) {
		TwoPhaseFlow flow = Drum().flow(granular(), usual_steps(viscosity), below_middle);
		flow.advance(300);
		// In cells at the wall, which form a staircase, the tolerance of the pressure solver leaves velocities of 1e-5 g dt in
		// each step.
		EXPECT_LT(fastest(flow), 1e-4);
		const Grid& grid = flow.grid();
		const double rho_g = flow.fluids().density;
		for (const int j : { 12, 16, 19 })
			EXPECT_NEAR(flow.state().pressure[grid.at(20, j)], -rho_g * grid.centre_y(j), 2e-3 * 24) << "height " << j;
	}
}

TEST(TwoPhaseFlow, a_hundred_thousand_steps_of_rest_make_no_flow)
{
	for (const Viscosity viscosity : { Viscosity::split, Viscosity::full }) {
		Drum coarse;
		coarse.spacing = 3;
		coarse.grid = { 24, 24, 3, -36, -36, false };
		TwoPhaseFlow flow = coarse.flow(granular(), usual_steps(viscosity), below_middle);
		flow.advance(100000);
		EXPECT_LT(fastest(flow), 1e-5);  // in (g d)^1/2; the flowing layer of a drum has about 1
	}
}

TEST(TwoPhaseFlow, a_full_drum_turns_as_a_rigid_body_with_the_pressure_of_gravity_and_rotation)
{
	Drum drum;
	drum.spin = 0.05;
	Fluids fluids = granular();
	fluids.rheology = laws::NewtonianFluid{ 50 };
	fluids.largest_viscosity = 50;
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.05;
	how.tolerance = how.viscous_tolerance = 1e-9;
	TwoPhaseFlow flow = drum.flow(fluids, how, full_of_it);
	flow.advance(1500);  // 75, many times the slowest mode's rho R^2/(14.7 eta) = 0.8
	const Grid& grid = flow.grid();
	const Values &p = flow.state().pressure, &u = flow.state().velocity.x;
	const double rho = fluids.density, middle = p[grid.at(20, 20)], y_0 = grid.centre_y(20), x_0 = grid.centre_x(20);
	const auto exact = [&](double x, double y) { return 0.5 * rho * drum.spin * drum.spin * (x * x + y * y) - rho * y; };
	for (const int j : { 12, 16, 20, 24, 27 }) {
		EXPECT_NEAR(u[grid.at(20, j)], -drum.spin * grid.centre_y(j), 1e-4 * drum.spin * 24);
		const double y = grid.centre_y(j);
		EXPECT_NEAR(p[grid.at(20, j)] - middle, exact(x_0, y) - exact(x_0, y_0), 1e-3 * rho * 24) << "height " << j;
	}
}

TEST(TwoPhaseFlow, a_newtonian_fluid_at_rest_has_its_own_viscosity)
{
	Fluids fluids = granular();
	fluids.rheology = laws::NewtonianFluid{ 50 };
	fluids.largest_viscosity = 1e300;
	FlowSettings how;
	how.viscosity = Viscosity::full;
	TwoPhaseFlow flow = Drum().flow(fluids, how, full_of_it);
	EXPECT_EQ(flow.present_viscosity()[flow.grid().at(20, 20)], 50);
}

// ---- decay

/// Largest error of u after `time` for a Taylor-Green vortex in a square with slipping walls, n cells a side, time steps of
/// `share` spacing.
double taylor_green(int n, double share, Viscosity viscosity)
{
	const double nu = 0.05, time = 0.5;
	Fluids fluids;
	fluids.rheology = laws::NewtonianFluid{ nu };
	fluids.largest_viscosity = nu;
	fluids.density = 1;
	fluids.gas_density = 1;
	fluids.gas_viscosity = nu;
	const Grid grid{ n, n, 1.0 / n, 0, 0, false };
	FlowSettings how;
	how.viscosity = viscosity;
	const int steps = int(std::ceil(time / (share / n)));
	how.time_step = time / steps;
	how.tolerance = how.viscous_tolerance = 1e-10;
	TwoPhaseFlow flow(grid, Domain(grid), fluids, how, full_of_it);
	FlowState start = flow.state();
	for (int j = 0; j <= n; ++j)
		for (int i = 0; i <= n; ++i) {
			if (j < n) start.velocity.x[grid.at(i, j)] = std::sin(pi * grid.face_x(i)) * std::cos(pi * grid.centre_y(j));
			if (i < n) start.velocity.y[grid.at(i, j)] = -std::cos(pi * grid.centre_x(i)) * std::sin(pi * grid.face_y(j));
		}
	fill_ghosts(grid, start.velocity, Edge::slips);
	advection(grid, start.velocity, start.advection_before);
	// This flow has the pressure p = (cos 2 pi x + cos 2 pi y)/4.
	grid.for_cells([&](int i, int j, std::size_t c) {
		start.potential[c] = 0.25 * (std::cos(2 * pi * grid.centre_x(i)) + std::cos(2 * pi * grid.centre_y(j)));
	});
	fill_ghosts(grid, start.potential);
	flow.restore(start);
	flow.advance(steps);
	const double decay = std::exp(-2 * nu * pi * pi * time);
	double error = 0;
	grid.for_x_faces([&](int i, int j, std::size_t f) {
		const double exact = decay * std::sin(pi * grid.face_x(i)) * std::cos(pi * grid.centre_y(j));
		error = std::max(error, std::abs(flow.state().velocity.x[f] - exact));
	});
	return error;
}

TEST(TwoPhaseFlow, a_taylor_green_vortex_decays_to_second_order)
{
	const double coarse = taylor_green(16, 0.1, Viscosity::split), fine = taylor_green(32, 0.1, Viscosity::split);
	EXPECT_LT(fine, 2e-3);
	EXPECT_NEAR(std::log2(coarse / fine), 2, 0.25);
}

TEST(TwoPhaseFlow, the_implicit_viscosity_is_of_first_order_in_time)
{
	const double coarse = taylor_green(32, 0.4, Viscosity::full), fine = taylor_green(32, 0.2, Viscosity::full);
	EXPECT_LT(fine, 3e-2);
	EXPECT_NEAR(std::log2(coarse / fine), 1, 0.35);
}

// ---- channels

/// The steady flow in a periodic channel of height 1 with no slip at its edges, driven by gravity 1 along x.
TwoPhaseFlow steady_channel(const Fluids& fluids, int n, double time, double dt)
{
	const Grid grid{ 4, n, 1.0 / n, 0, 0, true };
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.edge = Edge::sticks;
	how.time_step = dt;
	how.gravity_x = 1;
	how.viscous_tolerance = 1e-9;
	TwoPhaseFlow flow(grid, Domain(grid), fluids, how, full_of_it);
	flow.advance(long(std::ceil(time / dt)));
	return flow;
}

Fluids one_fluid(const laws::Rheology& rheology, double largest)
{
	Fluids fluids;
	fluids.rheology = rheology;
	fluids.largest_viscosity = largest;
	fluids.gas_density = fluids.density;
	return fluids;
}

TEST(TwoPhaseFlow, poiseuille_flow_in_a_channel)
{
	const double eta = 0.5;
	const TwoPhaseFlow flow = steady_channel(one_fluid(laws::NewtonianFluid{ eta }, eta), 32, 3, 0.02);
	const double peak = 1 / (8 * eta);
	for_column(
		flow, 2, 0, 1, [&](double y, double u, std::size_t) { EXPECT_NEAR(u, y * (1 - y) / (2 * eta), 1e-3 * peak); });  // 1/n^2
}

TEST(TwoPhaseFlow, an_immersed_wall_holds_the_fluid_within_its_transition)
{
	// The same channel between immersed solids: the velocity reaches that of the wall somewhere within eps of it, which shifts
	// the parabola by as much.
	const double eta = 0.5, h = 1.0 / 32, eps = 2 * h;
	const Grid grid{ 4, 40, h, 0, -4 * h, true };
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.02;
	how.gravity_x = 1;
	const Domain domain(grid, [](double, double y) { return std::min(y, 1 - y); }, eps, {});
	TwoPhaseFlow flow(grid, domain, one_fluid(laws::NewtonianFluid{ eta }, eta), how, full_of_it);
	flow.advance(200);
	const auto parabola = [&](double y, double shift) { return (y + shift) * (1 + shift - y) / (2 * eta); };
	for_column(flow, 2, eps, 1 - eps, [&](double y, double u, std::size_t) {
		EXPECT_LT(u, parabola(y, eps));
		EXPECT_GT(u, parabola(y, -eps));
	});
}

/// Largest error of u over its peak for a Bingham fluid, n cells across the channel.
double bingham_error(int n)
{
	const double yield = 0.2, eta = 0.2, sheared = 0.5 - yield, peak = sheared * sheared / (2 * eta);
	const TwoPhaseFlow flow = steady_channel(one_fluid(laws::BinghamFluid{ yield, eta }, 1e3), n, 4, 0.02);
	double most = 0;
	for_column(flow, 2, 0, 1, [&](double y, double u, std::size_t) {
		const double in_shear = std::max(0.0, sheared - std::min(y, 1 - y));
		most = std::max(most, std::abs(u - (peak - in_shear * in_shear / (2 * eta))));
	});
	return most / peak;
}

TEST(TwoPhaseFlow, bingham_flow_in_a_channel_has_a_plug)
{
	// The error is of order 1/n^2, and yield_stress/1000 from the creep of the plug.
	EXPECT_LT(bingham_error(32), 4e-3);
	EXPECT_LT(bingham_error(64), 3e-3);
}

// ---- incline

/// Grains of depth H on an incline. The inertial number I follows from mu(I) = tan(angle), and the velocity is
/// u = 2/3 I sqrt(phi g cos) (H^3/2 - (H - y)^3/2)/d, GDR MiDi (2004); p = phi rho_s g cos (H - y).
void expect_bagnold(double h, double tolerance)
{
	const double angle = 0.29, depth = 20;
	Fluids fluids = granular();
	fluids.gas_density = 1e-3 * fluids.density;
	fluids.gas_viscosity = 1e-3;  // a larger one would slow the grains, with a smaller one the gas would overtake them
	const Grid grid{ 4, int(25 / h), h, 0, 0, true };
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.04;
	how.gravity_x = std::sin(angle);
	how.gravity_y = -std::cos(angle);
	how.viscous_tolerance = 1e-9;
	how.edge = Edge::sticks;
	TwoPhaseFlow flow(grid, Domain(grid), fluids, how, [&](double, double y) { return y < depth; });
	const laws::FrictionConstants c;
	const double mu = std::tan(angle), I = c.I_0 * (mu - c.mu_s) / (c.mu_2 - mu);
	const double phi_g = 0.825 * std::cos(angle);
	const auto bagnold = [&](double y) {
		return 2.0 / 3.0 * I * std::sqrt(phi_g) * (std::pow(depth, 1.5) - std::pow(depth - y, 1.5));
	};
	// Starts near the solution; the difference decays within 4 rho H^2/(pi^2 mu' d (rho_s p)^1/2), some 100.
	FlowState start = flow.state();
	grid.for_cells([&](int i, int j, std::size_t) {
		const double y = grid.centre_y(j);
		start.velocity.x[grid.at(i, j)] = 0.97 * bagnold(std::min(y, depth));
	});
	fill_ghosts(grid, start.velocity, how.edge);
	flow.restore(start);
	flow.advance(8000);
	for_column(flow, 1, 0, depth, [&](double y, double u, std::size_t c_) {
		EXPECT_NEAR(u, bagnold(y), tolerance * bagnold(depth)) << "at " << y;
		EXPECT_NEAR(flow.state().pressure[c_], fluids.density * std::cos(angle) * (depth - y), 0.002 * fluids.density * depth);
	});
}

TEST(TwoPhaseFlow, grains_flow_down_an_incline_as_bagnold_says) { expect_bagnold(0.5, 0.01); }
TEST(TwoPhaseFlow, ten_cells_across_a_flowing_layer_suffice) { expect_bagnold(2, 0.03); }

// ---- keeping

TEST(TwoPhaseFlow, a_turning_drum_keeps_the_area_of_the_grains)
{
	Drum drum;
	drum.spin = 0.02;
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.05;
	TwoPhaseFlow flow = drum.flow(granular(), how, below_middle);
	const double before = flow.area();
	flow.advance(600);
	EXPECT_NEAR(flow.area() / before, 1, 1e-10);
}

TEST(WallLayer, takes_the_value_found_along_the_normal)
{
	const Drum drum;
	const Distance distance = [](double x, double y) { return 24 - std::hypot(x, y); };
	const Domain domain(drum.grid, distance, 4, {});
	Values values = drum.grid.zeros();
	// Along the normal of the wall a layer's values must not change, so they depend on the angle only: here x/r, smooth on the
	// grid's scale.
	drum.grid.for_cells([&](int i, int j, std::size_t c) {
		const double x = drum.grid.centre_x(i), y = drum.grid.centre_y(j);
		values[c] = domain.cell_open[c] >= 1 ? x / std::hypot(x, y) : 99;
	});
	WallLayer(drum.grid, domain, distance, 4).extend(values);
	drum.grid.for_cells([&](int i, int j, std::size_t c) {
		const double x = drum.grid.centre_x(i), y = drum.grid.centre_y(j), r = std::hypot(x, y);
		if (r <= 20 || r >= 30) return;
		EXPECT_NEAR(values[c], x / r, 0.09) << x << ", " << y;  // half a diagonal of a cell over the radius
	});
}

TEST(TwoPhaseFlow, a_restored_state_goes_on_with_the_same_bits)
{
	Drum drum;
	drum.spin = 0.02;
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.05;
	TwoPhaseFlow one = drum.flow(granular(), how, below_middle), other = drum.flow(granular(), how, below_middle);
	one.advance(31);
	other.restore(one.state());
	one.advance(30);
	other.advance(30);
	FlowState a = one.state(), b = other.state();
	EXPECT_EQ(a.steps, b.steps);
	EXPECT_EQ(a.velocity.x, b.velocity.x);
	EXPECT_EQ(a.fraction, b.fraction);
	EXPECT_EQ(a.pressure, b.pressure);
}

TEST(TwoPhaseFlow, no_divergence_is_left_in_the_fluid)
{
	Drum drum;
	drum.spin = 0.02;
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.05;
	how.tolerance = 1e-8;
	TwoPhaseFlow flow = drum.flow(granular(), how, below_middle);
	flow.advance(100);
	Values left = flow.grid().zeros();
	divergence(flow.grid(), flow.state().velocity, left);
	double most = 0;
	flow.grid().for_cells([&](int, int, std::size_t c) {
		if (flow.domain().cell_open[c] > 0) most = std::max(most, std::abs(left[c]));
	});
	EXPECT_LT(most, 1e-6 * fastest(flow) / flow.grid().spacing);
}

// ---- refusals

TEST(TwoPhaseFlow, refuses_what_cannot_be)
{
	const auto refused = [](auto&& change) {
		Fluids fluids = granular();
		FlowSettings how;
		change(fluids, how);
		EXPECT_THROW(Drum().flow(fluids, how, below_middle), std::invalid_argument);
	};
	refused([](Fluids& f, FlowSettings&) { f.density = 0; });
	refused([](Fluids& f, FlowSettings&) { f.gas_density = 2; });
	refused([](Fluids& f, FlowSettings&) { f.gas_viscosity = -1; });
	refused([](Fluids& f, FlowSettings&) { f.largest_viscosity = std::nan(""); });
	refused([](Fluids&, FlowSettings& h) { h.time_step = 0; });
	refused([](Fluids&, FlowSettings& h) { h.time_step = 1e-2; });  // above the explicit bound
	refused([](Fluids&, FlowSettings& h) { h.tolerance = 0; });
	refused([](Fluids&, FlowSettings& h) { h.pressure_solver = "guess"; });
	EXPECT_THROW(Drum().flow(granular(), {}, [](double, double) { return 2.0; }), std::invalid_argument);
}

TEST(TwoPhaseFlow, says_when_the_flow_is_too_fast_for_the_step)
{
	Drum drum;
	drum.gravity = -1000;
	FlowSettings how;
	how.viscosity = Viscosity::full;
	how.time_step = 0.1;
	TwoPhaseFlow flow = drum.flow(granular(), how, [](double x, double) { return x < 0; });
	EXPECT_THROW(flow.advance(200), std::runtime_error);
}

}  // namespace
}  // namespace graindrive::continuum
