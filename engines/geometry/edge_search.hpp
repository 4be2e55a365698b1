/// The point nearest to p that lies in all of several solids: on an edge or corner where their surfaces intersect.
///
/// Sequential quadratic programming. At x the parts are replaced by their tangent half-spaces, d_i(x) + n_i (y - x) <= 0, and the next
/// x is the y among them that is nearest to x + (p - x)/b. Flat parts take one step; at corners of D surfaces it is Newton's method.
/// Along an edge in space one direction is free, in which |x - p|^2/2 has the second derivative b = 1 + sum lambda_i kappa_i; b is
/// taken from the last two steps (the secant method; Barzilai, Borwein, IMA J. Numer. Anal. 8, 141 (1988)). A step that leaves the
/// parts by more than a fraction of its length is shortened.
#pragma once
#include "engines/geometry/cuts.hpp"
#include "engines/geometry/surface.hpp"

namespace graindrive::geometry {

namespace edge_search {
constexpr int most_steps = 100;
constexpr double converged = 1e-13;         // of the distance: a step's length [-]
constexpr double good_enough = 1e-10;       // the same, where round-off of the parts hides the rest [-]
constexpr double coordinate_error = 8e-15;  // of the coordinates: what a distance may be wrong by [-]
constexpr double largest_excess = 0.25;     // of a step's length: how far it may leave the parts [-]

}  // namespace edge_search

/// A number that is negligible beside a distance between two points.
template <int D>
double distance_error(double distance, const Vec<D>& a, const Vec<D>& b, double relative = edge_search::converged)
{
	return relative * distance + edge_search::coordinate_error * std::max(largest(a), largest(b));
}

/// The parts of an intersection, or with side = -1 the complements of the parts of a union.
template <int D>
struct Parts {
	const std::vector<SharedSurface<D>>& list;
	double side;

	Nearest<D> nearest(std::size_t i, const Vec<D>& at) const
	{
		const Nearest<D> found = list[i]->nearest(at);
		return { side * found.distance, side * found.normal };
	}

	/// The part that is farthest away, which is what keeps `at` out most.
	std::pair<Nearest<D>, std::size_t> farthest(const Vec<D>& at) const
	{
		std::pair<Nearest<D>, std::size_t> most{ nearest(0, at), 0 };
		for (std::size_t i = 1; i < list.size(); ++i) {
			const Nearest<D> found = nearest(i, at);
			if (found.distance > most.first.distance) most = { found, i };
		}
		return most;
	}

	bool all_hold(const Vec<D>& at, double tolerance) const
	{
		for (std::size_t i = 0; i < list.size(); ++i)
			if (!(nearest(i, at).distance <= tolerance)) return false;
		return true;
	}
};

/// The search for the point of all parts that is nearest to p.
template <int D>
class NearestOfAll {
public:
	NearestOfAll(const Parts<D>& parts, const Vec<D>& p, const Vec<D>& start) : parts_(parts), p_(p)
	{
		see(start, tangents_, excess_);
	}

	/// True if it found one: `at()`.
	bool run()
	{
		for (int k = 0; k < edge_search::most_steps; ++k) {
			if (!step()) return false;
			if (done(edge_search::converged)) return true;
		}
		return done(edge_search::good_enough);
	}
	const Vec<D>& at() const { return x_; }

private:
	const Parts<D>& parts_;
	Vec<D> p_, x_;
	std::vector<Cut<D>> tangents_;            // of the parts at x, seen from x
	double excess_ = 0;                       // by which x is outside a part [m]
	double stiffness_ = 1;                    // b
	double reach_ = Bounds<D>::infinity;      // steps are no longer [m]
	double last_step_ = Bounds<D>::infinity;  // [m]
	Vec<D> moved_, left_before_;              // the last step; what was left to go along the edge before it
	int free_before_ = 0;                     // directions along the edge in that step

	bool done(double relative) const
	{
		const double error = distance_error(norm(p_ - x_), p_, x_, relative);
		return last_step_ <= error && excess_ <= error;
	}

	void see(const Vec<D>& x, std::vector<Cut<D>>& tangents, double& excess)
	{
		x_ = x;
		excess = 0;
		tangents.clear();
		for (std::size_t i = 0; i < parts_.list.size(); ++i) {
			const Nearest<D> part = parts_.nearest(i, x);
			tangents.push_back({ part.normal, -part.distance });
			excess = std::max(excess, part.distance);
		}
	}

	bool step()
	{
		CutPoint<D> next = nearest_common_point(tangents_, (p_ - x_) / stiffness_);
		if (!next.found) return false;
		const Vec<D> left = next.along_edge(p_ - x_);
		const Vec<D> slid = next.along_edge(moved_);
		if (D - next.count == free_before_ && norm(slid) > distance_error(norm(p_ - x_), p_, x_)) {
			stiffness_ = std::clamp(dot(left_before_ - left, slid) / squared_norm(slid), 0.05, 20.0);
			next = nearest_common_point(tangents_, (p_ - x_) / stiffness_);
			if (!next.found) return false;
		}
		free_before_ = D - next.count;
		left_before_ = left;
		return move(next.at);
	}

	/// Moves by u, or by half as much until the parts' tangents were good for the step.
	bool move(Vec<D> u)
	{
		if (norm(u) > reach_) u *= reach_ / norm(u);
		const Vec<D> from = x_;
		std::vector<Cut<D>> tangents;
		double excess = 0;
		for (int halving = 0;; ++halving) {
			see(from + u, tangents, excess);
			const bool good = excess <= edge_search::largest_excess * norm(u) || excess <= excess_ / 2;
			if (good || halving == 8 || norm(u) <= distance_error(norm(p_ - x_), p_, x_)) break;
			u *= 0.5;
			reach_ = norm(u);
		}
		reach_ *= 2;
		tangents_.swap(tangents);
		excess_ = excess;
		moved_ = u;
		last_step_ = norm(u);
		return std::isfinite(last_step_);
	}
};

}  // namespace graindrive::geometry
