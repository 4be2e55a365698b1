/// The mirror of a scene of disks (D = 2) or spheres (D = 3).
#pragma once
#include "engines/loop/GrainLoop.hpp"
#include "engines/loop/mirror.hpp"
#include "engines/loop/stepper.hpp"

namespace graindrive::loop {

/// @throws std::runtime_error naming the body if other code has written a motion that is not finite
void require_finite(const yade::State& state, int id);

template <int D>
class MirrorOf : public Mirror {
public:
	/// From YADE's bodies.
	explicit MirrorOf(GrainLoop& engine);
	/// Round a loop that goes on.
	MirrorOf(GrainLoop& engine, std::unique_ptr<Stepper<D>> running) : engine(engine), stepper(std::move(running)) {}

	static Scene<D> settings_of(const GrainLoop& engine);

	void hear_bodies() override;
	void require_bodies(bool all) const override;
	void require_materials() const override;
	void read_anew_what_changed() override;
	void compute_body_forces() override;
	void follow_bodies() override;
	void take_outside_forces() override;
	void follow_cell() override;
	void take_next_flow() override;
	void step() override;
	void write_bodies() override;
	void close() override { open = false; }
	bool is_open() const override { return open; }

	void sync() override;
	void take_back_body_forces() override { stepper->take_back_body_forces(); }
	void begin_on_step() override { stepper->begin_on_step(); }
	void change_settings() override { stepper->change(settings_of(engine)); }
	void bring_settings_of_step() override;
	void bring_loads() override;
	void require_spread() const override;

	int body_index(int id) override;
	void contacts_on(int id, std::vector<BodyContact>& contacts) override;
	Wrench wrench_on(int id) override;
	void look(SceneView& view, bool with_contacts) override;

	Table positions() const override;
	Table velocities() const override;
	Table spins() const override;
	std::vector<SeenContact> contacts() override;
	std::vector<SeenContact> present_contacts() override;
	std::vector<SeenContact> surface_contacts() const override;

	std::vector<Wall<3>> walls() const override;
	void set_wall(const Wall<3>& wall) override;
	void remove_wall(Side side) override;
	double extent_of(const Wall<3>& wall) const override;
	double filled_fraction() const override { return loop::filled_fraction(stepper->settings()); }
	double target_fraction() const override { return stepper->settings().target_fraction; }
	void keep_walls() override;

	const Energies* energies() const override;
	std::vector<double> work_by_body() const override { return stepper->energy_ledger()->work_by_body(); }
	double kinetic_energy() const override { return stepper->kinetic_energy(); }
	double kinetic_energy_on_step() override { return stepper->kinetic_energy_on_step(); }
	long searches() const override { return stepper->searches_done(); }
	std::string processor() const override { return name_of(stepper->processor_in_use()); }
	bool step_under_way() const override { return stepper->step_under_way(); }
	double time_step() const override { return stepper->settings().dt; }

	void save(const std::string& path, const std::string& companion) override { stepper->save(path, companion); }
	void go_on_from_checkpoint() override;

private:
	GrainLoop& engine;
	std::unique_ptr<Stepper<D>> stepper;
	std::vector<Touch<D>> touches;

	/// A grain as stored in YADE's body: its motion, and data whose change requires reading the scene again.
	struct Written {
		Real place[3], velocity[3], spin[3], mass, inertia[3], radius;
		const void* material;
		unsigned blocked;
		int mask, clump, flags, damped;
		bool operator==(const Written& other) const;
	};
	std::vector<Written> written;  // by grain, at the last sync
	bool open = false;             // other code may have written into bodies since then

	/// Mass and inertia of a body in its pairs, as read with the scene.
	struct Counted {
		Real mass, inertia[3];
		bool held, damped;    // held: all its directions are blocked
		const void* surface;  // of a solid
	};
	std::vector<Counted> counted;  // by rigid body
	struct KnownMaterial {
		boost::shared_ptr<yade::Material> material;
		Real young, poisson, friction_angle;
	};
	std::vector<KnownMaterial> materials;
	bool pushed = false;

	yade::Scene& scene() const { return *engine.scene; }
	const yade::Body& body_of_yade(int id) const { return *(*scene().bodies)[id]; }
	yade::State& state_of(int id) const { return *body_of_yade(id).state; }

	void build();
	void note_what_was_built();
	template <class Work>
	void guarded(Work work);
	std::vector<Spring<D>> kept_springs() const;
	void bring_surface_springs();
	void write_grain(std::size_t grain);
	void remember_what_is_written();
	Written written_in(const yade::Body& body) const;
	bool is_member_or_body(std::size_t grain) const;
	bool is_free(std::size_t grain) const { return stepper->settings().grains[grain].body == free_grain; }
	bool set_in_motion() const;
	bool counts_otherwise() const;
	Counted counted_now(int id) const;
	void push_with(int id, const Vector3r& force, const Vector3r& torque, std::vector<Push<D>>& pushes);
	void refuse_off_plane(int id, const Vector3r& force, const Vector3r& torque) const;
	SeenContact seen(const Contact<D>& contact, int partner) const;
	int id_of_surface(std::uint32_t surface) const;
	std::vector<SeenContact> seen(const std::vector<Contact<D>>& pairs, const std::vector<Contact<D>>& surfaces) const;
};

/// The same wall with the axes that `To` dimensions have.
template <int To, int From>
Wall<To> in_dimension(const Wall<From>& wall)
{
	Wall<To> to;
	to.side = wall.side, to.position = wall.position, to.velocity = wall.velocity;
	to.pressed = wall.pressed, to.pressure = wall.pressure, to.mass = wall.mass, to.damping = wall.damping;
	to.speed_limit = wall.speed_limit;
	for (int k = 0; k < std::min(To, From); ++k) to.slide[k] = wall.slide[k], to.force[k] = wall.force[k];
	return to;
}

}  // namespace graindrive::loop
