// The benchmark's satellite: a bus with two wings, a dish, a tower and a tank, at any facet count.

#include <umov/shape/primitives.h>

#include "shape/mesh_builder.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

struct PatchPoint {
  Vec3<Body> position, normal;
};
using Patch = std::function<PatchPoint(double u, double v)>;

constexpr double bus_x = 0.6, bus_y = 0.6, bus_z = 0.9; ///< half sizes [m]
constexpr double dish_radius = 1.0, dish_hole = 0.13, dish_focus = 0.6, dish_wall = 0.02;
constexpr double dish_height = 1.25;
constexpr double tower_radius = 0.1, tower_top = 2.1;
constexpr double tank_radius = 0.5, tank_top = -0.93, tank_length = 0.8;

class BoxWing {
public:
  explicit BoxWing(double scale, double crumple) : scale_(scale), crumple_(crumple) {
    bus_ = builder_.group("bus");
    panels_ = builder_.group("panels");
    dish_ = builder_.group("dish");
    tank_ = builder_.group("tank");
    add_box({0, 0, 0}, {bus_x, bus_y, bus_z}, {10, 10, 15}, bus_, true);
    for (const double side : {-1.0, 1.0}) {
      add_box({side * 1.68, 0, 0}, {0.73, 0.45, 0.012}, {24, 15, 1}, panels_, false);
      add_box({side * 0.775, 0, 0}, {0.165, 0.03, 0.03}, {3, 1, 1}, tank_, false);
    }
    add_dish();
    add_cylinder(tower_radius, bus_z + 0.005, tower_top, 14, 5);
    add_tank();
  }
  Mesh take() { return std::move(builder_.mesh); }

private:
  /// A number of divisions at this scale.
  [[nodiscard]] std::size_t divided(double n, std::size_t least = 1) const {
    return std::max(least, static_cast<std::size_t>(std::lround(n * scale_)));
  }

  void add(const Patch &patch, std::size_t nu, std::size_t nv, std::uint32_t group) {
    const auto at = [&](std::size_t i, std::size_t j) {
      return patch(static_cast<double>(i) / static_cast<double>(nu),
                   static_cast<double>(j) / static_cast<double>(nv));
    };
    for (std::size_t i = 0; i < nu; ++i)
      for (std::size_t j = 0; j < nv; ++j) {
        const PatchPoint a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        add_triangle(group, a, b, c);
        add_triangle(group, a, c, d);
      }
  }
  void add_triangle(std::uint32_t group, const PatchPoint &a, const PatchPoint &b,
                    const PatchPoint &c) {
    if (norm(cross(b.position - a.position, c.position - a.position)) > 1e-12) // not at a pole
      builder_.triangle(group, {a.position, b.position, c.position},
                        {a.normal, b.normal, c.normal});
  }

