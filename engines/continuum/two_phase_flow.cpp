/// One step: viscosity and forces at the present state, prediction, pressure of the rheology, projection, transport of the
/// surface.
#include "engines/continuum/two_phase_flow.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace graindrive::continuum {

namespace {

void require_positive(const char* name, double value)
{
	if (value > 0 && std::isfinite(value)) return;
	std::ostringstream message;
	message << name << " must be positive and finite, got " << value;
	throw std::invalid_argument(message.str());
}

double clamped(double fraction) { return std::min(1.0, std::max(0.0, fraction)); }

/// Mean of alpha over points of each cell.
Values painted(const Grid& grid, const std::function<double(double, double)>& fraction)
{
	constexpr int points = 8;
	Values result = grid.zeros();
	grid.for_cells([&](int i, int j, std::size_t c) {
		double sum = 0;
		for (int k = 0; k < points * points; ++k) {
			const double x = grid.face_x(i) + (k % points + 0.5) / points * grid.spacing;
			const double y = grid.face_y(j) + (k / points + 0.5) / points * grid.spacing;
			sum += fraction(x, y);
		}
		result[c] = sum / (points * points);
		if (!(result[c] >= 0 && result[c] <= 1))
			throw std::invalid_argument("the fraction of the dense fluid must lie in [0, 1], got " + std::to_string(result[c]) +
										" at (" + std::to_string(grid.centre_x(i)) + ", " + std::to_string(grid.centre_y(j)) +
										")");
	});
	return result;
}

/// 2 g - g_before: the extrapolation of a quantity to the next step.
void extrapolate(Values& present, Values& before)
{
	for (std::size_t k = 0; k < present.size(); ++k) {
		const double next = 2 * present[k] - before[k];
		before[k] = present[k];
		present[k] = next;
	}
}

template <class Part>
void timed(double& seconds, Part&& part)
{
	const auto start = std::chrono::steady_clock::now();
	part();
	seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void add_in_cells(const Grid& grid, const Values& what, Values& to)
{
	grid.for_cells([&](int, int, std::size_t c) { to[c] += what[c]; });
}

}  // namespace

TwoPhaseFlow::TwoPhaseFlow(const Grid& grid, const Domain& domain, const Fluids& fluids, const FlowSettings& settings,
	const std::function<double(double, double)>& fraction, const WallLayer& wall_layer)
	: g(grid),
	  d(domain),
	  material(fluids),
	  how(settings),
	  layer(wall_layer),
	  wholly_open(grid.zeros()),
	  transport(grid, d, settings.sharpness),
	  split(grid, d, settings.edge),
	  full(grid, d, settings.edge),
	  pressures(grid, settings.pressure_solver),
	  rates(grid),
	  stresses(grid),
	  rate(grid.zeros()),
	  node_rate(grid.zeros()),
	  density(grid.zeros()),
	  scratch(grid.zeros()),
	  viscosity(grid),
	  over_density(zero_faces(grid)),
	  advected(zero_faces(grid)),
	  viscous(zero_faces(grid)),
	  given(zero_faces(grid)),
	  predicted(zero_faces(grid)),
	  change(zero_faces(grid)),
	  inertia(zero_faces(grid))
{
	check();
	g.for_cells([&](int, int, std::size_t c) { wholly_open[c] = d.cell_open[c] >= 1; });
	now.fraction = painted(g, fraction);
	layer.extend(now.fraction);
	fill_ghosts(g, now.fraction);
	now.velocity = now.advection_before = zero_faces(g);
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t) {
		component(now.velocity)[f] = component(d.open)[f] > 0 ? 0 : component(d.wall)[f];
	});
	fill_ghosts(g, now.velocity, how.edge);
	for (Values* list :
		{ &now.potential, &now.potential_change, &now.potential_change_before, &now.pressure, &now.pressure_before })
		*list = g.zeros();
	find_material();
	find_forces();
	now.advection_before = advected;
	find_pressure();  // the pressure at rest: only the wall moves
	now.pressure_before = now.pressure;
	now.potential = now.pressure;
}

