/// No thread passes a barrier early or stays behind, whether threads poll, sleep, or outnumber the cores.
#include "engines/loop/thread_team.hpp"

#include <gtest/gtest.h>

namespace graindrive::loop {

TEST(ThreadTeam, what_was_written_before_a_barrier_is_seen_after_it)
{
	for (int size : { 1, 2, 3, 8 }) {
		ThreadTeam team(size);
		std::vector<long> written(size, 0);
		std::atomic<long> wrong{ 0 };
		for (int call = 0; call < 3; ++call) {
			team.run([&](int rank) {
				for (long step = 1; step <= 2000; ++step) {
					written[rank] = call * 10'000 + step;
					team.barrier();
					for (long seen : written) wrong += seen != call * 10'000 + step;
					team.barrier();
				}
			});
		}
		EXPECT_EQ(wrong, 0) << size << " threads";
	}
}

TEST(ThreadTeam, waits_for_one_that_is_late_by_more_than_it_looks)
{
	ThreadTeam team(4);
	std::atomic<int> early{ 0 }, passed{ 0 };
	double sum = 0;
	team.run([&](int rank) {
		if (rank == 2) {
			for (int k = 1; k < 3'000'000; ++k) sum += 1.0 / k;  // some milliseconds: the others fall asleep
			early = passed.load();
		}
		team.barrier();
		++passed;
	});
	EXPECT_EQ(early, 0);
	EXPECT_EQ(passed, 4);
	EXPECT_GT(sum, 15);
}

TEST(Epoch, does_not_wait_for_what_has_happened)
{
	Epoch epoch;
	epoch.advance();
	epoch.wait_past(0);
	EXPECT_EQ(epoch.now(), 1u);
}

}  // namespace graindrive::loop
