/// Surfaces that move: a shape, and the rigid motion of its frame.
#pragma once
#include "engines/geometry/refuse.hpp"
#include "engines/geometry/surface.hpp"
#include "engines/geometry/turn.hpp"

namespace graindrive::geometry {

/// Where the frame of a shape is and how it moves. Plain numbers: to be copied and stored as bytes.
template <int D>
struct RigidMotion {
	Vec<D> place;     ///< of the frame's origin [m]
	Turn<D> turn;     ///< of the frame
	Vec<D> velocity;  ///< of the frame's origin [m/s]
	Spin<D> spin{};   ///< [rad/s], seen from the world

	Vec<D> to_frame(const Vec<D>& point) const { return turn.undo(point - place); }
	Vec<D> to_world(const Vec<D>& point) const { return place + turn.apply(point); }

	/// v + omega x (x - place): the velocity of the body's material at a point of the world [m/s].
	Vec<D> velocity_at(const Vec<D>& point) const { return velocity + cross(spin, point - place); }

	/// After a time dt with velocity and spin held: exact for both.
	void advance(double dt)
	{
		place += dt * velocity;
		turn = turn.advanced(spin, dt);
	}

	/// A result in the body's frame, transformed to the world's frame.
	Nearest<D> nearest(const Surface<D>& shape, const Vec<D>& point) const
	{
		const Nearest<D> in_frame = shape.nearest(to_frame(point));
		return { in_frame.distance, turn.apply(in_frame.normal) };
	}

	/// The box parallel to the world's axes around a box of the frame.
	Bounds<D> bounds(const Bounds<D>& in_frame) const
	{
		std::array<Vec<D>, D> axes;
		for (int k = 0; k < D; ++k) axes[k] = turn.apply(Vec<D>::along(k));
		return moved_bounds<D>(in_frame, axes, place);
	}

	/// @throws std::invalid_argument unless all numbers are finite
	void check() const
	{
		require_finite("a surface's place", place);
		require_finite("a surface's velocity", velocity);
		require(turn.is_finite(), "a surface's orientation must be finite", "an orientation that is not", "correct it");
		require(std::isfinite(squared(spin)), "a surface's spin must be finite", spin, "correct it");
	}

private:
	static double squared(double number) { return number * number; }
	static double squared(const Vec<3>& vector) { return squared_norm(vector); }
};

static_assert(std::is_trivially_copyable_v<RigidMotion<2>> && std::is_trivially_copyable_v<RigidMotion<3>>);

/// A shape in another place, at rest: a part of a composition.
template <int D>
class Placed : public Surface<D> {
public:
	/// @throws std::invalid_argument without a shape, or for numbers that are not finite
	Placed(SharedSurface<D> shape, const Vec<D>& place, const Turn<D>& turn = {}) : shape_(std::move(shape))
	{
		require(shape_ != nullptr, "a placed surface needs a shape", "none", "give one");
		motion_.place = place;
		motion_.turn = turn.normalised();
		motion_.check();
	}
	Nearest<D> nearest(const Vec<D>& at) const override { return motion_.nearest(*shape_, at); }
	Bounds<D> bounds() const override { return motion_.bounds(shape_->bounds()); }
	double largest_sphere() const override { return shape_->largest_sphere(); }

private:
	SharedSurface<D> shape_;
	RigidMotion<D> motion_;
};

/// A shape and its motion, with which grains have contacts.
template <int D>
struct MovingSurface {
	SharedSurface<D> shape;
	RigidMotion<D> motion;

	Nearest<D> nearest(const Vec<D>& point) const { return motion.nearest(*shape, point); }
	Vec<D> velocity_at(const Vec<D>& point) const { return motion.velocity_at(point); }
	Bounds<D> bounds() const { return motion.bounds(shape->bounds()); }
	void advance(double dt) { motion.advance(dt); }

	/// @throws std::invalid_argument without a shape, or for numbers that are not finite
	void check() const
	{
		require(shape != nullptr, "a moving surface needs a shape", "none", "give one");
		motion.check();
	}
};

}  // namespace graindrive::geometry