/// `work(density, component, f, next)`: `component` picks x or y of FaceValues, `next` is the distance of the cells beside the
/// face.
template <class Work>
void TwoPhaseFlow::for_faces(Work&& work)
{
	g.for_x_faces([&](int, int, std::size_t f) {
		work(
			density, [](auto& faces) -> auto& { return faces.x; }, f, std::size_t(1));
	});
	g.for_y_faces([&](int, int, std::size_t f) {
		work(
			density, [](auto& faces) -> auto& { return faces.y; }, f, g.stride());
	});
}

void TwoPhaseFlow::check() const
{
	require_positive("the density of the dense fluid", material.density);
	require_positive("the density of the gas", material.gas_density);
	require_positive("the viscosity of the gas", material.gas_viscosity);
	require_positive("the largest viscosity", material.largest_viscosity);
	require_positive("the least pressure", material.least_pressure);
	require_positive("the time step", how.time_step);
	require_positive("the pressure's tolerance", how.tolerance);
	require_positive("the viscosity's tolerance", how.viscous_tolerance);
	require_positive("the implicit share of the viscosity", how.implicit_share);
	if (material.gas_density > material.density) {
		std::ostringstream message;
		message << "the gas must not be denser than the other fluid, whose density is " << material.density << ", got "
				<< material.gas_density;
		throw std::invalid_argument(message.str());
	}
	if (how.time_step <= stable_step()) return;
	std::ostringstream message;
	message << "the time step must not be above " << stable_step()
			<< ", which the explicit part of the viscosity allows on this grid, got " << how.time_step
			<< "; take a smaller one, a larger implicit share, or treat the viscosity as a whole";
	throw std::invalid_argument(message.str());
}

double TwoPhaseFlow::nu_0() const
{
	return how.implicit_share * (material.gas_viscosity / material.gas_density + material.largest_viscosity / material.density);
}

/// Each mode with wave number k grows by (1 - k^2 dt (nu - nu_0/2))/(1 + k^2 dt nu_0/2), where k^2 <= 8/spacing^2.
double TwoPhaseFlow::stable_step() const
{
	if (how.viscosity == Viscosity::full) return std::numeric_limits<double>::infinity();
	const double largest = std::max(material.gas_viscosity / material.gas_density, material.largest_viscosity / material.density);
	const double explicit_part = largest - nu_0();
	return explicit_part > 0 ? g.spacing * g.spacing / (4 * explicit_part) : std::numeric_limits<double>::infinity();
}

void TwoPhaseFlow::set_time_step(double dt)
{
	const double before = how.time_step;
	how.time_step = dt;
	try {
		check();
	} catch (...) {
		how.time_step = before;
		throw;
	}
}

void TwoPhaseFlow::step()
{
	timed(times.material, [&] { find_material(); });
	timed(times.forces, [&] { find_forces(); });
	timed(times.pressure, [&] { find_pressure(); });
	timed(times.viscosity, [&] { predict(); });
	timed(times.pressure, [&] { project(); });
	timed(times.surface, [&] { move_surface(); });
	require_followed();
	now.time += how.time_step;
	++now.steps;
}

void TwoPhaseFlow::advance(long steps)
{
	for (long k = 0; k < steps; ++k) step();
}

/// Densities, viscosities, and the coefficients chi/rho that both pressures of the step share.
void TwoPhaseFlow::find_material()
{
	rates_of(g, now.velocity, rates);
	find_viscosity();
	g.for_cells([&](int, int, std::size_t c) {
		const double alpha = clamped(now.fraction[c]);
		density[c] = material.density * alpha + material.gas_density * (1 - alpha);
	});
	fill_ghosts(g, density);
	for_faces([&](const Values& rho, auto component, std::size_t f, std::size_t next) {
		component(over_density)[f] = 2 / (rho[f] + rho[f - next]);
	});
	FaceValues& coefficients = change;
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t) {
		component(coefficients)[f] = component(d.open)[f] * component(over_density)[f];
	});
	if (g.periodic_x)
		for (int j = 0; j < g.ny; ++j) {
			coefficients.x[g.at(g.nx, j)] = coefficients.x[g.at(0, j)];
			over_density.x[g.at(g.nx, j)] = over_density.x[g.at(0, j)];
		}
	pressures.update(coefficients);
}

