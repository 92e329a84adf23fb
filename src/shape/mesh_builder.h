#pragma once
// Private: puts shapes together from solids of revolution, boxes and free triangles.

#include <cmath>
#include <functional>
#include <string>
#include <umov/core/quantity.h>
#include <umov/shape/mesh.h>
#include <vector>

namespace umov {

/// Right-handed axes with an origin: where a solid stands.
struct Placement {
  Vec3<Body> origin{}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  [[nodiscard]] Vec3<Body> direction(Vec3<Body> v) const { return x * v.x + y * v.y + z * v.z; }
  [[nodiscard]] Vec3<Body> point(Vec3<Body> v) const { return origin + direction(v); }
};

/// Axes turned by an angle about the x axis (y towards z), then moved.
inline Placement turned_about_x(Vec3<Body> origin, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {origin, {1, 0, 0}, {0, c, s}, {0, -s, c}};
}

/// A point of the outline of a solid of revolution: height along z, distance from the axis.
struct Outline {
  double z, r;
};

class MeshBuilder {
public:
  std::uint32_t group(const std::string &name);
  /// Triangle with its corners' normals.
  void triangle(std::uint32_t group, std::array<Vec3<Body>, 3> p, std::array<Vec3<Body>, 3> n);
  /// Flat polygon of three or four corners, counter-clockwise from outside.
  void flat(std::uint32_t group, const std::vector<Vec3<Body>> &corners);

  /// Closed solid from an outline that runs from the axis, up the outside, back to the axis. Each
  /// segment is round (exact cone normals) and has its own group, by segment and side.
  void revolve(const std::vector<Outline> &outline, std::size_t sides, const Placement &place,
               const std::function<std::uint32_t(std::size_t segment, std::size_t side)> &group_of);
  /// Closed cylinder along the placement's z from 0 to `length`.
  void cylinder(double radius, double length, std::size_t sides, const Placement &place,
                std::uint32_t group);
  /// Closed box with half sizes about the placement's origin; groups of +z, -z and the other faces.
  void box(Vec3<Body> half, const Placement &place, std::uint32_t top, std::uint32_t bottom,
           std::uint32_t sides);

  Mesh mesh;

private:
  std::uint32_t position(Vec3<Body> p);
  std::uint32_t normal(Vec3<Body> n);
};

} // namespace umov
