/// What others may look at: grains in the order they were given, contacts, energies.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engines/loop/pair_geometry.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

Grain Stepper::grain(std::size_t index) const
{
	const GrainRow& row = state.rows[row_of[index]];
	return { row.x, row.y, row.vx, row.vy, row.surface_speed / row.radius, row.radius, state.scene.grains[index].mass,
		state.scene.grains[index].body };
}

Vector2r Stepper::arm(std::size_t index) const
{
	const Member& member = state.members.at(row_of[index] - n_free);
	const double angle = state.scene.bodies[member.body].angle, c = std::cos(angle), s = std::sin(angle);
	return { c * member.x - s * member.y, s * member.x + c * member.y };
}

void Stepper::positions(double* xy) const
{
	for (std::size_t i = 0; i < size(); ++i) {
		xy[2 * i] = state.rows[row_of[i]].x;
		xy[2 * i + 1] = state.rows[row_of[i]].y;
	}
}

void Stepper::velocities(double* xy) const
{
	for (std::size_t i = 0; i < size(); ++i) {
		xy[2 * i] = state.rows[row_of[i]].vx;
		xy[2 * i + 1] = state.rows[row_of[i]].vy;
	}
}

void Stepper::spins(double* spin) const
{
	for (std::size_t i = 0; i < size(); ++i) spin[i] = state.rows[row_of[i]].surface_speed / state.rows[row_of[i]].radius;
}

/// True where forces act half an overlap below the surface; without friction it makes no difference.
bool Stepper::at_contact_point() const
{
	return state.scene.friction && std::visit([](const auto& law) { return law.acts_at_contact_point; }, state.scene.law);
}

/// The laws that act at the contact point store a torque in the place of F_n; they never pull, so F_n follows from the whole.
ForceParts Stepper::parts(const PairForce<double>& f) const
{
	const double friction = f.friction;
	const double normal = at_contact_point() ? std::sqrt(std::max(f.x * f.x + f.y * f.y - friction * friction, 0.0)) : f.normal;
	const double square = normal * normal + friction * friction;
	if (square == 0) return { 0, 0, 0, 0 };
	return { normal, friction, (friction * f.y - normal * f.x) / square, (-friction * f.x - normal * f.y) / square };
}

/// What a law remembers as a force is what it holds to Coulomb's bound: a dashpot comes on top of it.
bool Stepper::slips(const ForceParts& force, double remembered) const
{
	const bool is_force = std::visit([](const auto& law) { return law.remembers_force; }, state.scene.law);
	return std::abs(is_force ? remembered : force.friction) >= slipping_bound() * std::abs(force.normal);
}

/// |F_t| / |F_n| from which a contact counts as slipping, less the round-off of its precision.
double Stepper::slipping_bound() const
{
	const double mu = std::visit([](const auto& law) { return law.mu; }, state.scene.law);
	return state.scene.friction && mu > 0 ? mu * (state.scene.precision == Precision::single ? 1 - 1e-5 : 1 - 1e-12) : HUGE_VAL;
}

std::vector<Contact> Stepper::contacts()
{
	return body_forces_known || laid_out_since_forces ? present_contacts() : contacts_in_memory();
}

std::vector<Contact> Stepper::contacts_in_memory() const
{
	std::vector<Contact> found;
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) {
		const ForceParts f = parts(pairs.force(c));
		if (f.normal == 0 && f.friction == 0) continue;
		const Candidate& pair = state.candidates[c];
		const GrainRow a = row_before(moved_since_forces(c), pair.first);
		const double overlap = overlap_at_forces(c), slip = pairs.slip(c);
		found.push_back({ state.index_of[pair.first], state.index_of[pair.second], f.n_x, f.n_y, a.x + a.radius * f.n_x,
			a.y + a.radius * f.n_y, f.normal, f.friction, overlap, slip, slips(f, slip) });
	}
	return found;
}

/// The kernels compute all pairs once more than steps need; forces and springs that stood in memory are put back.
std::vector<Contact> Stepper::present_contacts()
{
	const bool was_under_way = body_forces_known;
	compute_body_forces();
	pairs.keep_slips();
	const PairList::Bytes forces = pairs.forces_in_memory();
	for (const SweepRange& sweep : pairs.sweeps) kernel.pairs(data, sweep.pair_begin, sweep.pair_end, false);
	const double moved = std::exchange(drifted, 0);
	std::vector<Contact> found = contacts_in_memory();
	drifted = moved;
	pairs.put_back_forces(forces);
	pairs.put_back_slips();
	if (!was_under_way) take_back_body_forces();  // who looks leaves no trace
	return found;
}

Stepper::Sight Stepper::look_between_steps()
{
	const bool was_under_way = body_forces_known;
	compute_body_forces();
	const Sight sight{ present_contacts(), wall_contacts() };
	if (!was_under_way) take_back_body_forces();  // so that the loop can be saved and the step begins anew
	return sight;
}