/// (26), (29) in cells, and at nodes from the shear rate and the mean pressure there: the shear stress over the pressure, mu(I),
/// hardly changes with the rate, so that a viscosity between two cells that errs by a tenth would double the rate. A node beside
/// a cell of gas alone is gas: the shear stress of both fluids at their surface is that of the gas, and faces in the gas would
/// else feel the grains'.
void TwoPhaseFlow::find_viscosity()
{
	shear_rate(g, rates, rate);
	shear_rate_at_nodes(g, rates, node_rate);
	extrapolate_ghosts(g, now.pressure);
	constexpr double least_rate =
		1e-12;  // where a fluid with a yield stress is at its largest viscosity, and a Newtonian at its own
	const std::size_t up = g.stride();
	const Values& alpha = now.fraction;
	std::visit(
		[&](const auto& fluid) {
			const auto mixed = [&](double part, double shear, double pressure) {
				if (part <= 0) return material.gas_viscosity;
				const double of_fluid = fluid.viscosity(std::max(shear, least_rate), std::max(pressure, material.least_pressure));
				return part * std::min(material.largest_viscosity, of_fluid) + (1 - part) * material.gas_viscosity;
			};
			g.for_cells(
				[&](int, int, std::size_t c) { viscosity.cells[c] = mixed(clamped(alpha[c]), rate[c], now.pressure[c]); });
			for_nodes(g, [&](std::size_t n) {
				const double a = alpha[n], b = alpha[n - 1], c = alpha[n - up], d_ = alpha[n - up - 1];
				const double least = std::min(std::min(a, b), std::min(c, d_));
				const double part = least > 0 ? clamped(4 / (1 / a + 1 / b + 1 / c + 1 / d_)) : 0;
				viscosity.nodes[n] = mixed(part, node_rate[n], at_node(now.pressure, n, up));
			});
		},
		material.rheology);
	fill_ghosts(g, viscosity.cells);
}

/// A = -div(v v) and B = div(eta (grad v + grad v^T))/rho.
void TwoPhaseFlow::find_forces()
{
	advection(g, now.velocity, advected);
	viscous_force(g, rates, viscosity, stresses, viscous);
	for_faces(
		[&](const Values&, auto component, std::size_t f, std::size_t) { component(viscous)[f] *= component(over_density)[f]; });
}

/// div(chi/rho grad p) = div{chi (v/dt + A + B + g) + (1 - chi) v_wall/dt}. Oba, Otsuki (2025), (46), leaves out chi v/dt; its
/// own (47), of which it is the divergence, has the term, and without it the wall's velocity alone makes pressures of v_wall
/// spacing/dt.
void TwoPhaseFlow::find_pressure()
{
	const double over_dt = 1 / how.time_step;
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t) {
		const double chi = component(d.open)[f];
		const double gravity = &component(given) == &given.x ? how.gravity_x : how.gravity_y;
		component(given)[f] =
			chi * (over_dt * component(now.velocity)[f] + component(advected)[f] + component(viscous)[f] + gravity) +
			(1 - chi) * over_dt * component(d.wall)[f];
	});
	if (g.periodic_x)
		for (int j = 0; j < g.ny; ++j) given.x[g.at(g.nx, j)] = given.x[g.at(0, j)];
	divergence(g, given, scratch);
	right_side_size = pressures.size_of(scratch);
	extrapolate(now.pressure, now.pressure_before);
	last.pressure_iterations = pressures.solve(scratch, now.pressure, how.tolerance, right_side_size);
	set_pressure_level();
}

