/// Vectors of two or three coordinates, so that one text serves both dimensions.
///
/// Sums run in the order x, y, z. In two dimensions the arithmetic is that of `x` and `y` written out: the same bits.
#pragma once
#include <algorithm>
#include <cmath>
#include <type_traits>

namespace graindrive::geometry {

/// An aggregate that can be copied as bytes: `Vec<3>{ 1, 2, 3 }`; coordinates that are not given are 0.
template <int D>
struct Vec {
	static_assert(D == 2 || D == 3, "space has two or three dimensions");
	double coordinate[D] = {};

	constexpr double& operator[](int k) { return coordinate[k]; }
	constexpr const double& operator[](int k) const { return coordinate[k]; }

	constexpr Vec& operator+=(const Vec& b)
	{
		for (int k = 0; k < D; ++k) coordinate[k] += b[k];
		return *this;
	}
	constexpr Vec& operator-=(const Vec& b)
	{
		for (int k = 0; k < D; ++k) coordinate[k] -= b[k];
		return *this;
	}
	constexpr Vec& operator*=(double factor)
	{
		for (int k = 0; k < D; ++k) coordinate[k] *= factor;
		return *this;
	}
	constexpr Vec& operator/=(double divisor)
	{
		for (int k = 0; k < D; ++k) coordinate[k] /= divisor;
		return *this;
	}

	/// The unit vector along axis k.
	static constexpr Vec along(int k)
	{
		Vec unit;
		unit[k] = 1;
		return unit;
	}

	/// The same number in all coordinates.
	static constexpr Vec all(double number)
	{
		Vec same;
		for (int k = 0; k < D; ++k) same[k] = number;
		return same;
	}
};

template <int D>
constexpr Vec<D> operator+(Vec<D> a, const Vec<D>& b)
{
	return a += b;
}

template <int D>
constexpr Vec<D> operator-(Vec<D> a, const Vec<D>& b)
{
	return a -= b;
}

template <int D>
constexpr Vec<D> operator-(Vec<D> a)
{
	for (int k = 0; k < D; ++k) a[k] = -a[k];
	return a;
}

template <int D>
constexpr Vec<D> operator*(Vec<D> a, double factor)
{
	return a *= factor;
}

template <int D>
constexpr Vec<D> operator*(double factor, Vec<D> a)
{
	return a *= factor;
}

template <int D>
constexpr Vec<D> operator/(Vec<D> a, double divisor)
{
	return a /= divisor;
}

template <int D>
constexpr bool operator==(const Vec<D>& a, const Vec<D>& b)
{
	for (int k = 0; k < D; ++k)
		if (!(a[k] == b[k])) return false;
	return true;
}

template <int D>
constexpr bool operator!=(const Vec<D>& a, const Vec<D>& b)
{
	return !(a == b);
}

template <int D>
constexpr double dot(const Vec<D>& a, const Vec<D>& b)
{
	double sum = a[0] * b[0];
	for (int k = 1; k < D; ++k) sum += a[k] * b[k];
	return sum;
}

template <int D>
constexpr double squared_norm(const Vec<D>& a)
{
	return dot(a, a);
}

template <int D>
double norm(const Vec<D>& a)
{
	return std::sqrt(squared_norm(a));
}

/// The largest coordinate without its sign.
template <int D>
constexpr double largest(const Vec<D>& a)
{
	double most = 0;
	for (int k = 0; k < D; ++k) most = std::max(most, a[k] < 0 ? -a[k] : a[k]);
	return most;
}

template <int D>
bool is_finite(const Vec<D>& a)
{
	for (int k = 0; k < D; ++k)
		if (!std::isfinite(a[k])) return false;
	return true;
}

/// a/|a|, also where |a|^2 is too large or too small for a number. Not for the zero vector.
template <int D>
Vec<D> unit(const Vec<D>& a)
{
	const Vec<D> scaled = a / largest(a);
	return scaled / norm(scaled);
}

/// In two dimensions the vector product is a number: its component out of the plane.
constexpr double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }
constexpr Vec<3> cross(const Vec<3>& a, const Vec<3>& b)
{
	return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

/// Angular velocities, torques and rotation vectors: one number in the plane, counter-clockwise > 0, a vector in space.
template <int D>
using Spin = std::conditional_t<D == 2, double, Vec<3>>;

/// omega x r: the velocity of a point at `arm` from the centre. In space it is the vector product above.
constexpr Vec<2> cross(double spin, const Vec<2>& arm) { return { -spin * arm[1], spin * arm[0] }; }

static_assert(std::is_trivially_copyable_v<Vec<2>> && std::is_trivially_copyable_v<Vec<3>>);
static_assert(std::is_aggregate_v<Vec<2>> && sizeof(Vec<2>) == 16 && sizeof(Vec<3>) == 24);

}  // namespace graindrive::geometry
