/// The point that several half-spaces share and that lies nearest to a given one: the step of `Intersection`'s iteration.
///
///   min |u - w|^2  subject to  n_i u <= c_i;  u = w - sum_a lambda_a n_a, lambda_a >= 0, n_a u = c_a
///
/// by the conditions of Karush, Kuhn and Tucker: at most D independent half-spaces are active, so few that all choices are tried.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "engines/geometry/vec.hpp"

namespace graindrive::geometry {

/// The half-space n u <= c.
template <int D>
struct Cut {
	Vec<D> normal;  ///< of unit length
	double limit;   ///< [m]
};

template <int D>
struct CutPoint {
	bool found = false;  ///< false where the half-spaces share no point, or nearly parallel ones hide it
	Vec<D> at;
	int count = 0;    ///< of active half-spaces
	Vec<D> basis[D];  ///< orthonormal, spans their normals

	/// The part of a vector along the edge in which the active half-spaces intersect.
	Vec<D> along_edge(Vec<D> v) const
	{
		for (int k = 0; k < count; ++k) v -= dot(v, basis[k]) * basis[k];
		return v;
	}
};

/// The active half-spaces as equations: u = w + sum_k y_k e_k with normals N = E R (Gram-Schmidt), R' y = c - N'w, lambda = -y/R.
template <int D>
class ActiveCuts {
public:
	explicit ActiveCuts(const Vec<D>& target) : target_(target) { point_.at = target; }

	/// Holds one more as an equation; false if its normal nearly depends on the others'.
	bool add(const Cut<D>& cut)
	{
		const int k = point_.count;
		Vec<D> rest = cut.normal;
		double misfit = cut.limit - dot(cut.normal, target_);
		for (int j = 0; j < k; ++j) {
			r_[j][k] = dot(cut.normal, point_.basis[j]);
			rest -= dot(rest, point_.basis[j]) * point_.basis[j];
			misfit -= r_[j][k] * y_[j];
		}
		r_[k][k] = norm(rest);
		if (r_[k][k] < nearly_parallel) return false;
		point_.basis[k] = rest / r_[k][k];
		y_[k] = misfit / r_[k][k];
		point_.at += y_[k] * point_.basis[k];
		++point_.count;
		return true;
	}

	bool pushes_back() const  ///< no multiplier is negative
	{
		double lambda[D];
		for (int k = point_.count - 1; k >= 0; --k) {
			lambda[k] = -y_[k];
			for (int j = k + 1; j < point_.count; ++j) lambda[k] -= r_[k][j] * lambda[j];
			lambda[k] /= r_[k][k];
			if (lambda[k] < 0) return false;
		}
		return true;
	}

	const CutPoint<D>& point() const { return point_; }

private:
	static constexpr double nearly_parallel = 1e-7;  // sine of the angle [-]; below it the edge lies nowhere in particular

	Vec<D> target_;
	CutPoint<D> point_;
	double r_[D][D], y_[D];
};

/// What a sum of lengths up to `size`, and the coordinates of u, may be wrong by.
template <int D>
double round_off(double size, const Vec<D>& u)
{
	return 1e-13 * std::max(size, largest(u));
}

/// How far u lies beyond the cut it breaks most, and which one that is.
template <int D>
std::pair<double, std::size_t> most_broken(const std::vector<Cut<D>>& cuts, const Vec<D>& u)
{
	std::pair<double, std::size_t> worst{ -std::numeric_limits<double>::infinity(), 0 };
	for (std::size_t i = 0; i < cuts.size(); ++i) worst = std::max(worst, { dot(cuts[i].normal, u) - cuts[i].limit, i });
	return worst;
}

/// Tries all choices of up to D cuts, from `first` on, beside those that are active.
template <int D>
void try_choices(const std::vector<Cut<D>>& cuts, std::size_t first, const ActiveCuts<D>& active, const Vec<D>& target,
	double size, CutPoint<D>& best)
{
	const CutPoint<D>& point = active.point();
	const bool nearer = !best.found || squared_norm(point.at - target) < squared_norm(best.at - target);
	if (nearer && active.pushes_back() && most_broken(cuts, point.at).first <= round_off(size, point.at)) {
		best = point;
		best.found = true;
	}
	if (point.count == D) return;
	for (std::size_t i = first; i < cuts.size(); ++i) {
		ActiveCuts<D> more = active;
		if (more.add(cuts[i])) try_choices(cuts, i + 1, more, target, size, best);
	}
}

/// The nearest common point to `target`. Half-spaces come into play one by one, the most broken first.
template <int D>
CutPoint<D> nearest_common_point(const std::vector<Cut<D>>& cuts, const Vec<D>& target)
{
	double size = largest(target);
	for (const Cut<D>& cut : cuts) size = std::max(size, std::abs(cut.limit));
	std::vector<Cut<D>> used;
	CutPoint<D> best;
	best.at = target;
	best.found = true;
	while (best.found && used.size() <= cuts.size()) {
		const auto [excess, worst] = most_broken(cuts, best.at);
		if (excess <= round_off(size, best.at)) return best;
		used.push_back(cuts[worst]);
		best.found = false;
		try_choices(used, 0, ActiveCuts<D>(target), target, size, best);
	}
	best.found = false;
	return best;
}

}  // namespace graindrive::geometry
