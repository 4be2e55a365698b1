/// What the drives share: a clock that does not drift, and the force, torque and work between the driven bodies and the grains.
#pragma once
#include <boost/smart_ptr/weak_ptr.hpp>
#include <cmath>

#include "engines/base/step_clock.hpp"
#include "engines/seam/registered.hpp"
#include "engines/seam/scene_contacts.hpp"

namespace graindrive {

/// Base of every drive. Stands in O.engines after the contacts and before the integrator.
///
/// A drive knows where the closed form puts a body at the end of this step and gives it the velocity that takes it there
/// from where it is, v = (X(t + dt) - x)/dt: the leapfrog's mid-step velocity. Round-off therefore does not add up.
///
/// The closed form holds for a leg of the motion. A new leg begins, at the present place and phase, where settings were
/// assigned, where steps passed without the drive (`dead`), and where something else has moved the body. Time counts the steps
/// in which the drive acts.
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
		visit("force", &Drive::force, "force of the grains on the driven bodies, at the last step [N]");
		visit("torque", &Drive::torque,
			"torque of the grains about the body's centre (a drum's axisPoint), at the last step [N m]");
		visit("elapsed", &Drive::elapsed,
			"time over which the drive has acted, at the start of the last step [s]; steps in which it was dead do not count");
		visit("leg", &Drive::leg, "settings at the start of the present leg of the motion, as numbers");
		visit("legTime", &Drive::legTime, "`elapsed` at the start of the leg [s]");
		visit("anchorStep", &Drive::anchorStep, "step from which the drive's time is counted; -1 before the first step");
		visit("anchorTime", &Drive::anchorTime, "time that the drive had acted at that step [s]");
		visit("anchorDt", &Drive::anchorDt, "time step since then [s]");
		visit("lastStep", &Drive::lastStep, "last step that the drive acted in");
	}

	bool reads_all_bodies() const override { return false; }

	Real work = 0;
	Vector3r force = Vector3r::Zero();
	Vector3r torque = Vector3r::Zero();
	Real elapsed = 0, legTime = 0;
	std::vector<Real> leg;
	long anchorStep = -1, lastStep = -1;
	Real anchorTime = 0, anchorDt = 0;

protected:
	/// Advances the clock; true if a new leg must begin: at the first step in a scene, after a rest, or with other settings.
	bool leg_ends(const std::vector<Real>& settings)
	{
		settle_in();
		StepClock clock{ anchorStep, anchorTime, anchorDt, lastStep };
		const bool rested = this->scene->iter > lastStep + 1;
		elapsed = clock.at(this->scene->iter, this->scene->dt);
		anchorStep = clock.anchor_step, anchorTime = clock.anchor_time, anchorDt = clock.dt, lastStep = clock.last_step;
		return rested || settings != leg;
	}
	void begin_leg(const std::vector<Real>& settings) { leg = settings, legTime = elapsed; }
	bool first_leg() const { return leg.empty(); }

	/// Time since the leg began, at the start and at the end of this step.
	Real leg_now() const { return elapsed - legTime; }
	Real leg_end() const { return StepClock{ anchorStep, anchorTime, anchorDt, lastStep }.next() - legTime; }

	/// True where `now` is further from the closed form than round-off of numbers of that `size` explains.
	static bool displaced(Real now, Real expected, Real size) { return std::abs(now - expected) > 1e-12 * size; }

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
	/// Origin and time belong to one scene: in the next one, after O.reset, the drive starts again.
	void settle_in()
	{
		const auto same = [](const auto& a, const auto& b) { return !a.owner_before(b) && !b.owner_before(a); };
		const boost::weak_ptr<yade::Factorable> here = this->scene->weak_from_this(), nowhere;
		if (same(here, home_)) return;
		if (!home_.expired())
			throw std::runtime_error(std::string(Self::class_name) + " began in another scene; make a new drive for every scene");
		if (!same(home_, nowhere)) anchorStep = lastStep = -1, anchorTime = work = 0, leg.clear();
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
		visit("taken", &BodyDrive::taken, "degrees of freedom that the drive blocked and that were free before, as bits");
		Drive<Self>::common_attributes(visit);
	}

	int body = -1;
	unsigned taken = 0;

protected:
	yade::State& driven_state() const { return this->state_of(body); }

	/// Asks for the forces of the grains. First of all: GrainLoop then brings the body's state up to date, if it was a free grain.
	void feel_grains()
	{
		grains_ = this->wrench_on(body);
		this->force = grains_.force, this->torque = grains_.torque;
	}

	void impose(yade::State& state, unsigned dofs, const Vector3r& velocity, const Vector3r& spin)
	{
		taken |= dofs & ~state.blockedDOFs;
		Drive<Self>::impose(state, dofs, velocity, spin, grains_);
	}

	/// Settings begin with the body: the one before gets back what it had free, and so does this one where less is driven.
	void give_back(unsigned dofs)
	{
		if (this->first_leg()) taken = 0;
		if (!taken) return;
		const int before = int(this->leg.front());
		const unsigned kept = before == body ? dofs : 0u;
		if (this->scene->bodies->exists(before)) (*this->scene->bodies)[before]->state->blockedDOFs &= ~(taken & ~kept);
		taken &= kept;
	}

private:
	Wrench grains_;
};

}  // namespace graindrive
