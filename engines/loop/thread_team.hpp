/// A few threads that walk through the same steps together, and a barrier that costs less than a microsecond.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace graindrive::loop {

/// A counter that threads wait on: they look at it for a short while and then sleep, so that a thread whose core was taken away can run on
/// the core of one that waits for it.
class Epoch {
public:
	unsigned now() const { return count.load(); }
	void advance();
	void wait_past(
		unsigned seen);  ///< returns once the counter is no longer `seen`; what was written before `advance` is seen after

private:
	std::atomic<unsigned> count{ 0 };
	std::atomic<int> sleepers{ 0 };
	std::mutex mutex;
	std::condition_variable advanced;

	bool seen_while_looking(unsigned seen) const;
};

class ThreadTeam {
public:
	explicit ThreadTeam(int size);
	~ThreadTeam();
	ThreadTeam(const ThreadTeam&) = delete;

	int size() const { return n_threads; }
	/// Runs work(rank) on every thread, rank 0 on the caller's; returns when all have finished. `work` must not throw.
	void run(const std::function<void(int)>& work);
	/// Waits until every thread of the running work has come here. What was written before is seen after.
	void barrier();

private:
	const int n_threads;
	std::vector<std::thread> helpers;
	const std::function<void(int)>* task = nullptr;  // none: the team ends
	alignas(64) Epoch round;
	alignas(64) std::atomic<int> arrived{ 0 };
	alignas(64) Epoch passed;

	void begin(const std::function<void(int)>* work);
	void help(int rank);
};

}  // namespace graindrive::loop
