/// GrainLoop: one YADE engine in place of collider, interaction loop and integrator, for disks in a plane or spheres in space.
#pragma once
#include <memory>
#include <mutex>

#include "engines/base/contact_view.hpp"
#include "engines/base/grain_view.hpp"
#include "engines/loop/mirror.hpp"
#include "engines/seam/registered.hpp"

namespace graindrive {

class GrainLoop : public Registered<GrainLoop>, public ContactSource, public GrainSource {
public:
	static constexpr const char* class_name = "GrainLoop";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		using Self = GrainLoop;
		const auto given = [&](const char* name, Real Self::*member) { visit(name, member, laws::explained(name).c_str()); };
		visit("law", &Self::law,
			(laws::listed(laws::law_names(), " or ", "'") +
				": the law of the Law2_ functor of that name; cundallStrack and hertzMindlin are\n"
				"YADE's Law2_ScGeom_FrictPhys_CundallStrack, Law2_ScGeom_MindlinPhys_Mindlin, for disks of one material")
				.c_str());
		given("normalStiffness", &Self::normalStiffness);
		given("tangentialStiffness", &Self::tangentialStiffness);
		given("normalDamping", &Self::normalDamping);
		given("tangentialDamping", &Self::tangentialDamping);
		given("young", &Self::young);
		given("poisson", &Self::poisson);
		given("restitution", &Self::restitution);
		visit("friction", &Self::friction, "friction coefficient of every contact [-]; 0 switches friction and its history off");
		visit("dimensions", &Self::dimensions, "2 for disks in a plane z = const, 3 for spheres in space");
		visit("gravity", &Self::gravity, "acceleration [m/s^2]");
		visit("periods", &Self::periods, "periods of the box in x, y and z [m], 0 along axes that are not periodic");
		visit("precision", &Self::precision, "'double' or 'single', for contacts; positions and velocities are always double");
		visit("threads", &Self::threads, "number of threads; results have the same bits for any number");
		visit("skin", &Self::skin, "extra distance of the neighbour list [m]; 0: the loop chooses it");
		visit("largestOverlap", &Self::largestOverlap, "largest allowed overlap [smaller radius]; a larger one stops the run");
		visit("bounds", &Self::bounds,
			"xLow, yLow, xHigh, yHigh [m], in space xLow, yLow, zLow, xHigh, yHigh, zHigh: a centre outside stops the run;\n"
			"equal numbers: no bound along that axis. By default, with gravity, the bound is three diameters below the last\n"
			"frozen or driven disk. Walls are bounds in any case");
		visit("trusted", &Self::trusted,
			"names of engines in O.engines that GrainLoop does not know, but that only read and change bodies and add forces");
		visit("watched", &Self::watched,
			"ids of free disks that are handled as bodies; disks whose contacts a drive or measure needs are added");
		visit("syncEvery", &Self::syncEvery, "write all bodies to YADE after so many steps; 0: only at the end of O.run");
		visit("targetAreaFraction", &Self::targetAreaFraction,
			"fraction at which walls stop [-]: areas of disks, volumes of spheres, over the box between walls or periodic sides; "
			"0: they never stop");
		visit("trackEnergy", &Self::trackEnergy,
			"keep the energy ledger, see `energy`; it begins when this is switched on, and again after read(); a step then takes "
			"ten to thirty times as long");
		visit("loads", &Self::loads, "id, F_x, F_y, F_z [N] of constant forces on bodies, set by setLoad");
		visit("wallSettings", &Self::wallSettings, "eleven numbers per wall, set by setWall, at the last sync, for O.save");
		visit("wallSprings", &Self::wallSprings,
			"-2 - side of a wall or id of a solid, id, tangential spring [m] (in space its x, y, z), at the last sync, for "
			"O.save");
		visit("springs", &Self::springs,
			("id, id, tangential spring [m] (in space its x, y, z) of the contacts at the last sync, for O.save; with " +
				laws::laws_that_remember_forces() + " the\nelastic tangential force [N] that these laws remember")
				.c_str());
		given("normalDampingRatio", &Self::normalDampingRatio);
		given("tangentialDampingRatio", &Self::tangentialDampingRatio);
		visit("damping", &Self::damping,
			"Cundall's non-viscous damping [-] in [0, 1), like NewtonIntegrator.damping: a' = a (1 - damping sign(a (v + a "
			"dt/2)))");
		visit("dampGravity", &Self::dampGravity, "damping also acts on gravity, like NewtonIntegrator.dampGravity");
	}
	void check() const;
	void assigned(const std::string& name);
	void action() override;

