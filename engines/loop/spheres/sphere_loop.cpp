/// One step: lists if anything may have come near, forces of early pairs, the sweep, then held spheres.
#include "engines/loop/spheres/sphere_loop.hpp"

#include <algorithm>
#include <cmath>

namespace graindrive::loop {

namespace {

constexpr double sphere_response = 2.5;  // m R^2 / I

}  // namespace

SphereLoop::SphereLoop(const SphereScene& given) : scene(given)
{
	check_scene(scene);
	set_up_kernels();
	arrange_rows();
}

/// What follows from the settings alone.
void SphereLoop::set_up_kernels()
{
	kernel = choose_sphere_kernel({ scene.law.index(), scene.friction, scene.precision });
	team = std::make_unique<ThreadTeam>(scene.threads);
	shares = std::vector<SpherePairs>(scene.threads);
	incoming.resize(scene.threads + 1), incoming_rows.resize(scene.threads + 1);
	counts.resize(scene.threads), found.resize(scene.threads), found_cells.resize(scene.threads + 1);
	thread_beyond.assign(scene.threads, 0);
	data.dt = data.kick = data.drift = scene.dt;
	data.spin_response = scene.rotation ? sphere_response : 0;
	data.law = &scene.law;
	for (int k = 0; k < 3; ++k) {
		data.gravity[k] = scene.gravity[k];
		if (scene.box.periodic[k]) data.inverse_length[k] = 1 / (data.length[k] = scene.box.length(k));
	}
}

void SphereLoop::arrange_rows()
{
	SphereState& s = state;
	s.n = scene.spheres.size();
	for (const bool held : { false, true }) {
		for (std::uint32_t i = 0; i < s.n; ++i)
			if (scene.spheres[i].held == held) s.index_of.push_back(i);
		if (!held) s.n_free = s.index_of.size();
	}
	const std::uint32_t dummies = 2 * scene.threads;
	s.rows.resize(s.n + dummies), s.inverse_masses.resize(s.n + dummies, 0);
	for (std::uint32_t at = 0; at < s.n; ++at) {
		const Sphere& from = scene.spheres[s.index_of[at]];
		SphereRow& row = s.rows[at];
		row = SphereRow{};
		for (int k = 0; k < 3; ++k) row.x[k] = from.x[k], row.v[k] = from.v[k], row.surface[k] = from.radius * from.spin[k];
		row.radius = from.radius;
		if (at < s.n_free) s.inverse_masses[at] = 1 / from.mass, largest_free_radius = std::max(largest_free_radius, from.radius);
		typical_diameter += 2 * from.radius / s.n;
	}
	take_state(SphereState(s));
}

/// Rows of the last threads' dummies may be missing or too many: they are made anew.
void SphereLoop::take_state(const SphereState& from)
{
	state = from;
	const std::uint32_t dummies = 2 * scene.threads;
	state.rows.resize(state.n + dummies), state.inverse_masses.resize(state.n + dummies);
	for (std::uint32_t k = 0; k < dummies; ++k) {
		SphereRow& row = state.rows[state.n + k] = SphereRow{};
		row.radius = typical_diameter, row.x[0] = k % 2 ? 10 * typical_diameter : 0;
		state.inverse_masses[state.n + k] = 0;
	}
	row_of.resize(state.n);
	for (std::uint32_t at = 0; at < state.n; ++at) row_of[state.index_of[at]] = at;
	data.n_free = state.n_free;
	speed.assign(state.n_blocks() + 1, 0), displaced.assign(state.n_blocks() + 1, 0);
	if (state.searches > 0) lay_listed_pairs_out();
}

const SphereState& SphereLoop::keep_state()
{
	state.listed.clear();
	for (const SpherePairs& share : shares)
		share.each_pair(state, [&](std::uint32_t, std::uint32_t candidate, const KeptPair& pair) {
			state.listed.push_back({ candidate, { pair.spring[0], pair.spring[1], pair.spring[2] } });
		});
	return state;
}

void SphereLoop::step(long n)
{
	failure = nullptr;
	team->run([&](int rank) { advance(rank, n); });
	if (failure) std::rethrow_exception(failure);
}

void SphereLoop::begin_on_step()
{
	data.dt = 0;
	data.kick = scene.dt / 2;
	step();
	data.dt = data.kick = scene.dt;
}

void SphereLoop::advance(int rank, long n)
{
	for (long k = 0; k < n; ++k)
		if (!one_step(rank)) return;
}

/// False if the lists could not be made; every thread learns it behind the same barrier.
bool SphereLoop::one_step(int rank)
{
	if (state.selection_due && !update_lists(rank)) return false;
	kernel.early(data, shares[rank].view);
	team->barrier();
	add_incoming(rank);
	thread_beyond[rank] = kernel.sweep(data, shares[rank].view);
	team->barrier();
	if (rank == 0) finish();
	team->barrier();
	return true;
}

/// Forces that other threads computed on this one's rows come first: their owners lie before its blocks.
void SphereLoop::add_incoming(int rank)
{
	for (std::size_t e = 0; e < incoming[rank].size(); ++e) {
		SphereRow& row = state.rows[incoming_rows[rank][e]];
		const double* line = incoming[rank][e]->number;
		for (int k = 0; k < 3; ++k) row.force[k] -= line[2 + k], row.turn[k] += line[5 + k];
	}
}

void SphereLoop::collect_incoming(int rank)
{
	const bool for_held = rank == scene.threads;
	const std::uint32_t first = for_held ? state.n_free : share_begin[rank] * grains_per_block;
	const std::uint32_t end = for_held ? state.n : std::min(share_begin[rank + 1] * grains_per_block, state.n_free);
	incoming[rank].clear(), incoming_rows[rank].clear();
	for (int from = 0; from < std::min(rank, scene.threads); ++from)
		for (std::size_t e = 0; e < shares[from].early_links.size(); ++e) {
			const std::uint32_t row = shares[from].early_links[e].second / sizeof(SphereRow);
			if (row < first || row >= end) continue;
			incoming[rank].push_back(shares[from].view.early_forces + e);
			incoming_rows[rank].push_back(row);
		}
}

void SphereLoop::finish()
{
	move_held();
	for (const char beyond : thread_beyond) state.selection_due |= beyond != 0;
	++state.steps;
}

/// Held spheres keep the forces of the step in their rows until the next.
void SphereLoop::move_held()
{
	double fastest = 0;
	for (std::uint32_t at = state.n_free; at < state.n; ++at) {
		SphereRow& row = state.rows[at];
		double square = 0;
		for (int k = 0; k < 3; ++k) {
			row.force[k] = row.turn[k] = 0;
			row.x[k] += row.v[k] * data.drift;
			square += row.v[k] * row.v[k];
		}
		fastest = std::max(fastest, square);
	}
	add_incoming(scene.threads);
	double& way = state.travelled[state.n_blocks()];
	way += std::sqrt(fastest) * data.drift;
	state.selection_due |= way > state.allowed[state.n_blocks()];
}

Sphere SphereLoop::sphere(std::size_t index) const
{
	const SphereRow& row = state.rows[row_of[index]];
	Sphere s = scene.spheres[index];
	s.x = { row.x[0], row.x[1], row.x[2] };
	s.v = { row.v[0], row.v[1], row.v[2] };
	s.spin = Vector3r(row.surface[0], row.surface[1], row.surface[2]) / row.radius;
	return s;
}

Vector3r SphereLoop::force_on_held(std::size_t index) const
{
	const SphereRow& row = state.rows[row_of[index]];
	return { row.force[0], row.force[1], row.force[2] };
}

Vector3r SphereLoop::torque_on_held(std::size_t index) const
{
	const SphereRow& row = state.rows[row_of[index]];
	return row.radius * Vector3r(row.turn[0], row.turn[1], row.turn[2]);
}

std::vector<SphereContact> SphereLoop::springs() const
{
	std::vector<SphereContact> all;
	for (const SpherePairs& share : shares)
		share.each_pair(state, [&](std::uint32_t owner, std::uint32_t, const KeptPair& pair) {
			const Vector3r spring(pair.spring[0], pair.spring[1], pair.spring[2]);
			if (spring != Vector3r::Zero()) all.push_back({ state.index_of[owner], state.index_of[pair.partner], spring });
		});
	return all;
}

double SphereLoop::kinetic_energy() const
{
	double energy = 0;
	for (std::size_t i = 0; i < size(); ++i) {  // in the scene's order, so that the sum's bits do not depend on the sorting
		if (scene.spheres[i].held) continue;
		const SphereRow& row = state.rows[row_of[i]];
		double slide = 0, turn = 0;
		for (int k = 0; k < 3; ++k) slide += row.v[k] * row.v[k], turn += row.surface[k] * row.surface[k];
		energy += scene.spheres[i].mass / 2 * (slide + turn / sphere_response);
	}
	return energy;
}

/// The forces of the next step over half a kick, and everything back as it was.
double SphereLoop::kinetic_energy_on_step()
{
	const SphereState before = keep_state();
	data.kick = scene.dt / 2;
	data.drift = 0;
	step();
	data.kick = data.drift = scene.dt;
	const double energy = kinetic_energy();
	take_state(before);
	return energy;
}

}  // namespace graindrive::loop
