/// Lees-Edwards cells: grains move as in an unbounded sheared system wherever the cell's sides lie, and the energy ledger holds
/// the shear's work.
#include <gtest/gtest.h>

#include <set>

#include "engines/base/temporary_file.hpp"
#include "engines/loop/checkpoint.hpp"
#include "engines/loop/test_scenes.hpp"

namespace graindrive::loop {

using namespace test;

namespace {

Scene<2> sheared_crowd(int side, unsigned seed, double shear_rate, double offset = 0)
{
	Scene<2> s = crowd(side, seed, 0.5);
	s.cell.across = 1, s.cell.along = 0;
	s.cell.offset = offset, s.cell.rate = shear_rate * side;
	for (Grain<2>& g : s.grains) g.velocity[0] += shear_rate * g.place[1];
	return s;
}

/// An independent implementation: every grain against every image of every other, and no grain is wrapped.
struct PlainShear {
	Scene<2> s;
	Vec<2> image_velocity;                          // in the next step
	double offset, period;                          // not reduced; in y
	std::map<std::pair<long, long>, double> slips;  // by pair and layer of the second

	explicit PlainShear(const Scene<2>& scene)
		: s(scene),
		  image_velocity(scene.cell.image_velocity()),
		  offset(scene.cell.offset),
		  period(scene.cell.length(1))
	{
	}

	void step()
	{
		const std::size_t n = s.grains.size();
		std::vector<Vec<2>> force(n);
		std::vector<double> torque(n, 0);
		for (std::size_t i = 0; i < n; ++i)
			for (std::size_t j = i + 1; j < n; ++j) pair(i, j, force, torque);
		const Vec<2> gained = image_velocity - s.cell.image_velocity();
		for (std::size_t i = 0; i < n; ++i) {
			Grain<2>& g = s.grains[i];
			g.velocity += force[i] / g.mass * s.dt + (g.place[1] / period) * gained;
			g.spin += torque[i] / (g.mass * g.radius * g.radius / 2) * s.dt;
			g.place += g.velocity * s.dt;
		}
		s.cell.set_image_velocity(image_velocity);
		offset += image_velocity[0] * s.dt, period += image_velocity[1] * s.dt;
	}

	void pair(std::size_t i, std::size_t j, std::vector<Vec<2>>& force, std::vector<double>& torque)
	{
		const Grain<2>&a = s.grains[i], &b = s.grains[j];
		const double width = s.cell.length(0);
		const long middle = std::lround((a.place[1] - b.place[1]) / period);
		for (long up = middle - 1; up <= middle + 1; ++up) {
			const double y = b.place[1] + up * period - a.place[1];
			if (std::abs(y) > 2) continue;
			const double x0 = b.place[0] + up * offset - a.place[0];
			const long nearest = -std::lround(x0 / width);
			for (long right = nearest - 1; right <= nearest + 1; ++right) {
				const Vec<2> d{ x0 + right * width, y };
				if (geometry::squared_norm(d) > 2) continue;  // disks here have radii up to 0.51, so the pair does not touch
				const double r = length(d), overlap = a.radius + b.radius - r;
				const auto key = std::pair(long(i * s.grains.size() + j), up);
				if (overlap <= 0) {
					slips.erase(key);
					continue;
				}
				double& slip = slips[key];
				const Vec<2> n = d / r, v = b.velocity + double(up) * s.cell.image_velocity() - a.velocity;
				const laws::Kinematics<Real, Real> contact{ overlap, v[0] * n[0] + v[1] * n[1],
					a.radius * a.spin + b.radius * b.spin - (v[1] * n[0] - v[0] * n[1]),
					a.radius * b.radius / (a.radius + b.radius), a.mass * b.mass / (a.mass + b.mass), s.dt };
				const auto answer = std::visit([&](const auto& law) { return answer_of(law(contact, slip)); }, s.law);
				slip = answer.slip;
				const double friction = s.friction ? answer.tangential : 0;
				const Vec<2> on_first = force_on_first(n, answer.normal, friction);
				force[i] += on_first, force[j] -= on_first;
				torque[i] += a.radius * friction, torque[j] += b.radius * friction;
			}
		}
	}

