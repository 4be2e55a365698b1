/// Threads wait by looking often for a short while, then by yielding: quick on a free machine, polite on a crowded one.
#include "engines/loop/thread_team.hpp"

namespace graindrive::loop {

namespace {

template <class Done>
void wait_until(const Done& done)
{
	constexpr int looks_before_yielding = 4000;  // some 20 microseconds
	for (int looks = 0; !done(); ++looks) {
		if (looks < looks_before_yielding)
			__builtin_ia32_pause();
		else
			std::this_thread::yield();
	}
}

}  // namespace

ThreadTeam::ThreadTeam(int size) : n_threads(size)
{
	for (int rank = 1; rank < size; ++rank) helpers.emplace_back([this, rank] { help(rank); });
}

ThreadTeam::~ThreadTeam()
{
	{
		const std::lock_guard<std::mutex> lock(mutex);
		leaving = true;
		++round;
	}
	wake.notify_all();
	for (std::thread& helper : helpers) helper.join();
}

void ThreadTeam::run(const std::function<void(int)>& work)
{
	if (n_threads == 1) return work(0);
	{
		const std::lock_guard<std::mutex> lock(mutex);
		task = &work;
		++round;
	}
	wake.notify_all();
	work(0);
	barrier();
}

void ThreadTeam::help(int rank)
{
	for (unsigned seen = 0;;) {
		for (int looks = 0; looks < 4000 && round.load(std::memory_order_acquire) == seen; ++looks) __builtin_ia32_pause();
		std::unique_lock<std::mutex> lock(mutex);
		wake.wait(lock, [&] { return round.load() != seen; });
		seen = round.load();
		if (leaving) return;
		const auto* now = task;
		lock.unlock();
		(*now)(rank);
		barrier();
	}
}

void ThreadTeam::barrier()
{
	if (n_threads == 1) return;
	const unsigned mine = generation.load(std::memory_order_acquire);
	if (arrived.fetch_add(1, std::memory_order_acq_rel) + 1 == n_threads) {
		arrived.store(0, std::memory_order_relaxed);
		generation.fetch_add(1, std::memory_order_acq_rel);
		return;
	}
	wait_until([&] { return generation.load(std::memory_order_acquire) != mine; });
}

}  // namespace graindrive::loop
