/// What others may look at: grains in the order they were given, contacts, energies.
#include <cmath>

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

namespace {

/// n from the owner to its partner, from F = -F_n n + F_t (z x n) on the owner.
Vector2r normal_of(const PairForce<double>& f)
{
	const double square = f.normal * f.normal + f.friction * f.friction;
	return Vector2r(f.friction * f.y - f.normal * f.x, -f.friction * f.x - f.normal * f.y) / square;
}

}  // namespace

/// |F_t| / |F_n| from which a contact counts as slipping, less the round-off of its precision.
double Stepper::slipping_bound() const
{
	const double mu = std::visit([](const auto& law) { return law.mu; }, scene.law);
	return scene.friction && mu > 0 ? mu * (scene.precision == Precision::single ? 1 - 1e-5 : 1 - 1e-12) : HUGE_VAL;
}

std::vector<Contact> Stepper::contacts() const
{
	std::vector<Contact> found;
	const double bound = slipping_bound();
	for (std::uint32_t c = 0; c < pairs.place.size(); ++c) {
		const PairForce<double> f = pairs.force(c);
		if (f.normal == 0 && f.friction == 0) continue;
		const Candidate& pair = pairs.candidates[c];
		const GrainRow &a = rows[pair.first], &b = rows[pair.second];
		const Separation d = separation(a, b, scene.box);
		const Vector2r n = normal_of(f);
		found.push_back({ index_of[pair.first], index_of[pair.second], n[0], n[1], a.x + a.radius * n[0], a.y + a.radius * n[1],
			f.normal, f.friction, a.radius + b.radius - std::hypot(d.x, d.y), pairs.slip(c),
			std::abs(f.friction) >= bound * std::abs(f.normal) });
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

/// What computing forces early has lengthened or set goes back, so that the loop can be saved and the step begins anew.
Stepper::Sight Stepper::look_between_steps()
{
	if (body_forces_known) return { present_contacts(), wall_contacts() };
	if (selection_due) select();  // as the step would, from the same positions
	const auto bodies_before = scene.bodies;
	const auto walls_before = scene.walls;
	const auto touches_before = wall_touches;
	const double moved_walls = moved_near_walls;
	std::vector<double> slips(pairs.place.size());
	for (std::uint32_t c = 0; c < slips.size(); ++c) slips[c] = pairs.place[c] ? pairs.slip(c) : 0;
	const Sight sight{ present_contacts(), wall_contacts() };
	for (std::uint32_t c = 0; c < slips.size(); ++c)
		if (pairs.place[c]) pairs.candidates[c].slip = slips[c];
	pairs.put_back_slips();
	scene.bodies = bodies_before;
	scene.walls = walls_before;
	wall_touches = touches_before;
	moved_near_walls = moved_walls;
	body_forces_known = false;
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

void Stepper::touches_on(std::size_t b, std::vector<Touch>& touches) const
{
	const double bound = slipping_bound();
	const RigidBody& body = scene.bodies[b];
	const double c = std::cos(body.angle), s = std::sin(body.angle);
	for (std::uint32_t m = body_members[b]; m < body_members[b + 1]; ++m) {
		const GrainRow& row = rows[n_free + m];
		for (std::uint32_t k = pairs.member_begin[m]; k < pairs.member_begin[m + 1]; ++k) {
			const PairList::Share share = pairs.member_shares[k];
			const PairForce<double> f = pairs.force(share.candidate);
			if (f.normal == 0 && f.friction == 0) continue;
			const Candidate& pair = pairs.candidates[share.candidate];
			const Vector2r n = share.partner ? Vector2r(-normal_of(f)) : normal_of(f);  // F_t along z x n turns round with n
			touches.push_back({ index_of[n_free + m], index_of[share.partner ? pair.first : pair.second],
				c * members[m].x - s * members[m].y + row.radius * n[0], s * members[m].x + c * members[m].y + row.radius * n[1],
				n[0], n[1], f.normal, f.friction, std::abs(f.friction) >= bound * std::abs(f.normal) });
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
