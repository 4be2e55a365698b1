/// What GrainLoop shows of all grains and contacts: those at the present positions, before the step moves anything.
#include "engines/loop/GrainLoop.hpp"
#include "engines/seam/scene_grains.hpp"

namespace graindrive {

void GrainLoop::look(SceneView& view, bool with_contacts)
{
	view.grains.clear();
	view.contacts.clear();
	view.periods = periods;
	stepper();
	add_grains(view);
	if (!with_contacts) return;
	const auto force_on_second = [](const loop::Contact& c) -> Vector3r {
		return c.normal * Vector3r(c.n_x, c.n_y, 0) - c.friction * Vector3r(-c.n_y, c.n_x, 0);
	};
	for (const loop::Contact& c : stepper_->present_contacts())
		view.contacts.push_back({ int(c.first), int(c.second), { c.n_x, c.n_y, 0 }, c.overlap, force_on_second(c) });
	for (const loop::Contact& c : stepper_->wall_contacts())
		view.contacts.push_back({ int(c.first), no_grain, { c.n_x, c.n_y, 0 }, c.overlap, force_on_second(c) });
}

/// What the loop moves as a body may be a grain all the same (a large disk, a watched one): YADE's state tells.
void GrainLoop::add_grains(SceneView& view) const
{
	const loop::Scene& known = stepper_->settings();
	for (std::size_t g = 0; g < map_.grain_id.size(); ++g) {
		const loop::Grain now = stepper_->grain(g);
		const int id = map_.grain_id[g];
		bool free = true;
		Real mass = now.mass;
		if (known.grains[g].body != loop::free_grain) {
			const yade::Body& body = *(*scene->bodies)[id];
			free = is_free_grain(body);
			mass = body.state->mass;
		}
		view.grains.push_back({ id, free, { now.x, now.y, 0 }, { now.vx, now.vy, 0 }, { 0, 0, now.spin }, now.radius, mass });
	}
}

}  // namespace graindrive
