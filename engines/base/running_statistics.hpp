/// Running mean and variance of many quantities sampled together (Welford's update).
#pragma once
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive {

/// mean_n = mean_{n-1} + (x - mean_{n-1})/n and M_n = M_{n-1} + (x - mean_{n-1})(x - mean_n):
/// Welford, Technometrics 4, 419 (1962). No cancellation, so a small variance on a large mean survives ten million samples.
inline void update_statistics(std::vector<Real>& mean, std::vector<Real>& squares, const std::vector<Real>& sample, long n)
{
	const Real share = Real(1) / Real(n);
	for (std::size_t i = 0; i < sample.size(); ++i) {
		const Real before = sample[i] - mean[i];
		mean[i] += before * share;
		squares[i] += before * (sample[i] - mean[i]);
	}
}

}  // namespace graindrive
