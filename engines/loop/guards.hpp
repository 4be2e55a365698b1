/// Checks of a scene before it starts, and the words of a guard that trips while it runs.
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>

#include "engines/loop/scene.hpp"

namespace graindrive::loop {

/// One text of words and numbers.
template <class... Words>
std::string sentence(const Words&... words)
{
	std::ostringstream out;
	out.precision(6);
	(out << ... << words);
	return out.str();
}

/// True if a body may turn about every axis: all its moments of inertia are positive.
inline bool is_positive(double inertia) { return inertia > 0; }
inline bool is_positive(const Vec<3>& inertia) { return inertia[0] > 0 && inertia[1] > 0 && inertia[2] > 0; }

/// The time step must be stable for pairs that overlap by `overlap` of the smaller radius: the overlap that stops the run.
/// @throws std::invalid_argument naming the rule, the number and the way out
template <int D>
void check_scene(const Scene<D>& scene, double overlap = 0.1);

/// Largest stable time step of the stiffest, lightest pair of free grains at an overlap of `overlap` radii [s].
///
/// omega dt < 2 (sqrt(1 + zeta^2) - zeta) for the normal motion and for sliding, in which two grains move with m_eff/(1 + m R^2/I):
/// a third of m_eff for disks, two sevenths for spheres. Hertz stiffness grows with the overlap, so it is taken where the overlap guard stops a run.
template <int D>
double critical_time_step(const Scene<D>& scene, double overlap = 0.1);

/// The same for rigid bodies that respond, each against its stiffest partner: in translation, and in turning with the longest lever
/// that a contact can have, the member's distance from the centre (and its radius, for sliding); infinite where none responds [s].
template <int D>
double critical_time_step_of_bodies(const Scene<D>& scene, double overlap = 0.1);

}  // namespace graindrive::loop
