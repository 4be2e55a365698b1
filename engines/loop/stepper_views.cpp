/// Grains in the order in which they were given, contacts and energies, for code outside the loop.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

namespace {

void store(double*& to, double number) { *to++ = number; }
template <int D>
void store(double*& to, const Vec<D>& v)
{
	for (int k = 0; k < D; ++k) *to++ = v[k];
}

}  // namespace

template <>
double Stepper<2>::moved_since_forces(std::uint32_t candidate) const;
template <>
double Stepper<2>::overlap_at_forces(std::uint32_t candidate) const;

template <int D>
Grain<D> Stepper<D>::grain(std::size_t index) const
{
	const Row<D>& row = state.rows[state.row_of[index]];
	const Grain<D>& given = state.scene.grains[index];
	return { row.x, row.v, row.surface / row.radius, row.radius, given.mass, given.body };
}

template <int D>
Vec<D> Stepper<D>::arm(std::size_t index) const
{
	return rigid.arm(state.row_of[index]);
}

template <int D>
void Stepper<D>::positions(double* to) const
{
	for (std::size_t i = 0; i < size(); ++i) store(to, state.rows[state.row_of[i]].x);
}

template <int D>
void Stepper<D>::velocities(double* to) const
{
	for (std::size_t i = 0; i < size(); ++i) store(to, state.rows[state.row_of[i]].v);
}

template <int D>
void Stepper<D>::spins(double* to) const
{
	for (std::size_t i = 0; i < size(); ++i) {
		const Row<D>& row = state.rows[state.row_of[i]];
		store(to, row.surface / row.radius);
	}
}

/// True if the contact slips. Laws that store a force apply Coulomb's bound to this force only, not to the dashpot's force.
template <int D>
bool Stepper<D>::slips(const ForceParts<D>& force, const Tangent<D>& remembered) const
{
	const bool is_force = std::visit([](const auto& law) { return law.remembers_force; }, state.scene.law);
	return length(is_force ? remembered : force.friction) >= slipping_bound() * std::abs(force.normal);
}

/// The ratio |F_t| / |F_n| from which a contact counts as slipping: the friction coefficient less a round-off.
template <int D>
double Stepper<D>::slipping_bound() const
{
	const double mu = std::visit([](const auto& law) { return law.mu; }, state.scene.law);
	return state.scene.friction && mu > 0 ? mu * (state.scene.precision == Precision::single ? 1 - 1e-5 : 1 - 1e-12) : HUGE_VAL;
}

template <int D>
std::vector<Contact<D>> Stepper<D>::contacts()
{
	if constexpr (D == 2)
		if (!body_forces_known && !laid_out_since_forces) return contacts_in_memory();
	return present_contacts();
}

template <>
std::vector<Contact<2>> Stepper<2>::contacts_in_memory() const
{
	std::vector<Contact<2>> found;
	pairs.each_selected([&](std::uint32_t first, std::uint32_t second, std::uint32_t c) {
		const ForceParts<2> f = pairs.parts(c);
		if (f.normal == 0 && f.friction == 0) return;
		const DiskRow a = row_before(moved_since_forces(c), first);
		const double slip = pairs.spring(c);
		found.push_back({ state.index_of[first], state.index_of[second], f.n, a.x + a.radius * f.n, f.normal, f.friction,
			overlap_at_forces(c), slip, slips(f, slip) });
	});
	return found;
}

/// The contact at the present positions, from the force on its owner.
template <>
Contact<3> Stepper<3>::contact_of(std::uint32_t first, std::uint32_t second, const Vec<3>& force, const Vec<3>& spring) const
{
	const SphereRow &a = state.rows[first], &b = state.rows[second];
	const Placement<3> at = placement<3>(a, b, state.scene.cell);
	const double normal = -geometry::dot(force, at.normal);
	const ForceParts<3> parts{ normal, force + normal * at.normal, at.normal };
	return { state.index_of[first], state.index_of[second], at.normal, a.x + a.radius * at.normal, normal, parts.friction,
		at.overlap, spring, slips(parts, spring) };
}

/// Computes all pairs at the present positions; afterwards forces and springs in memory are as before.
template <int D>
std::vector<Contact<D>> Stepper<D>::present_contacts()
{
	const bool was_under_way = body_forces_known;
	compute_body_forces();
	std::vector<Contact<D>> found;
	found.reserve(pairs.counts().selected);
	if constexpr (D == 2) {
		const double moved = std::exchange(drifted, 0);
		pairs.with_all_forces([&] { found = contacts_in_memory(); });
		drifted = moved;
	} else {
		take_back_body_forces();  // its springs are already those after this step
		pairs.each_force_now([&](std::uint32_t a, std::uint32_t b, const Vec<3>& force, const Vec<3>&, const Vec<3>& spring) {
			found.push_back(contact_of(a, b, force, spring));
		});
		if (was_under_way) compute_body_forces();
	}
	if (!was_under_way) take_back_body_forces();  // the state is as before
	return found;
}

template <int D>
typename Stepper<D>::Sight Stepper<D>::look_between_steps()
{
	const bool was_under_way = body_forces_known;
	compute_body_forces();
	const Sight sight{ present_contacts(), surface_contacts() };
	if (!was_under_way) take_back_body_forces();  // so that the loop can be saved and the step can start again
	return sight;
}