	/// Largest difference of place, velocity or spin from the loop's grains, in the loop's images.
	double difference(const Stepper<2>& loop) const
	{
		Cell<2> cell = s.cell;
		cell.high[1] = period, cell.set_offset(offset);
		double largest = 0;
		for (std::size_t i = 0; i < s.grains.size(); ++i) {
			const Grain<2> g = loop.grain(i);
			const geometry::Image<2> apart = cell.nearest(s.grains[i].place - g.place);
			const Vec<2> faster = s.grains[i].velocity - g.velocity + cell.velocity_change(apart);
			for (const double one : { apart.at[0], apart.at[1], faster[0], faster[1], s.grains[i].spin - g.spin })
				largest = std::max(largest, std::abs(one));
		}
		return largest;
	}
};

/// Runs both implementations and expects them to agree.
void expect_as_plain(const Scene<2>& scene, int steps, double tolerance)
{
	Stepper<2> loop(scene);
	loop.guarding().every = 0;
	PlainShear plain(scene);
	for (int n = 0; n < steps; ++n) plain.step();
	loop.step(steps);
	EXPECT_LT(plain.difference(loop), tolerance);
}

bool same_contacts(const std::vector<Contact<2>>& a, const std::vector<Contact<2>>& b)
{
	if (a.size() != b.size()) return false;
	for (std::size_t k = 0; k < a.size(); ++k)
		if (a[k].first != b[k].first || a[k].second != b[k].second || a[k].normal != b[k].normal || a[k].slip != b[k].slip)
			return false;
	return true;
}

}  // namespace

TEST(Shear, a_crowd_moves_as_in_a_plain_loop_over_all_images)
{
	// A round-off of 1e-16 grows by some collisions of each grain; velocities are 1 to 20.
	for (const double offset : { 0.0, 6.0, 11.999 }) expect_as_plain(sheared_crowd(12, 3, 2, offset), 1000, 1e-9);
	Scene<2> backwards = sheared_crowd(12, 4, -2, 5);
	expect_as_plain(backwards, 1000, 1e-9);
	Scene<2> flat = sheared_crowd(12, 5, 1);  // longer in x, so that the grid's slow axis is the other one
	for (std::size_t k = 0; k < 144; ++k) {
		Grain<2> g = flat.grains[k];
		g.place[0] += 12;
		flat.grains.push_back(g);
	}
	flat.cell.high[0] = 24;
	expect_as_plain(flat, 500, 1e-9);
}

TEST(Shear, a_flow_that_changes_and_a_cell_that_grows_move_grains_and_images_alike)
{
	const Scene<2> scene = sheared_crowd(12, 6, 2);
	Stepper<2> loop(scene);
	loop.guarding().every = 0;
	loop.track_energy(true);
	PlainShear plain(scene);
	for (int n = 0; n < 2000; ++n) {
		plain.image_velocity = { 24 + 8 * std::sin(n * 0.01), 0.3 * std::sin(n * 0.02) };
		loop.set_flow({ plain.image_velocity, 0 });
		plain.step(), loop.step();
	}
	EXPECT_NEAR(loop.settings().cell.length(1), plain.period, 1e-12);
	EXPECT_LT(plain.difference(loop), 1e-8);
	const Energies& e = loop.energy_ledger()->energies();
	EXPECT_LT(std::abs(e.residual()), 1e-11 * e.turnover);
	EXPECT_GT(std::abs(e.work_of_cell), 0.1);
}

/// A pair in the middle of the cell, and the same pair with the cell's side between its disks, at an offset.
TEST(Shear, forces_and_springs_of_a_pair_do_not_know_where_the_side_is)
{
	for (const double rise : { 0.0, 3.0 }) {  // at rest at the side, and moving through it, so that grains are wrapped
		Scene<2> inside = sheared_crowd(12, 1, 1);
		inside.grains = { disk(6, 6), disk(6.3, 6.93) };
		inside.grains[0].velocity = { 0.2, rise }, inside.grains[1].velocity = { -0.4, rise - 0.1 };
		inside.grains[0].spin = 1;
		Scene<2> across = inside;
		const Cell<2>& cell = inside.cell;
		const Vec<2> up{ 3.7, rise == 0 ? 5.6 : 4.0 };
		for (Grain<2>& g : across.grains) g.place += up;
		for (Grain<2>& g : across.grains) {
			const geometry::Image<2> image = cell.wrap(g.place);
			g.place = image.at, g.velocity += cell.velocity_change(image);
		}
		Stepper<2> one(inside), other(across);
		for (int n = 0; n < 4000; ++n) {
			one.step(), other.step();
			if (n % 50) continue;
			const auto a = one.contacts(), b = other.contacts();
			ASSERT_EQ(a.size(), b.size()) << n;
			if (a.empty()) continue;
			// Round-off of coordinates of 10 in overlaps of 0.01, with a stiffness of 2e5.
			const double turned = a[0].first == b[0].first ? 1 : -1;
			EXPECT_NEAR(a[0].normal, b[0].normal, 1e-7) << n;
			EXPECT_NEAR(a[0].friction, b[0].friction, 1e-7) << n;
			EXPECT_NEAR(a[0].slip, b[0].slip, 1e-11) << n;
			EXPECT_NEAR(a[0].overlap, b[0].overlap, 1e-12) << n;
			EXPECT_NEAR(a[0].n[0], turned * b[0].n[0], 1e-11) << n;
		}
	}
}

TEST(Shear, a_restart_in_mid_shear_goes_on_with_the_same_bits_on_any_number_of_threads)
{
	const graindrive::test::TemporaryFile file;
	const std::string& path = file.path();
	Stepper<2> whole(sheared_crowd(16, 7, 3, 2.5));
	whole.track_energy(true);
	whole.step(777);
	whole.set_flow({ { 30, 0.2 }, 0 });
	whole.step(3);
	whole.save(path);
	whole.step(500);
	for (const int threads : { 1, 2, 3 }) {
		const auto restored = Stepper<2>::restore(path, threads);
		restored->step(500);
		EXPECT_TRUE(same_bits(whole, *restored)) << threads;
		EXPECT_EQ(whole.settings().cell.offset, restored->settings().cell.offset);
		EXPECT_EQ(whole.settings().cell.high[1], restored->settings().cell.high[1]);
		EXPECT_EQ(whole.energy_ledger()->energies().work_of_cell, restored->energy_ledger()->energies().work_of_cell);
	}
	std::remove(path.c_str());
}

TEST(Shear, processors_and_threads_give_the_same_bits)
{
	const auto moved = [](const char* processor, int threads) {
		setenv("GRAINDRIVE_PROCESSOR", processor, 1);
		Scene<2> s = sheared_crowd(16, 8, 3);
		s.threads = threads;
		auto loop = std::make_unique<Stepper<2>>(s);
		unsetenv("GRAINDRIVE_PROCESSOR");
		loop->step(1000);
		return loop;
	};
	const auto best = choose_disk_kernel({}).processor;
	if (best == Processor::portable) GTEST_SKIP() << "this machine has portable code alone";
	const auto narrow = moved("avx2", 1);
	EXPECT_TRUE(same_bits(*narrow, *moved("avx2", 3)));
	if (best == Processor::avx512) {
		EXPECT_TRUE(same_bits(*narrow, *moved("avx512", 1)));
	}
}

TEST(Shear, who_looks_leaves_no_trace)
{
	Stepper<2> seen(sheared_crowd(12, 9, 3)), unseen(sheared_crowd(12, 9, 3));
	for (int n = 0; n < 300; ++n) {
		seen.step(), unseen.step();
		const auto now = seen.present_contacts();
		seen.kinetic_energy_on_step();
		seen.step(), unseen.step();
		ASSERT_TRUE(same_contacts(now, seen.contacts())) << n;  // what the step has found
	}
	EXPECT_TRUE(same_bits(seen, unseen));
}

/// At half a period two images are equally far; each pair of a lattice must be in the list exactly once.
TEST(Shear, no_pair_is_met_twice_or_missed_at_any_offset)
{
	for (const double offset : { 0.0, 0.25, 0.5, 2.0, 2.5, 3.999, 4.0, 4.001, 7.75 }) {
		Scene<2> s = sheared_crowd(8, 1, 0, offset);
		for (std::size_t k = 0; k < s.grains.size(); ++k) s.grains[k] = disk(k % 8 + 0.5, k / 8 + 0.5, 0.51);
		Stepper<2> loop(s);
		std::set<std::pair<std::uint32_t, std::uint32_t>> met;
		for (const Contact<2>& c : loop.present_contacts())
			EXPECT_TRUE(met.insert(std::minmax(c.first, c.second)).second) << offset;
		std::size_t touching = 0;
		for (std::size_t i = 0; i < 64; ++i)
			for (std::size_t j = i + 1; j < 64; ++j)
				for (int up = -1; up <= 1; ++up)
					for (int right = -2; right <= 2; ++right) {
						const Vec<2> d = s.grains[j].place - s.grains[i].place + Vec<2>{ right * 8 + up * offset, up * 8.0 };
						touching += length(d) < 1.02;
					}
		EXPECT_EQ(met.size(), touching) << offset;
	}
}

/// The images move by more than a cell of the search in a step. Without friction and damping forces depend on positions only.
TEST(Shear, a_shear_of_more_than_a_cell_per_list_is_safe)
{
	for (const double cells_per_step : { 0.02, 0.3, 1.7, 40.3 }) {
		Scene<2> s = sheared_crowd(12, 10, 0);
		s.law = hertz(0, 0), s.friction = false;
		for (Grain<2>& g : s.grains) g.radius *= 1.01;
		s.cell.rate = cells_per_step * 1.2 / s.dt;
		// Displacements of 1e3 times the width are reduced to the cell by remainders: their round-off is 1e-12.
		expect_as_plain(s, 120, 1e-7);
	}
}

TEST(Shear, the_ledger_books_the_power_of_the_shear_and_closes_over_a_hundred_strains)
{
	constexpr double shear_rate = 10;
	Scene<2> s = sheared_crowd(8, 11, shear_rate);
	s.law = hertz(0.3, 1500), s.dt = 2e-4;
	Stepper<2> loop(s);
	loop.guarding().largest_overlap = 0.4;
	loop.step(5000);
	loop.track_energy(true);
	const double dt = s.dt;
	double work = 0;
	long samples = 0;
	constexpr long steps = 50000, every = 10;
	for (long n = 0; n < steps; n += every, ++samples) {
		loop.step(every);
		double stress = 0;  // times the volume, > 0 along the shear
		for (const Contact<2>& c : loop.contacts()) {
			const Vec<2> on_first = force_on_first(c.n, c.normal, c.friction);
			const double radii = s.grains[c.first].radius + s.grains[c.second].radius - c.overlap;
			stress += on_first[0] * radii * c.n[1];
		}
		for (std::size_t i = 0; i < loop.size(); ++i) {
			const Grain<2> g = loop.grain(i);
			stress -= g.mass * (g.velocity[0] - shear_rate * g.place[1]) * g.velocity[1];
		}
		work += stress * shear_rate * every * dt;
	}
	ASSERT_NEAR(steps * dt * shear_rate, 100, 1e-9);
	const Energies& e = loop.energy_ledger()->energies();
	EXPECT_GT(e.work_of_cell, 10 * e.stored());  // the work is much larger than the stored energy
	EXPECT_LT(std::abs(e.residual()), 1e-6 * e.work_of_cell);
	// The stress is sampled at every tenth step, and the cell works on grains only when they cross its side: some percent over a
	// strain of 100.
	EXPECT_NEAR(work / e.work_of_cell, 1, 0.03);
}

TEST(Shear, what_a_sheared_cell_cannot_hold_is_refused_by_name)
{
	const auto refusal = [](const auto& spoil) {
		Scene<2> s = sheared_crowd(8, 1, 1);
		spoil(s);
		try {
			Stepper<2> loop(s);
		} catch (const std::invalid_argument& error) {
			return std::string(error.what());
		}
		return std::string("nothing");
	};
	const auto says = [&](const auto& spoil, const char* words) {
		const std::string said = refusal(spoil);
		EXPECT_NE(said.find(words), std::string::npos) << said;
	};
	says([](Scene<2>& s) { s.cell.periodic[0] = false; }, "two different periodic axes");
	says([](Scene<2>& s) { s.cell.across = 0, s.cell.along = 1; }, "sheared across y");
	says([](Scene<2>& s) { s.cell.rate = NAN; }, "must be finite");
	says([](Scene<2>& s) { s.damping = 0.2; }, "damping");
	says([](Scene<2>& s) { s.bodies.emplace_back(); }, "only free disks");
	says([](Scene<2>& s) { s.walls.emplace_back(); }, "no walls");
	Scene<3> spheres;
	spheres.grains.push_back({ { 1, 1, 1 }, {}, {}, 0.5, 1 });
	spheres.cell = { {}, { 9, 9, 9 }, { true, true, true }, 1, 0 };
	spheres.law = laws::hertz_restitution(2e5, 0.3, 0.7, 0.4), spheres.dt = 1e-5;
	EXPECT_THROW(Stepper<3>{ spheres }, std::invalid_argument);
}

}  // namespace graindrive::loop
