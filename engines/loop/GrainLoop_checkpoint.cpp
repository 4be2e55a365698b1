/// Writes a scene that runs on GrainLoop into one file, and reads it: the loop, YADE's bodies, drives and measures, to the last
/// bit.
#include <sstream>

#include "engines/loop/GrainLoop.hpp"
#include "engines/loop/checkpoint.hpp"
#include "engines/loop/yade_cell.hpp"
#include "engines/solids/Solid.hpp"

namespace graindrive {

namespace {

/// A body of YADE: its properties, which must agree between file and scene, and its motion.
struct BodyRecord {
	int exists = 0, clump = -1;
	Real radius = 0, mass = 0;
	std::uint64_t surface = 0;  // checksum of a solid's recipe
	unsigned blocked = 0;
	Real position[3] = {}, orientation[4] = {}, velocity[3] = {}, spin[3] = {}, momentum[3] = {};
};

void copy(const Vector3r& from, Real* to) { std::copy(from.data(), from.data() + 3, to); }
Vector3r vector(const Real* from) { return { from[0], from[1], from[2] }; }

BodyRecord record(const yade::BodyContainer& bodies, int id)
{
	BodyRecord r;
	if (!bodies.exists(id)) return r;
	const yade::Body& body = *bodies[id];
	const yade::State& s = *body.state;
	if (const auto* disk = dynamic_cast<const yade::Sphere*>(body.shape.get())) r.radius = disk->radius;
	if (is_solid(body.shape.get())) r.surface = loop::checksum_of(static_cast<const Solid&>(*body.shape).recipe);
	r.exists = 1, r.clump = body.clumpId, r.mass = s.mass, r.blocked = s.blockedDOFs;
	copy(s.pos, r.position), copy(s.vel, r.velocity), copy(s.angVel, r.spin), copy(s.angMom, r.momentum);
	std::copy(s.ori.coeffs().data(), s.ori.coeffs().data() + 4, r.orientation);
	return r;
}

void put(const BodyRecord& r, yade::State& s)
{
	s.blockedDOFs = r.blocked;
	s.pos = vector(r.position), s.vel = vector(r.velocity), s.angVel = vector(r.spin), s.angMom = vector(r.momentum);
	std::copy(r.orientation, r.orientation + 4, s.ori.coeffs().data());
}

/// O.cell of a scene whose cell deforms.
struct CellRecord {
	int deforms = 0, homo_deform = 0, gradient_changed = 0;
	Real numbers[7 * 9] = {};
};

/// Calls visit(matrix) for the complete state of a cell.
template <class ACell, class Visit>
void each_matrix(ACell& cell, Visit&& visit)
{
	for (auto* matrix :
		{ &cell.trsf, &cell.refHSize, &cell.hSize, &cell.prevHSize, &cell.velGrad, &cell.nextVelGrad, &cell.prevVelGrad })
		visit(*matrix);
}

CellRecord record(const yade::Cell& cell)
{
	CellRecord r{ loop::deforms(cell), cell.homoDeform, cell.velGradChanged, {} };
	Real* to = r.numbers;
	each_matrix(cell, [&](const auto& matrix) { to = std::copy(matrix.data(), matrix.data() + 9, to); });
	return r;
}

void put(const CellRecord& r, yade::Cell& cell)
{
	if (!r.deforms) return;
	cell.homoDeform = r.homo_deform, cell.velGradChanged = r.gradient_changed;
	const Real* from = r.numbers;
	each_matrix(cell, [&](auto& matrix) { std::copy(from, from + 9, matrix.data()), from += 9; });
}

/// An engine of O.engines; `attributes` and `state` are filled for Graindrive's engines only.
struct EngineRecord {
	std::string name, attributes, state;

	template <class Visit>
	void visit(Visit&& visit)
	{
		visit(name), visit(attributes), visit(state);
	}
};

EngineRecord record(const yade::Engine& engine)
{
	const auto* ours = dynamic_cast<const seam::Stateful*>(&engine);
	return { engine.getClassName() + (engine.label.empty() ? "" : " '" + engine.label + "'"), ours ? ours->attribute_names() : "",
		ours ? ours->packed() : "" };
}

std::string list(const std::vector<EngineRecord>& engines)
{
	std::string names;
	for (const EngineRecord& engine : engines) names += (names.empty() ? "" : ", ") + engine.name;
	return "[" + names + "]";
}

/// All that a file holds beside the loop. The scene that O.save wrote comes first, because it can be read without the rest.
struct Surroundings {
	std::string saved_scene;
	loop::YadeBodies map;
	std::vector<BodyRecord> bodies;
	std::vector<EngineRecord> engines;
	CellRecord cell;
	long iter = 0;
	Real time = 0;

