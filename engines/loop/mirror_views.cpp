/// Grains, contacts and walls as other code sees them: at the present positions, before the step moves anything.
#include <algorithm>
#include <cmath>

#include "engines/loop/mirror_of.hpp"
#include "engines/seam/scene_grains.hpp"

namespace graindrive::loop {

namespace {

constexpr int no_body = -1;
constexpr int first_wall = -2;  // Python's id of a wall is -2 - side

Vector3r tangential_in_yade(const Vec<2>& n, double friction) { return { -n[1] * friction, n[0] * friction, 0 }; }
Vector3r tangential_in_yade(const Vec<3>&, const Vec<3>& friction) { return in_yade<3>(friction); }

Vector3r slip_in_yade(double slip) { return { slip, 0, 0 }; }
Vector3r slip_in_yade(const Vec<3>& slip) { return in_yade<3>(slip); }

}  // namespace

template <int D>
void MirrorOf<D>::look(SceneView& view, bool with_contacts)
{
	view.grains.clear();
	view.contacts.clear();
	view.periods = engine.periods;
	view.sheared = stepper->settings().cell.sheared();
	const Scene<D>& known = stepper->settings();
	for (std::size_t g = 0; g < map.grain_id.size(); ++g) {
		const Grain<D> now = stepper->grain(g);
		const int id = map.grain_id[g];
		bool free = true;
		Real mass = now.mass;
		if (known.grains[g].body != free_grain) {  // YADE may count it as a free grain (a large or watched one)
			free = is_free_grain(body_of_yade(id));
			mass = state_of(id).mass;
		}
		view.grains.push_back(
			{ id, free, in_yade<D>(now.place), in_yade<D>(now.velocity), spin_in_yade(now.spin), now.radius, mass });
	}
	if (!with_contacts) return;
	const auto add = [&](const Contact<D>& c, int second) {
		const Vector3r n = in_yade<D>(c.n), force = c.normal * n - tangential_in_yade(c.n, c.friction);
		view.contacts.push_back({ int(c.first), second, n, c.overlap, force });
	};
	for (const Contact<D>& c : stepper->present_contacts()) add(c, int(c.second));
	for (const Contact<D>& c : stepper->surface_contacts()) add(c, no_grain);
}

/// Index of the rigid body that a YADE body is, or is part of. A free grain becomes a rigid body by this call.
template <int D>
int MirrorOf<D>::body_index(int id)
{
	if (id < 0 || id >= int(map.body_of_id.size()) || (map.body_of_id[id] < 0 && map.grain_of_id[id] < 0))
		throw std::runtime_error("GrainLoop: contacts asked for body " + std::to_string(id) +
								 ", which is not in O.bodies; give the id that O.bodies.append returned");
	if (map.body_of_id[id] < 0 && is_free(map.grain_of_id[id])) {
		engine.watched.push_back(id);
		engine.note_watched();
		sync();
		build();
	}
	compute_body_forces();
	return map.body_of_id[id] >= 0 ? map.body_of_id[id] : stepper->settings().grains[map.grain_of_id[id]].body;
}

template <int D>
void MirrorOf<D>::contacts_on(int id, std::vector<BodyContact>& contacts)
{
	const int b = body_index(id);
	const bool one_of_many = map.body_id[b] != id;
	const Vector3r centre = one_of_many ? state_of(id).pos : Vector3r::Zero();
	touches.clear();
	stepper->touches_on(b, touches);
	const auto id_of = [&](std::uint32_t grain) {
		return grain < map.grain_id.size() ? map.grain_id[grain] : id_of_surface(grain - map.grain_id.size());
	};
	for (const Touch<D>& t : touches) {
		const int member = id_of(t.member), partner = id_of(t.partner);
		if (one_of_many && member != id) continue;
		Vector3r lever = in_yade<D>(t.arm);
		if (one_of_many) lever += in_yade<D>(stepper->bodies()[b].place) - Vector3r(centre[0], centre[1], D == 3 ? centre[2] : 0);
		contacts.push_back({ member, partner < 0 ? no_body : partner, lever, -t.normal * in_yade<D>(t.n),
			tangential_in_yade(t.n, t.friction), t.slipping });
	}
}

template <int D>
Wrench MirrorOf<D>::wrench_on(int id)
{
	const int b = body_index(id);
	Wrench sum;
	if (map.body_id[b] == id) {
		const RigidBody<D>& body = stepper->bodies()[b];
		return { in_yade<D>(body.force), spin_in_yade(body.torque) };
	}
	std::vector<BodyContact> contacts;
	contacts_on(id, contacts);
	for (const BodyContact& c : contacts) {
		sum.force += c.normal_force + c.tangential_force;
		sum.torque += c.lever.cross(c.normal_force + c.tangential_force);
	}
	return sum;
}

template <int D>
Table MirrorOf<D>::positions() const
{
	Table table{ std::vector<Real>(D * stepper->size()), D };
	stepper->positions(table.numbers.data());
	return table;
}

template <int D>
Table MirrorOf<D>::velocities() const
{
	Table table{ std::vector<Real>(D * stepper->size()), D };
	stepper->velocities(table.numbers.data());
	return table;
}

template <int D>
Table MirrorOf<D>::spins() const
{
	Table table{ std::vector<Real>(spin_axes(D) * stepper->size()), spin_axes(D) };
	stepper->spins(table.numbers.data());
	return table;
}

/// Id of the solid's body, or -2 - side for a wall.
template <int D>
int MirrorOf<D>::id_of_surface(std::uint32_t surface) const
{
	const Scene<D>& known = stepper->settings();
	if (surface < known.walls.size()) return first_wall - int(known.walls[surface].side);
	return map.body_id[known.solids[surface - known.walls.size()].body];
}

/// A contact in YADE's convention: the point is the middle of the overlap, in the image that touches i; the forces act on j,
/// YADE's body 2.
template <int D>
SeenContact MirrorOf<D>::seen(const Contact<D>& c, int partner) const
{
	return { map.grain_id[c.first], partner, c.slipping, c.overlap, slip_in_yade(c.slip),
		in_yade<D>(c.point - (c.overlap / 2) * c.n), in_yade<D>(c.n), c.normal * in_yade<D>(c.n),
		-tangential_in_yade(c.n, c.friction) };
}

template <int D>
std::vector<SeenContact> MirrorOf<D>::seen(const std::vector<Contact<D>>& pairs, const std::vector<Contact<D>>& surfaces) const
{
	std::vector<SeenContact> all;
	for (const Contact<D>& c : pairs) all.push_back(seen(c, map.grain_id[c.second]));
	for (const Contact<D>& c : surfaces) all.push_back(seen(c, id_of_surface(c.second)));
	return all;
}

template <int D>
std::vector<SeenContact> MirrorOf<D>::contacts()
{
	return seen(stepper->contacts(), {});
}

template <int D>
std::vector<SeenContact> MirrorOf<D>::present_contacts()
{
	const auto [pairs, surfaces] = stepper->look_between_steps();
	return seen(pairs, surfaces);
}

template <int D>
std::vector<SeenContact> MirrorOf<D>::surface_contacts() const
{
	return seen({}, stepper->surface_contacts());
}

template <int D>
std::vector<Wall<3>> MirrorOf<D>::walls() const
{
	std::vector<Wall<3>> all;
	for (const Wall<D>& wall : stepper->settings().walls) all.push_back(in_dimension<3>(wall));
	return all;
}

template <int D>
void MirrorOf<D>::set_wall(const Wall<3>& wall)
{
	stepper->set_wall(in_dimension<D>(wall));
	keep_walls();
}

template <int D>
void MirrorOf<D>::remove_wall(Side side)
{
	stepper->remove_wall(side);
	keep_walls();
}

template <int D>
double MirrorOf<D>::extent_of(const Wall<3>& wall) const
{
	return wall_extent(stepper->settings(), in_dimension<D>(wall));
}

template <int D>
void MirrorOf<D>::keep_walls()
{
	engine.keep_walls(walls());
	engine.wallSprings.clear();
	for (const SurfaceTouch<D>& t : stepper->surface_springs()) {
		if (t.slip == Spin<D>{}) continue;
		engine.wallSprings.insert(engine.wallSprings.end(), { Real(id_of_surface(t.surface)), Real(map.grain_id[t.grain]) });
		if constexpr (D == 2)
			engine.wallSprings.push_back(t.slip);
		else
			engine.wallSprings.insert(engine.wallSprings.end(), t.slip.coordinate, t.slip.coordinate + 3);
	}
}

/// Gives a loop that was just built the springs at walls and solids that the attribute wallSprings holds.
template <int D>
void MirrorOf<D>::bring_surface_springs()
{
	constexpr std::size_t width = D == 2 ? 3 : 5;
	const std::vector<Real>& kept = engine.wallSprings;
	const std::size_t surfaces = stepper->settings().walls.size() + stepper->settings().solids.size();
	std::vector<SurfaceTouch<D>> found;
	for (std::size_t k = 0; k + width <= kept.size(); k += width) {
		const auto id = std::size_t(kept[k + 1]);
		if (id >= map.grain_of_id.size() || map.grain_of_id[id] < 0) continue;
		for (std::uint32_t s = 0; s < surfaces; ++s) {
			if (id_of_surface(s) != int(kept[k])) continue;
			SurfaceTouch<D> touch;
			touch.surface = s, touch.grain = map.grain_of_id[id];
			if constexpr (D == 2)
				touch.slip = kept[k + 2];
			else
				touch.slip = { kept[k + 2], kept[k + 3], kept[k + 4] };
			found.push_back(touch);
		}
	}
	stepper->set_surface_springs(found);
}

template <int D>
void MirrorOf<D>::bring_loads()
{
	const std::vector<Real>& loads = engine.loads;
	for (std::size_t k = 0; k + 3 < loads.size(); k += 4) {
		const auto id = std::size_t(loads[k]);
		if (id >= map.body_of_id.size() || map.body_of_id[id] < 0) continue;
		stepper->bodies()[map.body_of_id[id]].load = in_loop<D>({ loads[k + 1], loads[k + 2], loads[k + 3] });
	}
}

template class MirrorOf<2>;
template class MirrorOf<3>;

}  // namespace graindrive::loop
