/// YADE's scene and the running loop, kept equal: what GrainLoop asks of it, whatever the dimension.
#pragma once
#include <memory>
#include <optional>

#include "engines/base/contact_view.hpp"
#include "engines/base/grain_view.hpp"
#include "engines/loop/energy_ledger.hpp"
#include "engines/loop/yade_scene.hpp"

namespace graindrive {

class GrainLoop;

namespace loop {

/// A contact as Python sees it; vectors in the plane have z = 0.
struct SeenContact {
	int i, j;  ///< ids of YADE; j = -2 - side of a wall, or the id of a solid's body
	bool slipping;
	Real overlap;
	Vector3r slip;  ///< spring [m], or force [N]; in the plane its x is the number along z x n
	Vector3r point, normal, normal_force, tangential_force;  ///< [m]; from i to j; on j [N]
};

/// Numbers of all grains, `columns` each.
struct Table {
	std::vector<Real> numbers;
	int columns;
};

class Mirror {
public:
	virtual ~Mirror() = default;
	YadeBodies map;

	// A step, in this order.
	virtual void hear_bodies() = 0;
	virtual void require_bodies(bool all) const = 0;
	virtual void require_materials() const = 0;
	virtual void read_anew_what_changed() = 0;
	virtual void compute_body_forces() = 0;
	virtual void follow_bodies() = 0;
	virtual void take_outside_forces() = 0;
	/// O.cell at the present positions; and the values set for the next step.
	virtual void follow_cell() = 0;
	virtual void take_next_flow() = 0;
	virtual void step() = 0;
	virtual void write_bodies() = 0;
	/// All bodies have been written to YADE since other code may last have changed them.
	virtual void close() = 0;
	virtual bool is_open() const = 0;

	virtual void sync() = 0;
	virtual void take_back_body_forces() = 0;
	virtual void begin_on_step() = 0;
	/// Settings of GrainLoop, its guards and loads, as they are now.
	virtual void change_settings() = 0;
	virtual void bring_settings_of_step() = 0;
	virtual void bring_loads() = 0;
	/// A non-periodic axis of the loop must be longer in the cell than the scene: YADE finds contacts across it.
	virtual void require_spread() const = 0;

	virtual int body_index(int id) = 0;
	virtual void contacts_on(int id, std::vector<BodyContact>& contacts) = 0;
	virtual Wrench wrench_on(int id) = 0;
	virtual void look(SceneView& view, bool with_contacts) = 0;

	virtual Table positions() const = 0;
	virtual Table velocities() const = 0;
	virtual Table spins() const = 0;
	virtual std::vector<SeenContact> contacts() = 0;
	/// At the present positions, walls and solids among them.
	virtual std::vector<SeenContact> present_contacts() = 0;
	virtual std::vector<SeenContact> surface_contacts() const = 0;

	virtual std::vector<Wall<3>> walls() const = 0;
	virtual void set_wall(const Wall<3>& wall) = 0;
	virtual void remove_wall(Side side) = 0;
	/// Length [m] or area [m^2] that a pressure acts on.
	virtual double extent_of(const Wall<3>& wall) const = 0;
	virtual double filled_fraction() const = 0;
	virtual double target_fraction() const = 0;
	/// Springs of pairs and surfaces, and walls, into the attributes of GrainLoop.
	virtual void keep_walls() = 0;

	virtual const Energies* energies() const = 0;
	virtual std::vector<double> work_by_body() const = 0;
	virtual double kinetic_energy() const = 0;
	virtual double kinetic_energy_on_step() = 0;
	virtual long searches() const = 0;
	virtual std::string processor() const = 0;
	virtual bool step_under_way() const = 0;
	virtual double time_step() const = 0;

	/// After the map of a restored scene is known.
	virtual void go_on_from_checkpoint() = 0;
	virtual void save(const std::string& path, const std::string& companion) = 0;
};

/// Reads GrainLoop's scene from YADE's bodies. @throws std::invalid_argument for bodies that the loop cannot move
std::unique_ptr<Mirror> mirror_of(GrainLoop& engine);
/// From a checkpoint; `companion` gets the caller's text. @throws std::runtime_error as Stepper::restore
std::unique_ptr<Mirror> mirror_from(GrainLoop& engine, const std::string& path, std::string& companion);
/// What building would demand of the bodies.
void require_readable(GrainLoop& engine);

}  // namespace loop
}  // namespace graindrive
