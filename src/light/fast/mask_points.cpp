#include "light/fast/mask_points.h"

#include "light/fast/octahedron.h"
#include "light/reference/visibility_points.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace umov {
namespace {

/// From so many points on a class has words of its own instead of sharing them with 15 others.
constexpr double large_from = 256;
constexpr std::size_t words_large = 16; ///< a class's words come in whole blocks of 512 points

struct Plan {
  std::uint32_t of;
  std::uint32_t slot;
  std::uint16_t words;
  bool is_large;
  std::uint32_t order;
};

Plan plan_of(const FacetClass &c, std::uint32_t index, double points_per_area, std::size_t points) {
  Plan out{index, c.slot, 0, false, curve_order(c.normal)};
  if (points == 0)
    return out;
  const double wanted = c.area_m2 * points_per_area;
  out.is_large = wanted >= large_from;
  if (out.is_large) {
    const double blocks = std::min(std::ceil(wanted / (32.0 * words_large)), 512.0);
    out.words = static_cast<std::uint16_t>(words_large * static_cast<std::size_t>(blocks));
  } else {
    out.words = 1;
    while (32.0 * out.words < wanted)
      out.words = static_cast<std::uint16_t>(2 * out.words);
  }
  return out;
}

/// Neighbours in space become neighbours in the list (Morton's curve): rays that run together are
/// traced together, and every m-th point is spread over the whole.
void sort_along_curve(std::vector<Occluder::Point> &points) {
  const auto key = [](const Occluder::Point &p) { // coordinates are within [-1, 1]
    std::uint64_t out = 0;
    const float c[3] = {p.x, p.y, p.z};
    for (unsigned k = 0; k < 3; ++k) {
      const auto q = static_cast<std::uint64_t>(std::clamp(c[k] * 0.5F + 0.5F, 0.0F, 1.0F) * 4095);
      for (unsigned bit = 0; bit < 12; ++bit)
        out |= ((q >> bit) & 1u) << (3 * bit + k);
    }
    return out;
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    order.emplace_back(key(points[i]), i);
  std::sort(order.begin(), order.end());
  std::vector<Occluder::Point> sorted;
  for (const auto &[at, i] : order)
    sorted.push_back(points[i]);
  points = std::move(sorted);
}

} // namespace

GroupPlan plan_groups(const FacetClasses &classes, std::size_t points) {
  double area = 0;
  for (const FacetClass &c : classes.list)
    area += c.area_m2;
  const double per_area = area > 0 ? static_cast<double>(points) / area : 0;
  std::vector<Plan> plans;
  for (std::uint32_t i = 0; i < classes.list.size(); ++i)
    plans.push_back(plan_of(classes.list[i], i, per_area, points));
  std::stable_sort(plans.begin(), plans.end(), [](const Plan &a, const Plan &b) {
    return std::tie(a.slot, a.is_large, a.words, a.order) <
           std::tie(b.slot, b.is_large, b.words, b.order);
  });
  GroupPlan out;
  std::size_t lane = backend::lanes;
  for (const Plan &p : plans) {
    const bool is_same = !out.groups.empty() && out.groups.back().slot == p.slot &&
                         out.groups.back().is_large == p.is_large &&
                         out.groups.back().words == p.words;
    if (lane == backend::lanes || !is_same) {
      GroupPlan::Group group;
      group.slot = p.slot;
      group.words = p.words;
      group.is_large = p.is_large;
      group.member.fill(no_index);
      out.groups.push_back(group);
      lane = 0;
    }
    out.groups.back().member[lane++] = p.of;
  }
  return out;
}

ClassPoints spread_points(const Scene &scene, const Elements &elements, const FacetClasses &classes,
                          std::uint32_t of, std::size_t count, const Occluder &occluder) {
  const FacetClass &c = classes.list[of];
  ClassPoints out;
  out.origin.reserve(count);
  // The R2 sequence (Roberts 2018), shifted from class to class.
  constexpr double g1 = 0.7548776662466927, g2 = 0.5698402909980532;
  const double shift = static_cast<double>(of) * 0.6180339887498949;
  const auto fraction = [](double x) { return x - std::floor(x); };
  LitElement side;
  side.side = c.side;
  double passed = 0; // area of the elements before
  std::uint32_t member = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double target = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * c.area_m2;
    while (member + 1 < c.count &&
           passed + elements.list[classes.element[c.first + member]].area_m2 < target)
      passed += elements.list[classes.element[c.first + member++]].area_m2;
    const Element &e = elements.list[classes.element[c.first + member]];
    const double n = static_cast<double>(i + 1);
    double x = fraction(0.5 + g1 * n + shift), y = fraction(0.5 + g2 * n + 0.7 * shift);
    if (x + y > 1) {
      x = 1 - x;
      y = 1 - y;
    }
    out.origin.push_back(occluder.to_point(ray_origin(scene, elements, side, e, {x, y})));
  }
  sort_along_curve(out.origin);
  return out;
}

} // namespace umov