/// A closed vessel fixes pressure up to a constant: that of the gas is 0 on average, or, without gas, the least pressure is.
void TwoPhaseFlow::set_pressure_level()
{
	double gas = 0, sum = 0, least = std::numeric_limits<double>::infinity();
	g.for_cells([&](int, int, std::size_t c) {
		if (d.fluid[c] == 0) return;
		const double weight = d.cell_open[c] * (1 - clamped(now.fraction[c]));
		gas += weight;
		sum += weight * now.pressure[c];
		if (d.cell_open[c] >= 1) least = std::min(least, now.pressure[c]);
	});
	const double level = gas > 1 ? sum / gas : least;
	for (std::size_t k = 0; k < now.pressure.size(); ++k) now.pressure[k] -= d.fluid[k] * level;
}

void TwoPhaseFlow::predict()
{
	if (how.viscosity == Viscosity::split)
		predict_split();
	else
		predict_full();
	fill_ghosts(g, predicted, how.edge);
}

/// v* = chi (v + delta) + (1 - chi) v_wall, (1 - nu_0 dt/2 laplace) delta = dt ((3 A - A')/2 - grad S/rho + B + g): (42), (43),
/// as a change.
void TwoPhaseFlow::predict_split()
{
	const double dt = how.time_step, over_spacing = 1 / g.spacing;
	const Values& S = now.potential;
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t next) {
		const double gravity = next == 1 ? how.gravity_x : how.gravity_y;
		component(given)[f] =
			dt * (1.5 * component(advected)[f] - 0.5 * component(now.advection_before)[f] -
					 over_spacing * (S[f] - S[f - next]) * component(over_density)[f] + component(viscous)[f] + gravity);
	});
	change = given;
	last.viscous_iterations = split.solve(0.5 * nu_0() * dt, given, change, how.viscous_tolerance).iterations;
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t) {
		const double chi = component(d.open)[f];
		component(predicted)[f] = chi * (component(now.velocity)[f] + component(change)[f]) + (1 - chi) * component(d.wall)[f];
	});
}

/// The same with B of v*: v* = chi (v + dt ((3 A - A')/2 - grad S/rho + B* + g)) + (1 - chi) v_wall.
void TwoPhaseFlow::predict_full()
{
	const double dt = how.time_step, over_spacing = 1 / g.spacing;
	const Values& S = now.potential;
	for_faces([&](const Values& rho, auto component, std::size_t f, std::size_t next) {
		const double chi = component(d.open)[f];
		const double gravity = next == 1 ? how.gravity_x : how.gravity_y;
		if (chi <= 0) {
			component(predicted)[f] = component(d.wall)[f];
			return;
		}
		const double weight = 0.5 * (rho[f] + rho[f - next]) / (chi * dt);
		component(inertia)[f] = weight;
		component(given)[f] =
			weight * (chi * (component(now.velocity)[f] +
								dt * (1.5 * component(advected)[f] - 0.5 * component(now.advection_before)[f] -
										 over_spacing * (S[f] - S[f - next]) * component(over_density)[f] + gravity)) +
						 (1 - chi) * component(d.wall)[f]);
		component(predicted)[f] = component(now.velocity)[f];
	});
	last.viscous_iterations = full.solve(inertia, viscosity, given, predicted, how.viscous_tolerance).iterations;
}

