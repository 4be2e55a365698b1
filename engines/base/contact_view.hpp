/// The contacts on one body as drives and measures see them, whichever loop runs.
#pragma once
#include <vector>

#include "engines/base/real.hpp"

namespace graindrive {

/// One contact on a body, or on a member of a clump.
struct BodyContact {
	int member;                 ///< id of the touched body: the body itself or the clump's member
	int partner;                ///< id of the other body
	Vector3r lever;             ///< from the centre of the body (the clump's centre for a member) to the contact point [m]
	Vector3r normal_force;      ///< on the body [N]
	Vector3r tangential_force;  ///< on the body [N]
	bool slipping;              ///< Coulomb's bound was active
};

/// Force and torque about the body's centre.
struct Wrench {
	Vector3r force = Vector3r::Zero();   ///< [N]
	Vector3r torque = Vector3r::Zero();  ///< [N m]
};

/// A source of the contacts at the present positions: YADE's interactions, or GrainLoop.
class ContactSource {
public:
	virtual ~ContactSource() = default;
	/// Appends the contacts on a body or clump, contacts of its own members among themselves left out.
	virtual void contacts_on(int body, std::vector<BodyContact>& contacts) = 0;
	/// Sum of the contact forces on a body or clump.
	virtual Wrench wrench_on(int body) = 0;
};

}  // namespace graindrive
