#include <umov/inverse/attitude_grid.h>

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov {

std::vector<Quaternion> attitude_grid(std::size_t count) {
  // psi solves psi^4 = psi + 4 (Alexa 2022, section 4).
  constexpr double psi = 1.533751168755204288118041;
  std::vector<Quaternion> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double s = static_cast<double>(k) + 0.5, t = s / static_cast<double>(count);
    const double a = 2 * pi * std::fmod(s / std::sqrt(2.0), 1.0);
    const double b = 2 * pi * std::fmod(s / psi, 1.0);
    const double r = std::sqrt(t), rest = std::sqrt(1 - t);
    out[k] = {r * std::sin(a), r * std::cos(a), rest * std::sin(b), rest * std::cos(b)};
  }
  return out;
}

double grid_spacing_rad(std::size_t count) {
  // SO(3) has the volume 8 pi^2 in the measure of rotation vectors.
  return std::cbrt(8 * pi * pi / static_cast<double>(std::max<std::size_t>(count, 1)));
}

Quaternion product(Quaternion a, Quaternion b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quaternion turned(Quaternion attitude, Vec3<Body> by) {
  const double angle = std::sqrt(dot(by, by));
  const double s = angle > 1e-12 ? std::sin(angle / 2) / angle : 0.5;
  const Quaternion q = product(attitude, {std::cos(angle / 2), by.x * s, by.y * s, by.z * s});
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Vec3<Body> turn_between(Quaternion from, Quaternion to) {
  Quaternion d = product({from.w, -from.x, -from.y, -from.z}, to);
  if (d.w < 0)
    d = {-d.w, -d.x, -d.y, -d.z};
  const double s = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  const double factor = s > 1e-12 ? 2 * std::atan2(s, d.w) / s : 2;
  return {d.x * factor, d.y * factor, d.z * factor};
}

double angle_between(Quaternion a, Quaternion b) {
  const Vec3<Body> turn = turn_between(a, b);
  return std::sqrt(dot(turn, turn));
}

double share_within(double radius_rad) {
  const double r = std::clamp(radius_rad, 0.0, pi);
  return (r - std::sin(r)) / pi;
}

} // namespace umov