/// div(chi/rho grad sigma) = div v*/dt; v = v* - dt chi/rho grad sigma; S += sigma - nu_0/2 rho div v*: (38), (44), (45).
///
/// In a fluid of one density the last term is (38)'s nu_0 dt/2 laplace sigma. Across a surface sigma has a kink, of which (38)
/// makes spikes in S that grow without bound at a ratio of densities of 1000.
void TwoPhaseFlow::project()
{
	const double dt = how.time_step, over_spacing = 1 / g.spacing;
	if (g.periodic_x)
		for (int j = 0; j < g.ny; ++j) predicted.x[g.at(g.nx, j)] = predicted.x[g.at(0, j)];
	divergence(g, predicted, scratch);
	const double rotational = how.viscosity == Viscosity::split ? 0.5 * nu_0() : 0;
	g.for_cells([&](int, int, std::size_t c) {
		now.potential[c] -= d.fluid[c] * rotational * density[c] * scratch[c];
		scratch[c] /= dt;
	});
	Values& sigma = now.potential_change;
	extrapolate(sigma, now.potential_change_before);
	last.potential_iterations = pressures.solve(scratch, sigma, how.tolerance, right_side_size);
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t next) {
		component(now.velocity)[f] = component(predicted)[f] - dt * component(d.open)[f] * component(over_density)[f] *
		                                                           over_spacing * (sigma[f] - sigma[f - next]);
	});
	fill_ghosts(g, now.velocity, how.edge);
	now.advection_before = advected;
	add_in_cells(g, sigma, now.potential);
	fill_ghosts(g, now.potential);
}

/// On the grid a wall is a staircase, through which the flow carries some fluid. Restores the area that this has changed.
void TwoPhaseFlow::move_surface()
{
	const double before = area();
	transport.advect(now.fraction, now.velocity, how.time_step, now.steps % 2 == 0);
	give_back(before - area());
	layer.extend(now.fraction);
	fill_ghosts(g, now.fraction);
}

/// Spreads an area over the cells at the surface, by alpha (1 - alpha).
void TwoPhaseFlow::give_back(double area)
{
	const auto room = [&](std::size_t c) {
		const double alpha = clamped(now.fraction[c]);
		return wholly_open[c] * alpha * (1 - alpha);
	};
	double sum = 0;
	g.for_cells([&](int, int, std::size_t c) { sum += room(c); });
	if (sum <= 0) return;
	const double share = area / (g.spacing * g.spacing * sum);
	g.for_cells([&](int, int, std::size_t c) { now.fraction[c] += share * room(c); });
}

void TwoPhaseFlow::require_followed()
{
	double fastest = 0;
	for_faces([&](const Values&, auto component, std::size_t f, std::size_t) {
		const double speed = std::abs(component(now.velocity)[f]);
		fastest = speed <= fastest ? fastest : speed;  // keeps nan
	});
	last.courant = fastest * how.time_step / g.spacing;
	if (last.courant < 0.5) return;
	std::ostringstream message;
	message << "the flow must cross less than half a cell in a step, but at time " << now.time << " it would cross "
			<< last.courant << " of one; take a time step below " << how.time_step;
	throw std::runtime_error(message.str());
}

const Values& TwoPhaseFlow::present_shear_rate()
{
	find_material();
	return rate;
}

const Values& TwoPhaseFlow::present_viscosity()
{
	find_material();
	return viscosity.cells;
}

Values TwoPhaseFlow::ill_posed()
{
	find_material();
	Values map = g.zeros();
	std::visit(
		[&](const auto& fluid) {
			g.for_cells([&](int, int, std::size_t c) {
				if (now.fraction[c] < 0.5 || d.cell_open[c] < 1) return;
				map[c] = rate[c] <= 0 || fluid.ill_posed(rate[c], std::max(now.pressure[c], material.least_pressure));
			});
		},
		material.rheology);
	return map;
}

void TwoPhaseFlow::restore(const FlowState& state)
{
	FlowState taken = state;
	taken.arrays([&](const char* name, const Values& list) {
		if (list.size() != g.size())
			throw std::invalid_argument(std::string(name) + " must have " + std::to_string(g.size()) + " numbers, got " +
										std::to_string(list.size()) + "; take a state of a flow on the same grid");
		if (!std::all_of(list.begin(), list.end(), [](double value) { return std::isfinite(value); }))
			throw std::invalid_argument(std::string(name) + " must hold finite numbers");
	});
	now = std::move(taken);
}

}  // namespace graindrive::continuum
