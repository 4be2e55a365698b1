/// What a scene of spheres must hold for the loop to run it.
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "engines/loop/spheres/sphere_loop.hpp"

namespace graindrive::loop {

namespace {

void require(bool holds, const char* rule, double got)
{
	if (holds) return;
	std::ostringstream message;
	message << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

void require_of(bool holds, std::size_t sphere, const char* rule, double got)
{
	if (holds) return;
	std::ostringstream message;
	message << "sphere " << sphere << ": " << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

}  // namespace

void check_scene(const SphereScene& scene)
{
	require(!scene.spheres.empty(), "a scene must have at least one sphere", 0);
	require(scene.dt > 0 && std::isfinite(scene.dt), "dt must be positive", scene.dt);
	require(scene.threads >= 1, "threads must be at least 1", scene.threads);
	require(scene.skin >= 0, "skin must be positive, or 0 to let the loop choose", scene.skin);
	require(scene.gravity.allFinite(), "gravity must be finite", scene.gravity.sum());
	require(scene.spheres.size() < 30'000'000, "a scene may have at most 30 million spheres (row offsets of 32 bits)",
		scene.spheres.size());
	for (int k = 0; k < 3; ++k)
		if (scene.box.periodic[k])
			require(scene.box.length(k) > 0, "a periodic box must have a positive length", scene.box.length(k));
	for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
		const Sphere& s = scene.spheres[i];
		require_of(s.radius > 0 && std::isfinite(s.radius), i, "radius must be positive", s.radius);
		require_of(s.mass > 0, i, "mass must be positive", s.mass);
		require_of(s.held || std::isfinite(s.mass), i, "the mass of a free sphere must be finite; hold it instead", s.mass);
		require_of(s.x.allFinite() && s.v.allFinite() && s.spin.allFinite(), i, "position, velocity and spin must be finite",
			s.x.sum() + s.v.sum() + s.spin.sum());
	}
}

}  // namespace graindrive::loop
