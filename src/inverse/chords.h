#pragma once
// Private: how far many attitudes are from one, without an angle for each of them.

#include <algorithm>
#include <cmath>
#include <span>
#include <umov/core/rotation.h>
#include <vector>

namespace umov::inverse {

/// Square of the chord of two attitudes: 2 sin(angle/4), the distance of two unit quaternions, the
/// nearer of both signs. It grows with the angle and costs no inverse of a sine. By differences,
/// not by the cosine, whose last digit is an angle of 3e-8.
inline double chord_square(const Quaternion &p, const Quaternion &q) {
  const double aw = p.w - q.w, ax = p.x - q.x, ay = p.y - q.y, az = p.z - q.z;
  const double bw = p.w + q.w, bx = p.x + q.x, by = p.y + q.y, bz = p.z + q.z;
  return std::min(aw * aw + ax * ax + ay * ay + az * az, bw * bw + bx * bx + by * by + bz * bz);
}

/// Attitudes, asked for their chords to others.
class Chords {
public:
  void add(Quaternion q) {
    w_.push_back(q.w);
    x_.push_back(q.x);
    y_.push_back(q.y);
    z_.push_back(q.z);
  }
  [[nodiscard]] std::size_t size() const { return w_.size(); }
  [[nodiscard]] Quaternion at(std::size_t k) const { return {w_[k], x_[k], y_[k], z_[k]}; }
  /// Squares of the chords from an attitude to each of them.
  void squares_from(Quaternion q, std::vector<double> &out) const {
    out.resize(size());
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = chord_square(at(k), q);
  }

private:
  std::vector<double> w_, x_, y_, z_;
};

/// Square of the chord of an angle [rad], pi at most.
inline double chord_square(double angle_rad) {
  const double chord = 2 * std::sin(angle_rad / 4);
  return chord * chord;
}
/// The angle [rad] of a chord.
inline double angle_of_chord_square(double square) {
  return 4 * std::asin(std::min(std::sqrt(square) / 2, std::sqrt(0.5)));
}

} // namespace umov::inverse