std::vector<Spring> Stepper::springs() const
{
	std::vector<Spring> found;
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c)
		if (const double slip = pairs.slip(c); slip != 0)
			found.push_back({ state.index_of[state.candidates[c].first], state.index_of[state.candidates[c].second], slip });
	return found;
}

/// A grain where it was that long ago, within the last step: x_n = x_{n+1} - v_{n+1/2} dt, members with their body.
GrainRow Stepper::row_before(double time, std::uint32_t at) const
{
	GrainRow row = state.rows[at];
	if (time == 0) return row;
	if (at < n_free) {
		row.x -= row.vx * time, row.y -= row.vy * time;
		return row;
	}
	const Member& member = state.members[at - n_free];
	const RigidBody& body = state.scene.bodies[member.body];
	if (state.body_fixed[member.body]) return row;
	const double angle = body.angle - body.spin * time, c = std::cos(angle), s = std::sin(angle);
	row.x = body.x - body.vx * time + (c * member.x - s * member.y) + member.shift_x;
	row.y = body.y - body.vy * time + (s * member.x + c * member.y) + member.shift_y;
	return row;
}

/// Time since the forces of a pair that stand in memory were computed [s].
double Stepper::moved_since_forces(std::uint32_t candidate) const
{
	return body_forces_known && pairs.is_early(candidate) ? 0 : drifted;
}

double Stepper::overlap_at_forces(std::uint32_t candidate) const
{
	const Candidate& pair = state.candidates[candidate];
	const double moved = moved_since_forces(candidate);
	const GrainRow a = row_before(moved, pair.first), b = row_before(moved, pair.second);
	return placement(a, b, state.scene.box).overlap;
}

void Stepper::touches_on(std::size_t b, std::vector<Touch>& touches) const
{
	const RigidBody& body = state.scene.bodies[b];
	const double c = std::cos(body.angle), s = std::sin(body.angle);
	for (std::uint32_t m = body_members[b]; m < body_members[b + 1]; ++m) {
		const GrainRow& row = state.rows[n_free + m];
		for (std::uint32_t k = pairs.member_begin[m]; k < pairs.member_begin[m + 1]; ++k) {
			const PairList::Share share = pairs.member_shares[k];
			const ForceParts f = parts(pairs.force(share.candidate));
			if (f.normal == 0 && f.friction == 0) continue;
			const Candidate& pair = state.candidates[share.candidate];
			const double side = share.partner ? -1 : 1, n_x = side * f.n_x,
						 n_y = side * f.n_y;  // F_t along z x n turns round with n
			const double lever = at_contact_point() ? row.radius - overlap_at_forces(share.candidate) / 2 : row.radius;
			touches.push_back({ state.index_of[n_free + m], state.index_of[share.partner ? pair.first : pair.second],
				c * state.members[m].x - s * state.members[m].y + lever * n_x,
				s * state.members[m].x + c * state.members[m].y + lever * n_y, n_x, n_y, f.normal, f.friction,
				slips(f, pairs.slip(share.candidate)) });
		}
	}
	if (!state.wall_touches.empty()) append_wall_touches(b, touches);
}

double Stepper::kinetic_energy() const
{
	double energy = 0;
	for (std::uint32_t i = 0; i < n_free; ++i) {
		const GrainRow& row = state.rows[i];
		const double spinning = row.surface_speed * row.surface_speed / state.scene.spin_response;
		energy += 0.5 / row.inverse_mass * (row.vx * row.vx + row.vy * row.vy + spinning);
	}
	return energy;
}

/// Back to a state of the same selection: pairs lie where they lay.
void Stepper::go_back_to(const State& before)
{
	state = before;
	point_at_lists();
	pairs.put_back_slips();
	body_forces_known = false;
}

/// A trial step with half a kick, after which everything is as it was, whatever a guard says on the way.
double Stepper::kinetic_energy_on_step()
{
	take_back_body_forces();
	if (state.selection_due) select();  // not in the step that is undone: it may sort the rows
	const State before = snapshot();
	std::unique_ptr<Books> aside(nullptr);
	aside.swap(books);  // a trial step is no business
	std::exception_ptr refusal;
	try {
		half_step(state.scene.dt, 0);
	} catch (...) {
		refusal = std::current_exception();
	}
	const double energy = kinetic_energy();
	go_back_to(before);
	books.swap(aside);
	if (refusal) std::rethrow_exception(refusal);
	return energy;
}

void Stepper::begin_on_step()
{
	if (books) throw std::runtime_error("begin on the step first, then track energy");
	half_step(0, state.scene.dt);
}

/// A step with half a kick; springs grow and grains drift for other times than dt.
void Stepper::half_step(double spring_time, double drift)
{
	struct WholeStepsAgain {
		KernelData& data;
		double dt;
		~WholeStepsAgain() { data.dt = data.kick = data.drift = dt; }
	} again{ data, state.scene.dt };
	data.dt = spring_time;
	data.kick = 0.5 * state.scene.dt;
	data.drift = drift;
	step(1);
}

}  // namespace graindrive::loop
