/// The motion of a rigid body in space with matrices, for tests to hold the loop's quaternions to.
#pragma once
#include "engines/loop/stepper.hpp"

namespace graindrive::loop::test {

/// A body of a plain loop: it turns by Euler's equations, about single axes, or as prescribed.
class PlainBody {
public:
	RigidBody<3> b;
	Vector3r force{ 0, 0, 0 }, torque{ 0, 0, 0 };  // of contacts, in the last step

	explicit PlainBody(const RigidBody<3>& body) : b(body)
	{
		const geometry::Turn<3>& turn = body.turn;
		rotation = Quaternionr(turn.w, turn.u[0], turn.u[1], turn.u[2]).toRotationMatrix();
		momentum = moments(rotation) * for_law(b.spin);
	}

	Vec<3> to_frame(const Vec<3>& point) const { return from_law(rotation.transpose() * for_law(point - b.place)); }
	Vec<3> arm(const Vec<3>& in_frame) const { return from_law(rotation * for_law(in_frame)); }

	void push(const Vec<3>& arm, const Vec<3>& by)
	{
		force += for_law(by);
		torque += for_law(arm).cross(for_law(by));
	}

	void move(const Vec<3>& gravity, double dt)
	{
		if (b.frozen) return;
		for (int k = 0; k < 3; ++k)
			if (b.responds[k]) b.velocity[k] += ((force[k] + b.load[k] + b.push[k]) / b.mass + gravity[k]) * dt;
		turn(dt);
		b.place += dt * b.velocity;
		const Vector3r way = for_law(b.spin) * dt;
		rotation = rotation_by(way) * rotation;
	}

	double energy() const
	{
		return 0.5 * b.mass * geometry::squared_norm(b.velocity) + 0.5 * for_law(b.spin).dot(moments(rotation) * for_law(b.spin));
	}
	Vec<3> angular_momentum() const { return from_law(moments(rotation) * for_law(b.spin)); }

private:
	using Matrix3 = Eigen::Matrix<Real, 3, 3>;
	Matrix3 rotation;
	Vector3r momentum;

	Matrix3 moments(const Matrix3& r) const { return r * for_law(b.inertia).asDiagonal() * r.transpose(); }
	static Matrix3 rotation_by(const Vector3r& angle)
	{
		if (angle.norm() == 0) return Matrix3::Identity();
		return Eigen::AngleAxis<Real>(angle.norm(), angle.normalized()).toRotationMatrix();
	}

	/// Fincham's leapfrog of the angular momentum; the moment of inertia about an axis of the world where the others are held.
	void turn(double dt)
	{
		const Vector3r all = torque + for_law(b.push_torque);
		if (b.turns[0] && b.turns[1] && b.turns[2]) {
			const Vector3r at_step = momentum + dt / 2 * all;
			momentum += dt * all;
			const Vector3r spin_at_step = moments(rotation).inverse() * at_step;
			const Matrix3 halfway = rotation_by(dt / 2 * spin_at_step) * rotation;
			b.spin = from_law(moments(halfway).inverse() * momentum);
			return;
		}
		for (int k = 0; k < 3; ++k)
			if (b.turns[k]) b.spin[k] += all[k] / moments(rotation)(k, k) * dt;
	}
};

}  // namespace graindrive::loop::test
