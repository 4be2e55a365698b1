/// Books contacts and motion of one step after the other.
#include "engines/loop/energy_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graindrive::loop {

namespace {

double booked(Halves now, double& pending) { return std::exchange(pending, now.after) + now.before; }

}  // namespace

/// Of one interval, over all contacts.
struct EnergyLedger::Sums {
	double elastic_normal = 0, elastic_tangential = 0;  // energies at the step
	Halves normal_damping, tangential_damping;
	double friction = 0, opening = 0, stiffening = 0;
	double elastic_work = 0;  // of the normal springs on the grains
	double turning = 0;       // tangential work that differs because the contact turned
};

EnergyLedger::Past EnergyLedger::meet(const MetContact& c, const Past& before, Sums& sums) const
{
	const laws::Squeezed<Real> squeezed{ c.overlap, c.effective_radius, c.effective_mass };
	const laws::Terms<Real> terms = std::visit([&](const auto& l) { return l.terms(squeezed); }, law);
	const double half = dt / 2;
	const double normal_dashpot = terms.dashpot * c.v_n_before;
	sums.elastic_normal += terms.energy;
	sums.elastic_work += before.elastic_after + terms.elastic * c.v_n_before * half;
	sums.normal_damping.before += normal_dashpot * c.v_n_before * half;
	sums.normal_damping.after += normal_dashpot * c.v_n_after * half;
	Past next{ c.key, 0, 0, 0, 0, terms.elastic * c.v_n_after * half };
	if (!with_friction) return next;

	const laws::Kinematics<Real, Real> contact{ c.overlap, c.v_n_before, c.v_t_before, c.effective_radius, c.effective_mass, dt };
	const auto response = std::visit([&](const auto& l) { return l(contact, c.slip_before); }, law);
	const double dashpot = response.slipping ? 0 : terms.tangential_dashpot * c.v_t_before;
	next.spring_force = -response.tangential - dashpot;
	next.stiffness = terms.tangential_stiffness;
	next.slip = response.slip;
	next.moved_after = c.v_t_after * dt;
	const double moved = c.v_t_before * dt;
	const double stretched = before.stiffness * before.slip + next.stiffness * next.slip;
	sums.elastic_tangential += std::visit([&](const auto& l) { return tangential_energy(l, terms, next.slip); }, law);
	sums.tangential_damping.before += dashpot * c.v_t_before * half;
	sums.tangential_damping.after += dashpot * c.v_t_after * half;
	sums.friction += 0.5 * (before.spring_force + next.spring_force) * moved - 0.5 * stretched * (next.slip - c.slip_before);
	sums.stiffening += 0.5 * before.slip * next.slip * (next.stiffness - before.stiffness);
	sums.turning += 0.5 * before.spring_force * (moved - before.moved_after);
	return next;
}

void EnergyLedger::part(const Past& before, Sums& sums) const
{
	sums.elastic_work += before.elastic_after;
	sums.friction += 0.5 * before.spring_force * before.moved_after;
	sums.opening += 0.5 * before.stiffness * before.slip * before.slip;
}

void EnergyLedger::book(std::vector<MetContact>& contacts, const LedgerMotion& motion)
{
	std::sort(contacts.begin(), contacts.end(), [](const MetContact& a, const MetContact& b) { return a.key < b.key; });
	Sums sums;
	std::vector<Past> next;
	next.reserve(contacts.size());
	auto old = past.begin();
	for (const MetContact& c : contacts) {
		for (; old != past.end() && old->key < c.key; ++old) part(*old, sums);
		const bool lasting = old != past.end() && old->key == c.key;
		next.push_back(meet(c, lasting ? *old : Past{}, sums));
		old += lasting;
	}
	for (; old != past.end(); ++old) part(*old, sums);
	past.swap(next);

	const bool opening_the_books = steps++ == 0;
	const double normal_damping = booked(sums.normal_damping, pending.normal_damping),
				 tangential_damping = booked(sums.tangential_damping, pending.tangential_damping),
				 falling = booked(motion.falling, pending.falling), walls = booked(motion.walls, pending.walls),
				 loads = booked(motion.loads, pending.loads);
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
	for (std::size_t b = 0; b < bodies.size(); ++b) {
		body_work[b] += bodies[b];
		now.work_of_bodies += bodies[b];
		now.turnover += std::abs(bodies[b]);
	}
	now.time_step += now.elastic_normal - last.elastic_normal + sums.elastic_work + sums.turning;
}

}  // namespace graindrive::loop
