#pragma once
// Rotations named <to>_from_<from>, so that neighbours cancel.

#include <array>
#include <umov/core/vec3.h>

namespace umov {

/// Unit quaternion, scalar first. As `body_from_gcrs` it takes GCRS components to body components.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

/// Proper rotation that turns components in `From` into components in `To`.
template <class To, class From> class Rotation {
public:
  constexpr Rotation() : rows_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}} {}
  /// Rows: the axes of `To` expressed in `From`.
  constexpr Rotation(Vec3<From> x, Vec3<From> y, Vec3<From> z) : rows_{x, y, z} {}

  /// Components in `To` of a vector given in `From`.
  constexpr Vec3<To> operator*(Vec3<From> v) const {
    return {dot(rows_[0], v), dot(rows_[1], v), dot(rows_[2], v)};
  }
  /// Axis i of `To`, in `From` components.
  [[nodiscard]] constexpr Vec3<From> row(int i) const { return rows_[static_cast<std::size_t>(i)]; }
  /// The way back: the transposed matrix.
  [[nodiscard]] constexpr Rotation<From, To> inverse() const {
    const auto &r = rows_;
    return {Vec3<To>{r[0].x, r[1].x, r[2].x}, Vec3<To>{r[0].y, r[1].y, r[2].y},
            Vec3<To>{r[0].z, r[1].z, r[2].z}};
  }
  /// First the right one, then this one; frames in the middle must meet.
  template <class Start>
  constexpr Rotation<To, Start> operator*(const Rotation<From, Start> &first) const {
    const auto t = first.inverse(); // rows of t: axes of From seen from Start, transposed
    Vec3<Start> out[3];
    for (int i = 0; i < 3; ++i) {
      const Vec3<From> r = row(i);
      out[i] = t * r;
    }
    return {out[0], out[1], out[2]};
  }

private:
  std::array<Vec3<From>, 3> rows_;
};

/// Rotation of a unit quaternion q: v_to = q* v_from q, the same attitude as q and -q.
/// (Scalar first; the direction cosine matrix of Diebel 2006, Eq. 125.)
template <class To, class From> constexpr Rotation<To, From> rotation_from(Quaternion q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  return {Vec3<From>{w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)},
          Vec3<From>{2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)},
          Vec3<From>{2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z}};
}

/// Quaternion of a rotation, with w >= 0 (Shepperd 1978: the largest component first).
Quaternion quaternion_from_rows(const std::array<std::array<double, 3>, 3> &rows);
/// Quaternion of a rotation, with w >= 0.
template <class To, class From> Quaternion quaternion_from(const Rotation<To, From> &r) {
  std::array<std::array<double, 3>, 3> rows{};
  for (int i = 0; i < 3; ++i)
    rows[static_cast<std::size_t>(i)] = {r.row(i).x, r.row(i).y, r.row(i).z};
  return quaternion_from_rows(rows);
}

} // namespace umov