/// A grain's row at an earlier time within the last step: x_n = x_{n+1} - v_{n+1/2} dt; members move with their body.
template <int D>
Row<D> Stepper<D>::row_before(double time, std::uint32_t at) const
{
	Row<D> row = state.rows[at];
	if (time == 0) return row;
	if (at >= state.n_free) return rigid.member_before(time, at);
	row.x -= row.v * time;
	return row;
}

/// Time by which grains have moved since the pair's forces in memory were computed [s].
template <>
double Stepper<2>::moved_since_forces(std::uint32_t candidate) const
{
	return body_forces_known && pairs.is_early(candidate) ? 0 : drifted;
}

template <>
double Stepper<2>::overlap_at_forces(std::uint32_t candidate) const
{
	const Candidate& pair = state.pairs.candidates[candidate];
	const double moved = moved_since_forces(candidate);
	Cell<2> cell = state.scene.cell;
	if (moved != 0) cell.advance(-moved);
	return placement<2>(row_before(moved, pair.first), row_before(moved, pair.second), cell).overlap;
}

template <>
void Stepper<2>::touches_on(std::size_t b, std::vector<Touch<2>>& touches) const
{
	for (std::uint32_t m = state.first_member[b]; m < state.first_member[b + 1]; ++m) {
		const std::uint32_t at = state.n_free + m;
		pairs.each_pair_of_member(m, [&](std::uint32_t c, bool is_partner) {
			const ForceParts<2> f = pairs.parts(c);
			if (f.normal == 0 && f.friction == 0) return;
			const Candidate& pair = state.pairs.candidates[c];
			const Vec<2> n = (is_partner ? -1 : 1) * f.n;  // F_t is counted along z x n, which changes its sign with n
			const double radius = state.rows[at].radius,
						 lever = pairs.at_contact_point() ? radius - overlap_at_forces(c) / 2 : radius;
			touches.push_back({ state.index_of[at], state.index_of[is_partner ? pair.first : pair.second],
				rigid.arm(at) + lever * n, n, f.normal, f.friction, slips(f, pairs.spring(c)) });
		});
	}
	append_surface_touches(b, touches);
}

template <>
void Stepper<3>::touches_on(std::size_t b, std::vector<Touch<3>>& touches) const
{
	if (!body_forces_known) throw std::logic_error("contacts on a body of spheres are known only during a step");
	const std::uint32_t first = state.n_free + state.first_member[b], end = state.n_free + state.first_member[b + 1];
	const auto add = [&](std::uint32_t at, const Contact<3>& c, double side) {
		const Vec<3> n = side * c.n;
		touches.push_back({ state.index_of[at], side > 0 ? c.second : c.first, rigid.arm(at) + state.rows[at].radius * n, n,
			c.normal, side * c.friction, c.slipping });
	};
	if (first < end)
		pairs.each_early_force(
			[&](std::uint32_t owner, std::uint32_t partner, const Vec<3>& force, const Vec<3>&, const Vec<3>& spring) {
				const bool owns = owner >= first && owner < end, is_partner = partner >= first && partner < end;
				if (!owns && !is_partner) return;
				const Contact<3> contact = contact_of(owner, partner, force, spring);
				if (owns) add(owner, contact, 1);
				if (is_partner) add(partner, contact, -1);
			});
	append_surface_touches(b, touches);
}

template <int D>
std::vector<Contact<D>> Stepper<D>::surface_contacts() const
{
	std::vector<Contact<D>> found;
	const double bound = slipping_bound();
	for (const SurfaceTouch<D>& touch : state.touches) {
		if (!(touch.overlap > 0)) continue;
		const Row<D> row = row_before(body_forces_known ? 0 : drifted, state.row_of[touch.grain]);
		found.push_back({ touch.grain, touch.surface, touch.normal, row.x + row.radius * touch.normal, touch.pressing,
			touch.friction, touch.overlap, touch.slip, length(touch.friction) >= bound * std::abs(touch.pressing) });
	}
	return found;
}

template <int D>
void Stepper<D>::append_surface_touches(std::size_t b, std::vector<Touch<D>>& touches) const
{
	if (state.touches.empty()) return;
	const RigidBody<D>& body = state.scene.bodies[b];
	for (const Contact<D>& c : surface_contacts()) {
		if (state.scene.grains[c.first].body == static_cast<int>(b)) {
			const Member<D>& member = state.members[state.row_of[c.first] - state.n_free];
			touches.push_back({ c.first, std::uint32_t(size()) + c.second, c.point - member.shift - body.place, c.n, c.normal,
				c.friction, c.slipping });
		}
		if (surfaces.is_wall(c.second) || surfaces.solid(c.second).body != static_cast<int>(b)) continue;
		const Vec<D> point = c.point - (c.overlap / 2) * c.n;
		const Tangent<D> friction = D == 2 ? c.friction : -c.friction;  // counted along z x n, which changes its sign with n
		touches.push_back({ std::uint32_t(size()) + c.second, c.first,
			surfaces.seen_from_solid(c.second, body, point) - body.place, -c.n, c.normal, friction, c.slipping });
	}
}

template <int D>
double Stepper<D>::kinetic_energy() const
{
	double energy = 0;
	for (std::uint32_t i = 0; i < state.n_free; ++i) {
		const Row<D>& row = state.rows[i];
		double square = geometry::squared_norm(row.v);
		square += inner(row.surface, row.surface) / state.scene.spin_response;
		energy += 0.5 / state.inverse_mass(i) * square;
	}
	return energy;
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace graindrive::loop