	void contacts_on(int body, std::vector<BodyContact>& contacts) override;
	Wrench wrench_on(int body) override;
	void look(SceneView& view, bool with_contacts) override;

	/// Writes the loop's state into all of YADE's bodies.
	void sync();
	/// The same, unless they are up to date: changes that other code has made since are then not overwritten.
	void show_bodies();
	/// Python may call while the loop runs in the background: holding this lock guarantees that the loop is between two steps.
	using Turn = std::unique_lock<std::recursive_mutex>;
	Turn take_turn() const;
	/// For velocities of O.bodies that belong to the step itself, not half a step behind: takes the first step with half a kick.
	void begin_on_step();
	/// Reads the scene from YADE's bodies again at the next step, keeping the springs of contacts that persist.
	void read();
	/// What `build` demands of YADE's scene, before the first step.
	void require_scene();
	/// Writes loop, bodies and the engines of O.engines that are ours into one file; `saved_scene` is what O.save wrote, or nothing.
	void save_checkpoint(const std::string& path, const std::string& saved_scene);
	/// Continues from such a file in the same scene, built again or loaded. Changes nothing if it refuses the file.
	/// @throws std::runtime_error naming the file and its fault, or the part of the scene that does not fit
	void restore_checkpoint(const std::string& path);
	/// What O.save wrote when the file was made; empty if nothing.
	static std::string saved_scene(const std::string& path);
	/// Adds a flat wall or changes the one on its side.
	void set_wall(const loop::Wall<3>& wall);
	void remove_wall(loop::Side side);
	std::vector<loop::Wall<3>> walls() const;
	loop::Side side_named(const std::string& name) const;
	/// Sets a constant force on a body's free directions.
	void set_load(int body, const Vector3r& force);
	/// The running loop; made from YADE's bodies if there is none yet.
	loop::Mirror& running();

	// For the running loop.
	loop::ContactLaw contact_law() const;
	std::vector<loop::Wall<3>> kept_walls() const;  ///< as the attributes have them
	void keep_walls(const std::vector<loop::Wall<3>>& walls);
	void note_watched() { built_watched_ = watched; }
	long forces_reset_at = -1;  ///< syncCount of YADE's force container after the loop has emptied it

	std::string law = "hertzHistory", precision = "double";
	Real normalStiffness = 2e6, tangentialStiffness = 2.46e6, normalDamping = 2500, tangentialDamping = 2500;
	Real young = 5e6, poisson = 0.45, restitution = 0.6, friction = 0.1, skin = 0, largestOverlap = 0.1;
	Vector3r gravity = Vector3r::Zero(), periods = Vector3r::Zero();
	int threads = 1, dimensions = 2;
	long syncEvery = 0;
	std::vector<int> watched;
	std::vector<std::string> trusted;
	static constexpr std::size_t numbers_per_wall = 11;  ///< in wallSettings
	std::vector<Real> springs, loads, wallSettings, wallSprings, bounds;
	Real targetAreaFraction = 0;
	bool trackEnergy = false;
	Real normalDampingRatio = 0, tangentialDampingRatio = 0, damping = 0;
	bool dampGravity = true;

private:
	mutable std::recursive_mutex busy_;
	std::unique_ptr<loop::Mirror> mirror_;
	yade::Scene* read_from_ = nullptr;
	long run_end_ = -2;

	/// An engine of O.engines that may read or change any body, and whether it acts behind the loop in a step.
	struct Onlooker {
		const yade::Engine* engine;
		bool behind;
	};
	std::vector<Onlooker> onlookers_;
	std::vector<const yade::Engine*> met_engines_;
	std::vector<bool> met_dead_;

	bool settings_changed_ = false;
	std::vector<int> built_watched_;
	Vector3r built_periods_ = Vector3r::Zero();
	int built_dimensions_ = 0;
	Eigen::Matrix<Real, 3, 3> built_cell_ = Eigen::Matrix<Real, 3, 3>::Zero();
	bool built_deforming_ = false;
	Eigen::Matrix<Real, 3, 3> followed_ = Eigen::Matrix<Real, 3, 3>::Zero();  // O.cell.hSize that the loop knows

	Real number(const std::string& name) const;
	void check_material() const;
	void make_step();
	void build();
	void note_what_was_built();
	void require_periods() const;
	bool last_step_of_run() const;
	void meet_engines();
	bool someone_may_look() const;
	void hear_settings();
	void require_cell();
	void follow_cell();
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::GrainLoop, "GrainLoop")
