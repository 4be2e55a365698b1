/// What the drives share: a clock that does not drift, and the force, torque and work between the driven bodies and the grains.
#pragma once
#include <boost/smart_ptr/weak_ptr.hpp>

#include "engines/base/step_clock.hpp"
#include "engines/seam/registered.hpp"
#include "engines/seam/scene_contacts.hpp"

namespace graindrive {

/// Base of every drive. Stands in O.engines after the contacts and before the integrator.
///
/// A drive knows where the closed form puts a body at the end of this step and gives it the velocity that takes it there
/// from where it is, v = (X(t + dt) - x)/dt: the leapfrog's mid-step velocity. Round-off therefore does not add up.
///
/// Work [J] on the grains through the contacts: W = -sum (F . v + T . omega) dt, with force F and torque T of the grains on
/// the body at x_n and the mean of the velocities before and after, (v_{n-1/2} + v_{n+1/2})/2, which makes the sum the
/// leapfrog's exact energy balance. Only driven degrees of freedom count.
template <class Self>
class Drive : public Registered<Self> {
public:
	template <class Visit>
	static void common_attributes(Visit&& visit)
	{
		visit("work", &Drive::work, "work done on the grains so far, through the driven degrees of freedom [J]");
		visit("force", &Drive::force, "force of the grains on what is driven, at the last step [N]");
		visit("torque", &Drive::torque,
			"torque of the grains about the body's centre (a drum's axisPoint), at the last step [N m]");
		visit("elapsed", &Drive::elapsed, "time since the drive began, at the start of the last step [s]");
		visit("anchorStep", &Drive::anchorStep, "step that the drive's time is counted from; -1 before the first step");
		visit("anchorTime", &Drive::anchorTime, "time since the drive began at that step [s]");
		visit("anchorDt", &Drive::anchorDt, "time step since then [s]");
		visit("lastStep", &Drive::lastStep, "last step that the drive acted in");
	}

	bool reads_all_bodies() const override { return false; }

	Real work = 0;
	Vector3r force = Vector3r::Zero();
	Vector3r torque = Vector3r::Zero();
	Real elapsed = 0;
	long anchorStep = -1, lastStep = -1;
	Real anchorTime = 0, anchorDt = 0;

protected:
	/// Advances the clock; true at the very first step in a scene, when a drive takes its origin.
	bool begins()
	{
		settle_in();
		StepClock clock{ anchorStep, anchorTime, anchorDt, lastStep };
		const bool first = !clock.started();
		elapsed = clock.at(this->scene->iter, this->scene->dt);
		anchorStep = clock.anchor_step, anchorTime = clock.anchor_time, anchorDt = clock.dt, lastStep = clock.last_step;
		return first;
	}
	Real end_of_step() const { return StepClock{ anchorStep, anchorTime, anchorDt, lastStep }.next(); }

	/// @throws std::runtime_error for a body that is not there, or a clump's member: its clump moves it
	yade::State& state_of(int id) const
	{
		const yade::Body& body = body_of(*this->scene, id, Self::class_name);
		if (body.isClumpMember())
			throw std::runtime_error(std::string(Self::class_name) + ": body " + std::to_string(id) + " is a member of clump " +
									 std::to_string(body.clumpId) + ", which moves it; drive the clump");
		return *body.state;
	}

	Wrench wrench_on(int body) { return contacts_.of(this->scene).wrench_on(body); }

	/// Imposes velocity and spin on the degrees of freedom in `dofs` (State::DOF_* bits) and books the work against the grains.
	void impose(yade::State& state, unsigned dofs, const Vector3r& velocity, const Vector3r& spin, const Wrench& grains)
	{
		const Real half_dt = this->scene->dt / 2;
		state.blockedDOFs |= dofs;
		for (int i = 0; i < 3; ++i) {
			if (dofs & (yade::State::DOF_X << i)) {
				work -= grains.force[i] * (state.vel[i] + velocity[i]) * half_dt;
				state.vel[i] = velocity[i];
			}
			if (dofs & (yade::State::DOF_RX << i)) {
				work -= grains.torque[i] * (state.angVel[i] + spin[i]) * half_dt;
				state.angVel[i] = spin[i];
			}
		}
	}

private:
	/// Origin and time belong to one scene: in the next one, after O.reset, the drive begins anew.
	void settle_in()
	{
		const auto same = [](const auto& a, const auto& b) { return !a.owner_before(b) && !b.owner_before(a); };
		const boost::weak_ptr<yade::Factorable> here = this->scene->weak_from_this(), nowhere;
		if (same(here, home_)) return;
		if (!home_.expired())
			throw std::runtime_error(std::string(Self::class_name) + " began in another scene; make one for every scene");
		if (!same(home_, nowhere)) anchorStep = lastStep = -1, anchorTime = work = 0;
		home_ = here;
		require_place();
	}

	/// Behind the integrator a drive would impose the velocity of a step that is over.
	void require_place() const
	{
		std::string integrator;
		for (const auto& engine : this->scene->engines) {
			if (engine.get() == this && !integrator.empty())
				throw std::runtime_error(std::string(Self::class_name) + " stands after " + integrator +
										 " in O.engines; put it before, behind the contacts");
			const std::string name = engine->getClassName();
			if (name == "NewtonIntegrator" || name == "GrainLoop") integrator = name;
		}
	}

	SceneContacts contacts_;
	boost::weak_ptr<yade::Factorable> home_;  // scene that the drive began in
};

/// Base of the drives of one body or clump.
template <class Self>
class BodyDrive : public Drive<Self> {
public:
	template <class Visit>
	static void common_attributes(Visit&& visit)
	{
		visit("body", &BodyDrive::body, "id of the driven body or clump");
		Drive<Self>::common_attributes(visit);
	}

	int body = -1;

protected:
	yade::State& driven_state() const { return this->state_of(body); }

	void impose(yade::State& state, unsigned dofs, const Vector3r& velocity, const Vector3r& spin)
	{
		const Wrench grains = this->wrench_on(body);
		this->force = grains.force, this->torque = grains.torque;
		Drive<Self>::impose(state, dofs, velocity, spin, grains);
	}
};

}  // namespace graindrive
