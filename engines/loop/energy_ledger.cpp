/// Enters the contacts and motions of each step in the ledger.
#include "engines/loop/energy_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graindrive::loop {

namespace {

double booked(Halves now, double& pending) { return std::exchange(pending, now.after) + now.before; }

}  // namespace

/// Sums over all contacts, for one step.
template <int D>
struct EnergyLedger<D>::Sums {
	double elastic_normal = 0, elastic_tangential = 0;  // energies at the step
	Halves normal_damping, tangential_damping, cell;
	double friction = 0, opening = 0, stiffening = 0;
	double elastic_work = 0;  // work of the normal springs on the grains
	double turning = 0;       // difference of the tangential work because the contact turned
};

/// Turns the tangential vectors of `before` into the plane across the new normal n.
template <int D>
typename EnergyLedger<D>::Past EnergyLedger<D>::turned(Past before, const Vec<D>& n)
{
	for (Tangent<D>* vector : { &before.spring_force, &before.slip, &before.moved_after })
		*vector = turned_along(*vector, before.n, n);
	before.n = n;
	return before;
}

template <int D>
typename EnergyLedger<D>::Past EnergyLedger<D>::meet(const MetContact<D>& c, const Past& before, Sums& sums) const
{
	const laws::Squeezed<Real> squeezed{ c.overlap, c.effective_radius, c.effective_mass };
	const laws::Terms<Real> terms = std::visit([&](const auto& l) { return l.terms(squeezed); }, law);
	const double half = dt / 2;
	const double normal_dashpot = terms.dashpot * c.v_n_before;
	sums.elastic_normal += terms.energy;
	sums.elastic_work += before.elastic_after + terms.elastic * c.v_n_before * half;
	sums.normal_damping.before += normal_dashpot * c.v_n_before * half;
	sums.normal_damping.after += normal_dashpot * c.v_n_after * half;
	Past next{ c.key, c.n, {}, 0, {}, {}, terms.elastic * c.v_n_after * half };
	const auto book_cell = [&](const Tangent<D>& tangential) {
		const Vec<D> force = force_on_first(c.n, terms.elastic - normal_dashpot, tangential);
		sums.cell.before += geometry::dot(force, c.image_before) * half;
		sums.cell.after += geometry::dot(force, c.image_after) * half;
	};
	if (!with_friction) {
		book_cell({});
		return next;
	}

	const auto contact = kinematics<D>(
		{ c.n, c.overlap }, RelativeMotion<D>{ c.v_n_before, c.v_t_before }, c.effective_radius, c.effective_mass, dt);
	const auto response = std::visit([&](const auto& l) { return answer_of(l(contact, for_law(c.slip_before))); }, law);
	book_cell(response.tangential);
	const Tangent<D> dashpot = response.slipping ? Tangent<D>{} : terms.tangential_dashpot * c.v_t_before;
	next.spring_force = -response.tangential - dashpot;
	next.stiffness = terms.tangential_stiffness;
	next.slip = response.slip;
	next.moved_after = c.v_t_after * dt;
	const Tangent<D> moved = c.v_t_before * dt;
	const Tangent<D> stretched = before.stiffness * before.slip + next.stiffness * next.slip;
	sums.elastic_tangential += std::visit([&](const auto& l) { return tangential_energy(l, terms, for_law(next.slip)); }, law);
	sums.tangential_damping.before += inner(dashpot, c.v_t_before) * half;
	sums.tangential_damping.after += inner(dashpot, c.v_t_after) * half;
	sums.friction +=
		inner(0.5 * (before.spring_force + next.spring_force), moved) - inner(0.5 * stretched, next.slip - c.slip_before);
	sums.stiffening += inner(0.5 * before.slip, next.slip) * (next.stiffness - before.stiffness);
	sums.turning += inner(0.5 * before.spring_force, moved - before.moved_after);
	return next;
}

template <int D>
void EnergyLedger<D>::part(const Past& before, Sums& sums) const
{
	sums.elastic_work += before.elastic_after;
	sums.friction += inner(0.5 * before.spring_force, before.moved_after);
	sums.opening += inner(0.5 * before.stiffness * before.slip, before.slip);
}

template <int D>
void EnergyLedger<D>::book(std::vector<MetContact<D>>& contacts, const LedgerMotion& motion)
{
	std::sort(contacts.begin(), contacts.end(), [](const MetContact<D>& a, const MetContact<D>& b) { return a.key < b.key; });
	Sums sums;
	std::vector<Past> next;
	next.reserve(contacts.size());
	auto old = past.begin();
	for (MetContact<D>& c : contacts) {
		for (; old != past.end() && old->key < c.key; ++old) part(*old, sums);
		const bool lasting = old != past.end() && old->key == c.key;
		if (lasting) c.slip_before = turned_along(c.slip_before, old->n, c.n);
		next.push_back(meet(c, lasting ? turned(*old, c.n) : Past{}, sums));
		old += lasting;
	}
	for (; old != past.end(); ++old) part(*old, sums);
	past.swap(next);

	const bool opening_the_books = steps++ == 0;
	const double normal_damping = booked(sums.normal_damping, pending.normal_damping),
				 tangential_damping = booked(sums.tangential_damping, pending.tangential_damping),
				 falling = booked(motion.falling, pending.falling), walls = booked(motion.walls, pending.walls),
				 loads = booked(motion.loads, pending.loads),
				 cell = booked({ motion.cell.before + sums.cell.before, motion.cell.after + sums.cell.after }, pending.cell);
	body_work.resize(motion.bodies.size());
	pending_bodies.resize(motion.bodies.size());
	std::vector<double> bodies(motion.bodies.size());
	for (std::size_t b = 0; b < bodies.size(); ++b) bodies[b] = booked(motion.bodies[b], pending_bodies[b]);

	const Energies last = now;
	const auto enter = [&](double& entry, double value) {
		if (!opening_the_books) now.turnover += std::abs(value - entry);
		entry = value;
	};
	if (!opening_the_books) fallen += falling;
	enter(now.translation, motion.translation), enter(now.rotation, motion.rotation);
	enter(now.potential, motion.potential + fallen);
	enter(now.elastic_normal, sums.elastic_normal), enter(now.elastic_tangential, sums.elastic_tangential);
	if (opening_the_books) {
		now.initial = now.stored();
		return;
	}
	enter(now.normal_damping, now.normal_damping + normal_damping);
	enter(now.tangential_damping, now.tangential_damping + tangential_damping);
	enter(now.friction, now.friction + sums.friction), enter(now.opening, now.opening + sums.opening);
	enter(now.stiffening, now.stiffening + sums.stiffening);
	enter(now.work_of_walls, now.work_of_walls + walls), enter(now.work_of_loads, now.work_of_loads + loads);
	enter(now.work_of_cell, now.work_of_cell + cell);
	for (std::size_t b = 0; b < bodies.size(); ++b) {
		body_work[b] += bodies[b];
		now.work_of_bodies += bodies[b];
		now.turnover += std::abs(bodies[b]);
	}
	now.time_step += now.elastic_normal - last.elastic_normal + sums.elastic_work + sums.turning;
}

template class EnergyLedger<2>;
template class EnergyLedger<3>;

}  // namespace graindrive::loop
