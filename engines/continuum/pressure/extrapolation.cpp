/// Extrapolates the first guess of a solve from a ring buffer of earlier solutions.
#include "engines/continuum/pressure/extrapolation.hpp"

#include <algorithm>

#include "engines/geometry/refuse.hpp"

namespace graindrive::continuum {

Extrapolation::Extrapolation(int degree)
{
	geometry::require(degree >= 0 && degree <= 2, "the degree of an extrapolation must be 0, 1 or 2", degree, "1 is linear");
	past.resize(std::size_t(degree) + 1);
}

void Extrapolation::remember(const std::vector<double>& p)
{
	if (known > 0 && past[newest].size() != p.size()) forget();
	newest = (newest + 1) % past.size();
	past[newest] = p;
	known = std::min(known + 1, int(past.size()));
}

void Extrapolation::predict(std::vector<double>& p) const
{
	if (known == 0) return;
	p.resize(solution(0).size());
	const double *one = solution(0).data(), *two = known > 1 ? solution(1).data() : one,
				 *three = known > 2 ? solution(2).data() : nullptr;
	if (three)
		for (std::size_t i = 0; i < p.size(); ++i) p[i] = 3 * (one[i] - two[i]) + three[i];
	else
		for (std::size_t i = 0; i < p.size(); ++i) p[i] = one[i] + (one[i] - two[i]);
}

}  // namespace graindrive::continuum
