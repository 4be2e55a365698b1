/// Guards that look at every grain and pair from time to time: not finite, out of the box, overlapping too far.
#pragma once
#include <array>

#include "engines/loop/guards.hpp"
#include "engines/loop/surfaces.hpp"

namespace graindrive::loop {

/// What guards call the grains, by index, and the step that the loop began with; by default indices and 0.
struct Speech {
	std::vector<int> names;
	long first_step = 0;
};

template <int D>
class RunningGuards {
public:
	RunningGuards(const State<D>& of, const Speech& words) : state(of), speech(words) {}

	/// @throws std::runtime_error with step, grain and likely cause
	template <class Neighbours>
	void check(const Neighbours& pairs, const Surfaces<D>& surfaces) const
	{
		check_box();
		check_finite();
		pairs.each_selected_pair([&](std::uint32_t a, std::uint32_t b, bool wrapped) { check_pair(a, b, wrapped); });
		check_surfaces(surfaces);
	}

private:
	const State<D>& state;
	const Speech& speech;

	struct Limit {
		double at = 0;  // of centres [m]
		bool is_set = false;
		std::string by;  // what sets it, for the message
		std::string cause;
	};
	std::array<Limit, 2 * D> limits() const;  // by Side
	Limit given_bound(Side side) const;
	Limit behind_held_grains(Side side) const;
	void check_box() const;
	void check_finite() const;
	void check_pair(std::uint32_t a, std::uint32_t b, bool wrapped) const;
	void check_surfaces(const Surfaces<D>& surfaces) const;
	std::string introduce(std::uint32_t row) const;
	std::string time_of_step() const;
};

}  // namespace graindrive::loop