  /// Six faces; `is_foil`: crumpled but for the edges.
  void add_box(Vec3<Body> centre, Vec3<Body> half, std::array<double, 3> cells, std::uint32_t group,
               bool is_foil) {
    const std::array<Vec3<Body>, 3> axis{{{half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}}};
    for (std::size_t k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0}) {
        const Vec3<Body> out = side * axis[k], n = normalized(out);
        const std::size_t first = side > 0 ? (k + 1) % 3 : (k + 2) % 3,
                          second = side > 0 ? (k + 2) % 3 : (k + 1) % 3;
        add(
            [&](double u, double v) {
              const Vec3<Body> p =
                  centre + out + (2 * u - 1) * axis[first] + (2 * v - 1) * axis[second];
              const double depth = is_foil ? crumpled(p, u, v) : 0;
              return PatchPoint{p + depth * n, n};
            },
            divided(cells[first]), divided(cells[second]), group);
      }
  }

  /// Height of a foil with folds in many directions, flat at the edges of its face.
  [[nodiscard]] double crumpled(Vec3<Body> p, double u, double v) const {
    if (crumple_ == 0)
      return 0;
    const double edge = std::min(1.0, 12 * std::min({u, 1 - u, v, 1 - v}));
    double height = 0;
    for (int k = 1; k <= 9; ++k) { // ridges: a triangle wave along ever another direction
      const double s = k * 2.399963, t = k * 1.1;
      const Vec3<Body> along{std::cos(s) * std::sin(t), std::sin(s) * std::sin(t), std::cos(t)};
      const double x = (2.5 + 1.7 * k) * dot(p, along) + 0.37 * k;
      height += std::abs(2 * (x - std::floor(x)) - 1) / k;
    }
    return crumple_ * edge * (height - 1.4);
  }

  void add_dish() {
    const auto bowl = [](double r, double phi, double lift, double sign) {
      const double slope = r / (2 * dish_focus);
      const Vec3<Body> out{std::cos(phi), std::sin(phi), 0};
      return PatchPoint{r * out + Vec3<Body>{0, 0, dish_height + r * r / (4 * dish_focus) + lift},
                        sign * normalized(Vec3<Body>{0, 0, 1} - slope * out)};
    };
    const auto radius = [](double v) { return dish_hole + (dish_radius - dish_hole) * v; };
    const std::size_t around = divided(32, 8), along = divided(10, 2);
    add([&](double u, double v) { return bowl(radius(v), -2 * pi * u, dish_wall, 1); }, around,
        along, dish_);
    add([&](double u, double v) { return bowl(radius(v), 2 * pi * u, 0, -1); }, around, along,
        dish_);
    for (const bool is_rim : {false, true})
      add(
          [&](double u, double v) {
            const double phi = is_rim ? 2 * pi * u : -2 * pi * u;
            PatchPoint p = bowl(is_rim ? dish_radius : dish_hole, phi, dish_wall * v, 1);
            p.normal = (is_rim ? 1 : -1) * Vec3<Body>{std::cos(phi), std::sin(phi), 0};
            return p;
          },
          around, 1, dish_);
  }

  void add_cylinder(double r, double low, double high, double sides, double rows) {
    const std::size_t around = divided(sides, 8);
    const auto out = [](double u) {
      return Vec3<Body>{std::cos(2 * pi * u), std::sin(2 * pi * u), 0};
    };
    add(
        [&](double u, double v) {
          return PatchPoint{r * out(u) + Vec3<Body>{0, 0, low + (high - low) * v}, out(u)};
        },
        around, divided(rows), tank_);
    for (const double end : {-1.0, 1.0})
      add(
          [&](double u, double v) {
            return PatchPoint{r * v * out(-end * u) + Vec3<Body>{0, 0, end > 0 ? high : low},
                              {0, 0, end}};
          },
          around, 1, tank_);
  }

  /// A capsule with a flat top under the bus.
  void add_tank() {
    const std::size_t around = divided(26, 8);
    const double bottom = tank_top - tank_length;
    const auto out = [](double u) {
      return Vec3<Body>{std::cos(2 * pi * u), std::sin(2 * pi * u), 0};
    };
    add(
        [&](double u, double v) {
          return PatchPoint{tank_radius * v * out(-u) + Vec3<Body>{0, 0, tank_top}, {0, 0, 1}};
        },
        around, 1, tank_);
    add(
        [&](double u, double v) {
          return PatchPoint{tank_radius * out(u) + Vec3<Body>{0, 0, bottom + tank_length * v},
                            out(u)};
        },
        around, divided(3), tank_);
    add(
        [&](double u, double v) {
          const double t = 0.5 * pi * (1 - v); // from the pole up
          const Vec3<Body> n = std::cos(t) * out(u) - Vec3<Body>{0, 0, std::sin(t)};
          return PatchPoint{tank_radius * n + Vec3<Body>{0, 0, bottom}, n};
        },
        around, divided(8, 2), tank_);
  }

  double scale_, crumple_;
  MeshBuilder builder_;
  std::uint32_t bus_ = 0, panels_ = 0, dish_ = 0, tank_ = 0;
};

} // namespace

Mesh make_box_wing(const BoxWingOptions &options) {
  double low = 0.05, high = 40;
  for (int i = 0; i < 30; ++i) { // counts grow with the scale, in steps
    const double middle = 0.5 * (low + high);
    (BoxWing(middle, 0).take().triangles.size() < options.facets ? low : high) = middle;
  }
  return BoxWing(high, options.crumple_m).take();
}

} // namespace umov
