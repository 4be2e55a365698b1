/// A few threads that walk through the same steps together, and a barrier that costs less than a microsecond.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace graindrive::loop {

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
	std::mutex mutex;
	std::condition_variable wake;
	std::atomic<unsigned> round{ 0 };
	const std::function<void(int)>* task = nullptr;
	bool leaving = false;
	alignas(64) std::atomic<int> arrived{ 0 };
	alignas(64) std::atomic<unsigned> generation{ 0 };

	void help(int rank);
};

}  // namespace graindrive::loop
