/// What others may look at: grains in the order they were given, contacts, energies.
#include <algorithm>
#include <cmath>

#include "engines/loop/pair_geometry.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

Grain Stepper::grain(std::size_t index) const
{
	const GrainRow& row = rows[row_of[index]];
	return { row.x, row.y, row.vx, row.vy, row.surface_speed / row.radius, row.radius, scene.grains[index].mass,
		scene.grains[index].body };
}

Vector2r Stepper::arm(std::size_t index) const
{
	const Member& member = members.at(row_of[index] - n_free);
	const double angle = scene.bodies[member.body].angle, c = std::cos(angle), s = std::sin(angle);
	return { c * member.x - s * member.y, s * member.x + c * member.y };
}

void Stepper::positions(double* xy) const
{
	for (std::size_t i = 0; i < size(); ++i) {
		xy[2 * i] = rows[row_of[i]].x;
		xy[2 * i + 1] = rows[row_of[i]].y;
	}
}

void Stepper::velocities(double* xy) const
{
	for (std::size_t i = 0; i < size(); ++i) {
		xy[2 * i] = rows[row_of[i]].vx;
		xy[2 * i + 1] = rows[row_of[i]].vy;
	}
}

void Stepper::spins(double* spin) const
{
	for (std::size_t i = 0; i < size(); ++i) spin[i] = rows[row_of[i]].surface_speed / rows[row_of[i]].radius;
}

/// True where forces act half an overlap below the surface; without friction it makes no difference.
bool Stepper::at_contact_point() const
{
	return scene.friction && std::visit([](const auto& law) { return law.acts_at_contact_point; }, scene.law);
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
	const bool is_force = std::visit([](const auto& law) { return law.remembers_force; }, scene.law);
	return std::abs(is_force ? remembered : force.friction) >= slipping_bound() * std::abs(force.normal);
}

/// |F_t| / |F_n| from which a contact counts as slipping, less the round-off of its precision.
double Stepper::slipping_bound() const
{
	const double mu = std::visit([](const auto& law) { return law.mu; }, scene.law);
	return scene.friction && mu > 0 ? mu * (scene.precision == Precision::single ? 1 - 1e-5 : 1 - 1e-12) : HUGE_VAL;
}

std::vector<Contact> Stepper::contacts() const
{
	std::vector<Contact> found;
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) {
		const ForceParts f = parts(pairs.force(c));
		if (f.normal == 0 && f.friction == 0) continue;
		const Candidate& pair = pairs.candidates[c];
		const GrainRow& a = rows[pair.first];
		const double overlap = overlap_of(pair), slip = pairs.slip(c);
		found.push_back({ index_of[pair.first], index_of[pair.second], f.n_x, f.n_y, a.x + a.radius * f.n_x,
			a.y + a.radius * f.n_y, f.normal, f.friction, overlap, slip, slips(f, slip) });
	}
	return found;
}

/// The kernels compute all pairs once more than steps need; springs, which they lengthen, are put back.
std::vector<Contact> Stepper::present_contacts()
{
	const bool was_under_way = body_forces_known;
	compute_body_forces();
	pairs.keep_slips();
	for (const SweepRange& sweep : pairs.sweeps) kernel.pairs(data, sweep.pair_begin, sweep.pair_end, false);
	std::vector<Contact> found = contacts();
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
			found.push_back({ index_of[pairs.candidates[c].first], index_of[pairs.candidates[c].second], slip });
	return found;
}

double Stepper::overlap_of(const Candidate& pair) const
{
	return placement(rows[pair.first], rows[pair.second], scene.box).overlap;
}

void Stepper::touches_on(std::size_t b, std::vector<Touch>& touches) const
{
	const RigidBody& body = scene.bodies[b];
	const double c = std::cos(body.angle), s = std::sin(body.angle);
	for (std::uint32_t m = body_members[b]; m < body_members[b + 1]; ++m) {
		const GrainRow& row = rows[n_free + m];
		for (std::uint32_t k = pairs.member_begin[m]; k < pairs.member_begin[m + 1]; ++k) {
			const PairList::Share share = pairs.member_shares[k];
			const ForceParts f = parts(pairs.force(share.candidate));
			if (f.normal == 0 && f.friction == 0) continue;
			const Candidate& pair = pairs.candidates[share.candidate];
			const double side = share.partner ? -1 : 1, n_x = side * f.n_x,
						 n_y = side * f.n_y;  // F_t along z x n turns round with n
			const double lever = at_contact_point() ? row.radius - overlap_of(pair) / 2 : row.radius;
			touches.push_back({ index_of[n_free + m], index_of[share.partner ? pair.first : pair.second],
				c * members[m].x - s * members[m].y + lever * n_x, s * members[m].x + c * members[m].y + lever * n_y, n_x, n_y,
				f.normal, f.friction, slips(f, pairs.slip(share.candidate)) });
		}
	}
	if (!wall_touches.empty()) append_wall_touches(b, touches);
}

double Stepper::kinetic_energy() const
{
	double energy = 0;
	for (std::uint32_t i = 0; i < n_free; ++i) {
		const GrainRow& row = rows[i];
		const double spinning = row.surface_speed * row.surface_speed / scene.spin_response;
		energy += 0.5 / row.inverse_mass * (row.vx * row.vx + row.vy * row.vy + spinning);
	}
	return energy;
}

/// A trial step with half a kick, after which everything is as it was, whatever a guard says on the way.
double Stepper::kinetic_energy_on_step()
{
	take_back_body_forces();
	if (selection_due) select();  // not in the step that is undone: it may sort the rows
	pairs.keep_slips();
	const AlignedVector<GrainRow> before = rows;
	std::unique_ptr<Books> aside(nullptr);
	aside.swap(books);  // a trial step is no business
	const auto bodies_before = scene.bodies;
	const auto walls_before = scene.walls;
	const auto touches_before = wall_touches;
	const auto travelled_before = travelled;
	const long steps_before = steps;
	const double moved_walls = moved_near_walls;
	const bool due_before = selection_due;
	std::exception_ptr refusal;
	data.kick = 0.5 * scene.dt;
	data.drift = 0;
	try {
		step(1);
	} catch (...) {
		refusal = std::current_exception();
	}
	const double energy = kinetic_energy();
	data.kick = data.drift = scene.dt;
	rows = before;
	data.rows = rows.data();
	travelled = travelled_before, selection_due = due_before;
	data.travelled = travelled.data();
	scene.bodies = bodies_before;
	scene.walls = walls_before;
	wall_touches = touches_before;
	steps = steps_before;
	moved_near_walls = moved_walls;
	body_forces_known = false;
	pairs.put_back_slips();
	books.swap(aside);
	if (refusal) std::rethrow_exception(refusal);
	return energy;
}

void Stepper::begin_on_step()
{
	if (books) throw std::runtime_error("begin on the step first, then track energy");
	data.dt = 0;
	data.kick = 0.5 * scene.dt;
	step(1);
	data.dt = data.kick = scene.dt;
}

}  // namespace graindrive::loop
