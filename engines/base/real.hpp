/// The number and vector types of every engine: YADE's own (double precision, Eigen), without YADE's headers.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace graindrive {

using Real = double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Vector2r = Eigen::Matrix<Real, 2, 1>;
using Quaternionr = Eigen::Quaternion<Real>;

constexpr Real pi = 3.14159265358979323846;

}  // namespace graindrive
