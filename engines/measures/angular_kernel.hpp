/// How a contact at an angle is shared out among points or bins around a body.
#pragma once
#include <cmath>
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive {

/// The share of one contact in one bin.
struct BinShare {
	int bin;
	Real weight;
};

/// Bins of 2 pi/M, or M points with a Gaussian around each; weights of a contact sum to 1.
///
/// Gaussian: w_m = sqrt(2 pi)/(M zeta) exp(-(theta - theta_m)^2/(2 zeta^2)), Guillard et al. 2014, Eq. (A4). Its sum over the
/// equally spaced points differs from 1 by 2 exp(-M^2 zeta^2/2) (Poisson summation): 4e-18 for 64 points and 8 degrees.
/// It is cut where it falls below 1e-17 of its peak.
class AngularKernel {
public:
	/// @param width  zeta [rad]; 0 for bins
	AngularKernel(int count, Real width) : count_(count), width_(width), spacing_(2 * pi / count) {}

	int count() const { return count_; }
	/// Centre of bin m [rad], in (-pi, pi).
	Real angle(int m) const { return -pi + (m + Real(0.5)) * spacing_; }

	void shares(Real theta, std::vector<BinShare>& out) const
	{
		out.clear();
		const Real place = (theta + pi) / spacing_;  // in bins from -pi
		const int nearest = std::min(count_ - 1, std::max(0, int(std::floor(place))));
		if (width_ == 0) {
			out.push_back({ nearest, 1 });
			return;
		}
		const int reach = int(std::ceil(8.9 * width_ / spacing_));  // a wide one goes round more than once
		// w(m+1)/w(m) falls geometrically, so two exponentials serve a whole side.
		const Real offset = (place - Real(0.5) - nearest) * spacing_, a = Real(1) / (2 * width_ * width_);
		const Real peak = std::sqrt(2 * pi) / (count_ * width_) * std::exp(-a * offset * offset);
		const Real fall = std::exp(-2 * a * spacing_ * spacing_), first = std::exp(-a * spacing_ * spacing_);
		const Real slope = std::exp(2 * a * offset * spacing_);
		out.push_back({ nearest, peak });
		for (const int side : { +1, -1 }) {
			Real weight = peak, ratio = first * (side > 0 ? slope : 1 / slope);
			for (int k = 1; k <= reach; ++k) {
				weight *= ratio;
				ratio *= fall;
				out.push_back({ ((nearest + side * k) % count_ + count_) % count_, weight });
			}
		}
	}

private:
	int count_;
	Real width_, spacing_;
};

}  // namespace graindrive
