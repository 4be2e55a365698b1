/// Threads wait by polling for a short time, then by sleeping: polling is fast on an idle machine, sleeping frees cores on a busy
/// one.
#include "engines/loop/thread_team.hpp"

#include <chrono>

namespace graindrive::loop {

void Epoch::advance()
{
	++count;
	if (sleepers == 0) return;  // a thread that registers as a sleeper from now on sees the new count
	{
		const std::lock_guard<std::mutex> lock(mutex);  // a thread that has seen the old count under the lock is asleep
	}
	advanced.notify_all();
}

void Epoch::wait_past(unsigned seen)
{
	if (seen_while_looking(seen)) return;
	std::unique_lock<std::mutex> lock(mutex);
	++sleepers;
	advanced.wait(lock, [&] { return count != seen; });
	--sleepers;
}

bool Epoch::seen_while_looking(unsigned seen) const
{
	using Clock = std::chrono::steady_clock;
	constexpr auto patience = std::chrono::microseconds(50);  // falling asleep and waking up take about as long
	constexpr int looks_at_once = 32;                         // between two readings of the clock, which cost as much as a look
	for (const auto end = Clock::now() + patience; Clock::now() < end;)
		for (int looks = 0; looks < looks_at_once; ++looks) {
			if (count.load(std::memory_order_acquire) != seen) return true;
			__builtin_ia32_pause();
		}
	return false;
}

ThreadTeam::ThreadTeam(int size) : n_threads(size)
{
	for (int rank = 1; rank < size; ++rank) helpers.emplace_back([this, rank] { help(rank); });
}

ThreadTeam::~ThreadTeam()
{
	begin(nullptr);
	for (std::thread& helper : helpers) helper.join();
}

void ThreadTeam::begin(const std::function<void(int)>* work)
{
	task = work;
	round.advance();
}

void ThreadTeam::run(const std::function<void(int)>& work)
{
	if (n_threads == 1) return work(0);
	begin(&work);
	work(0);
	barrier();
}

void ThreadTeam::help(int rank)
{
	for (unsigned seen = 0;; ++seen) {
		round.wait_past(seen);
		if (!task) return;
		(*task)(rank);
		barrier();
	}
}

void ThreadTeam::barrier()
{
	if (n_threads == 1) return;
	const unsigned mine = passed.now();
	if (arrived.fetch_add(1) + 1 < n_threads) return passed.wait_past(mine);
	arrived = 0;
	passed.advance();
}

}  // namespace graindrive::loop
