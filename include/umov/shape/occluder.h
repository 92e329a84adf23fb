#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <umov/shape/mesh.h>

namespace umov {

/// Ray tests against a mesh (both sides of every face stop a ray). Thread safe after construction.
class Occluder {
public:
  /// What rays are for.
  enum class Rays {
    Each, ///< every one counts: none slips between two triangles
    Grid, ///< so many that one of a million may, for half the time: directions of a grid, say
  };
  /// Throws `Failure`: Device where the tree cannot be built (out of memory, unknown processor),
  /// Interrupted once `cancel` became true.
  explicit Occluder(const Mesh &mesh, Rays rays = Rays::Each,
                    const std::atomic<bool> *cancel = nullptr);
  ~Occluder();
  Occluder(Occluder &&) noexcept;
  Occluder &operator=(Occluder &&) noexcept;

  /// For each origin [m]: 1 if nothing lies in `direction` (unit), else 0. Origins are lifted by
  /// the caller; rays start at distance 0, and are robust (watertight) unless they are for grids.
  void is_free(std::span<const Vec3<Body>> origins, Vec3<Body> direction,
               std::span<unsigned char> free) const;

  /// A point in the coordinates of the ray tests, for origins that serve again and again.
  struct Point {
    float x, y, z;
  };
  /// A point of the body in the occluder's own coordinates.
  [[nodiscard]] Point to_point(Vec3<Body> p) const;
  /// And back.
  [[nodiscard]] Vec3<Body> from_point(Point p) const;
  /// As above for one direction (unit) per origin.
  void is_free(std::span<const Point> origins, std::span<const Point> directions,
               std::span<unsigned char> free) const;

  /// Nearest hit of a ray: triangle index and barycentric u, v, or no_index.
  struct Hit {
    std::uint32_t triangle = no_index;
    float u = 0, v = 0;
    double distance_m = 0;
  };
  /// The first triangle along a ray, if there is one.
  [[nodiscard]] Hit nearest(Vec3<Body> origin, Vec3<Body> direction) const;

private:
  void build(const Mesh &mesh, Rays rays, const std::atomic<bool> *cancel);
  [[nodiscard]] bool is_one_free(Point origin, Point direction) const;
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace umov
