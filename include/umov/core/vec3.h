#pragma once
// Vectors that know their frame: adding across frames does not compile.

#include <cmath>

namespace umov {

/// Frame tags.
struct Teme {};  ///< true equator, mean equinox of date: the frame of SGP4
struct Gcrs {};  ///< geocentric celestial reference system
struct Itrs {};  ///< Earth-fixed
struct Enu {};   ///< east, north, up at a site
struct Body {};  ///< fixed in the object
struct Facet {}; ///< fixed in a surface element, z along its normal

/// Components of a vector along the axes of a frame.
template <class Frame> struct Vec3 {
  double x = 0, y = 0, z = 0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, double k) { return {a.x * k, a.y * k, a.z * k}; }
  friend constexpr Vec3 operator*(double k, Vec3 a) { return a * k; }
  friend constexpr Vec3 operator/(Vec3 a, double k) { return {a.x / k, a.y / k, a.z / k}; }
  friend constexpr bool operator==(Vec3 a, Vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
  /// Adds a vector of the same frame.
  constexpr Vec3 &operator+=(Vec3 b) { return *this = *this + b; }
  /// Subtracts a vector of the same frame.
  constexpr Vec3 &operator-=(Vec3 b) { return *this = *this - b; }
};

/// Scalar product.
template <class F> constexpr double dot(Vec3<F> a, Vec3<F> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Vector product, right-handed.
template <class F> constexpr Vec3<F> cross(Vec3<F> a, Vec3<F> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Length.
template <class F> double norm(Vec3<F> a) { return std::sqrt(dot(a, a)); }
/// Unit vector along `a`; `a` must not be zero.
template <class F> Vec3<F> normalized(Vec3<F> a) { return a / norm(a); }
/// Angle between two vectors [rad], accurate near 0 and pi (Kahan's form with atan2).
template <class F> double angle_between(Vec3<F> a, Vec3<F> b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}
/// Some unit vector perpendicular to the unit vector `a`; a continuous choice is not promised.
template <class F> Vec3<F> any_perpendicular(Vec3<F> a) {
  const Vec3<F> axis = std::abs(a.x) < 0.6 ? Vec3<F>{1, 0, 0} : Vec3<F>{0, 1, 0};
  return normalized(cross(a, axis));
}

} // namespace umov
