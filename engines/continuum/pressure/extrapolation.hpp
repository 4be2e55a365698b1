/// First guesses for the pressure of the next step from its last solutions.
#pragma once
#include <cstddef>
#include <vector>

namespace graindrive::continuum {

/// Keeps the last solutions at equal steps of time and extends the polynomial through them: from 1 solution the same again, from 2
/// p_1 + (p_1 - p_2), from 3 also + (p_1 - 2 p_2 + p_3). A field that moves as a polynomial of that degree is predicted exactly.
class Extrapolation {
public:
	/// @param degree 0, 1 or 2
	/// @throws std::invalid_argument if the degree is another
	explicit Extrapolation(int degree);
	/// Remembers the solution of the present step.
	void remember(const std::vector<double>& p);
	/// Writes the guess for the next step; does not change p if no earlier steps are stored.
	void predict(std::vector<double>& p) const;
	/// Forgets all: after a change that makes the next step unlike the last ones.
	void forget() { known = 0; }

	/// How many solutions it knows, and the n-th last of them (0 is the last): the state that a checkpoint keeps.
	int count() const { return known; }
	const std::vector<double>& solution(int n) const { return past[(newest + past.size() - std::size_t(n)) % past.size()]; }

private:
	std::vector<std::vector<double>> past;
	std::size_t newest = 0;
	int known = 0;
};

}  // namespace graindrive::continuum