	template <class Visit>
	void visit(Visit&& visit)
	{
		visit(saved_scene);
		visit(map.grain_id), visit(map.grain_of_id), visit(map.body_id), visit(map.body_of_id), visit(map.known_bodies);
		visit(map.frozen_id), visit(map.turned);
		visit(bodies), visit(cell), visit(iter), visit(time);
		auto count = std::uint64_t(engines.size());
		visit(count);
		engines.resize(count);
		for (EngineRecord& engine : engines) engine.visit(visit);
	}
};

Surroundings of(const yade::Scene& scene)
{
	Surroundings all;
	for (std::size_t id = 0; id < scene.bodies->size(); ++id) all.bodies.push_back(record(*scene.bodies, int(id)));
	for (const auto& engine : scene.engines) all.engines.push_back(record(*engine));
	if (scene.isPeriodic) all.cell = record(*scene.cell);
	all.iter = scene.iter, all.time = scene.time;
	return all;
}

std::string difference(const BodyRecord& saved, const BodyRecord& here)
{
	if (saved.exists != here.exists) return saved.exists ? "is not in the scene" : "is not in the checkpoint";
	if (saved.clump != here.clump) return "is in another clump";
	if (saved.radius != here.radius) return "has another radius";
	if (saved.surface != here.surface) return "has another surface";
	return saved.mass != here.mass ? "has another mass" : "";
}

/// Why the file does not fit the scene; empty if it does.
std::string misfit(const Surroundings& saved, const Surroundings& here)
{
	if (saved.bodies.size() != here.bodies.size())
		return "was written with " + std::to_string(saved.bodies.size()) + " bodies, the scene has " +
		       std::to_string(here.bodies.size());
	for (std::size_t id = 0; id < saved.bodies.size(); ++id) {
		const std::string what = difference(saved.bodies[id], here.bodies[id]);
		if (!what.empty()) return "does not fit: body " + std::to_string(id) + " " + what;
	}
	if (list(saved.engines) != list(here.engines))
		return "was written with the engines " + list(saved.engines) + ", the scene has " + list(here.engines);
	for (std::size_t e = 0; e < saved.engines.size(); ++e)
		if (saved.engines[e].attributes != here.engines[e].attributes)
			return "was written by another build: attributes of " + saved.engines[e].name + " differ";
	return "";
}

/// The physics of a loop by name; these values must agree between a file and the scene that reads it.
std::vector<std::pair<std::string, std::string>> physics(GrainLoop& loop)
{
	std::vector<std::pair<std::string, std::string>> all;
	GrainLoop::attributes([&](const std::string& name, auto member, const char*) {
		using Value = std::decay_t<decltype(loop.*member)>;
		std::ostringstream value;
		value.precision(17);
		if constexpr (std::is_same_v<Value, bool>)
			value << loop.*member;
		else if constexpr (std::is_same_v<Value, Vector3r>)
			value << (loop.*member).transpose();
		else if constexpr (std::is_same_v<Value, Real> || std::is_same_v<Value, std::string>)
			value << loop.*member;
		const bool may_differ =
			name == "skin" || name == "largestOverlap" || name == "targetAreaFraction" || name == "trackEnergy";
		if (!value.str().empty() && !may_differ) all.push_back({ name, value.str() });
	});
	return all;
}

/// Why the loop's settings in the file do not fit those of the scene; empty if they do. The periods of a cell that deforms follow
/// the cell, so they are not compared.
std::string misfit(GrainLoop& saved, GrainLoop& here, bool periods_follow)
{
	const auto before = physics(saved), now = physics(here);
	for (std::size_t k = 0; k < before.size(); ++k)
		if (before[k].second != now[k].second && !(periods_follow && before[k].first == "periods"))
			return "was written with GrainLoop." + before[k].first + " = " + before[k].second + ", the scene has " +
			       now[k].second;
	return "";
}

std::string misfit_of_time_steps(Real saved, Real here)
{
	std::ostringstream words;
	words.precision(17);
	if (saved != here) words << "was written with O.dt = " << saved << ", the scene has " << here;
	return words.str();
}

}  // namespace

void GrainLoop::save_checkpoint(const std::string& path, const std::string& saved_scene)
{
	const Turn turn = take_turn();
	running();
	sync();
	Surroundings all = of(*scene);
	all.saved_scene = saved_scene;
	all.map = mirror_->map;
	loop::Packer pack;
	all.visit(pack);
	running().save(path, pack.bytes);
}

std::string GrainLoop::saved_scene(const std::string& path)
{
	const std::string text = loop::read_companion(path);
	std::string scene;
	loop::Unpacker{ text }(scene);
	return scene;
}

void GrainLoop::restore_checkpoint(const std::string& path)
{
	const Turn turn = take_turn();
	if (!scene) throw std::runtime_error("GrainLoop is in no scene yet; put it into O.engines and run a step first");
	const auto require_fit = [&](const std::string& why) {
		if (!why.empty()) throw std::runtime_error("checkpoint " + path + ": " + why + "; build the same scene first");
	};
	std::string text;
	auto restored = loop::mirror_from(*this, path, text);
	loop::Unpacker unpack(text);
	Surroundings saved;
	saved.visit(unpack);
	require_fit(misfit(saved, of(*scene)));
	GrainLoop settings;
	for (std::size_t e = 0; e < saved.engines.size(); ++e)
		if (scene->engines[e].get() == this) settings.unpack(saved.engines[e].state);
	require_fit(misfit(settings, *this, saved.cell.deforms));
	require_fit(misfit_of_time_steps(restored->time_step(), scene->dt));

	for (std::size_t id = 0; id < saved.bodies.size(); ++id)
		if (saved.bodies[id].exists) put(saved.bodies[id], *(*scene->bodies)[id]->state);
	for (std::size_t e = 0; e < saved.engines.size(); ++e)
		if (auto* ours = dynamic_cast<seam::Stateful*>(scene->engines[e].get()); ours && scene->engines[e].get() != this)
			ours->unpack(saved.engines[e].state);
	if (scene->isPeriodic) put(saved.cell, *scene->cell);
	scene->iter = saved.iter, scene->time = saved.time;
	mirror_ = std::move(restored);
	mirror_->map = saved.map;
	read_from_ = scene;
	run_end_ = -2;
	watched = settings.watched, loads = settings.loads, periods = settings.periods;
	note_what_was_built();
	mirror_->go_on_from_checkpoint();
	trackEnergy = mirror_->energies() != nullptr;
	targetAreaFraction = mirror_->target_fraction();
	mirror_->write_bodies();
	sync();
}

}  // namespace graindrive
