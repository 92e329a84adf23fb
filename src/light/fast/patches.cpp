#include "light/fast/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <umov/core/stop.h>

namespace umov {
namespace {

/// Steps of normals in standard deviations of a Gaussian lobe; GGX falls about its peak as one of
/// alpha/2. Within a step a rule of second degree (two points of Gauss and Legendre, or three in a
/// triangle): neighbours need not share a lattice. Tried on uneven triangles: 3e-4 of the peak.
constexpr double one_way_step = 1, both_ways_step = 1.5;
/// Steps along the edge of a patch, at most: where it is curved to both sides, and to one.
constexpr std::size_t cuts_max = 16, cuts_one_way_max = 64;

/// The narrowest lobe of a slot as a Gaussian; nothing where one normal will do.
std::optional<double> width_of(const backend::SlotTerms &slot, const CompiledScene &scene) {
  double width = HUGE_VAL, narrowest = HUGE_VAL;
  for (std::size_t k = slot.lobe_first; k < slot.lobe_first + slot.lobe_count; ++k) {
    const auto &lobe = scene.data.lobes[k];
    narrowest = std::min(narrowest, scene.widths[k]);
    width = std::min(width, lobe.kind == LobeKind::Ggx ? lobe.shape / 2 : scene.widths[k]);
  }
  if (!(narrowest < element_turn_min_rad))
    return {};
  return width;
}

/// Three normals, in an order that tells patches apart; equal for equal ones.
using Corners = std::array<Vec3<Body>, 3>;

/// Puts the corners of a patch that is curved to one side in the order a, b, a' with a' as a.
bool turn_to_one_way(Corners &c, double width) {
  for (std::size_t k = 0; k < 3; ++k)
    if (norm(c[k] - c[(k + 2) % 3]) < 0.02 * width) {
      std::rotate(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(k), c.end());
      return true;
    }
  return false;
}

class Patches {
public:
  explicit Patches(CompiledScene &out) : out_(out.data) {}

  /// Patches of one class; how far its normals lie from its own.
  double add(const Elements &elements, const FacetClasses &classes, const FacetClass &c,
             double width, backend::PatchRange &range) {
    by_key_.clear();
    range.first = static_cast<std::uint32_t>(out_.patches.size());
    double spread = 0, area = 0;
    for (std::uint32_t m = 0; m < c.count; ++m) {
      const Element &e = elements.list[classes.element[c.first + m]];
      Corners corners = e.normal;
      if (e.is_flat)
        corners[1] = corners[2] = corners[0];
      for (Vec3<Body> &n : corners) {
        n = static_cast<double>(c.side) * n;
        spread = std::max(spread, norm(n - c.normal));
      }
      add(corners, e.area_m2, width);
      area += e.area_m2;
    }
    range.count = static_cast<std::uint32_t>(out_.patches.size()) - range.first;
    for (std::uint32_t p = range.first; p < range.first + range.count; ++p)
      out_.patches[p].share /= area;
    return spread;
  }

private:
  /// What is equal for patches that are one.
  using Key = std::array<std::int64_t, 9>;
  struct Nodes {
    std::uint32_t first, count;
  };

  void add(Corners corners, double area, double width) {
    double turn = 0;
    for (std::size_t k = 0; k < 3; ++k)
      turn = std::max(turn, norm(corners[k] - corners[(k + 1) % 3]));
    const bool is_one_way = turn_to_one_way(corners, width);
    const double step = width * (is_one_way ? one_way_step : both_ways_step);
    const auto cuts = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(turn / step)), 1,
                                              is_one_way ? cuts_one_way_max : cuts_max);
    double unit = 1e-6; // of equal normals
    const bool is_small = turn <= 0.25 * width;
    if (is_small) { // so little is as good as its middle, and neighbours as their mean
      corners[0] = corners[1] = corners[2] = normalized(corners[0] + corners[1] + corners[2]);
      unit = width / 8;
    }
    const auto [at, is_new] =
        by_key_.emplace(key_of(corners, unit), static_cast<std::uint32_t>(out_.patches.size()));
    if (!is_new) {
      backend::NormalPatch<double> &patch = out_.patches[at->second];
      const double part = area / (patch.share += area);
      const double n[3] = {corners[0].x, corners[0].y, corners[0].z};
      for (std::size_t axis = 0; is_small && axis < 3; ++axis) // their mean
        patch.corner[axis] += part * (n[axis] - patch.corner[axis]);
      return;
    }
    backend::NormalPatch<double> &patch = out_.patches.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto of = [&](std::size_t k) {
        const double n[3] = {corners[k].x, corners[k].y, corners[k].z};
        return n[axis];
      };
      patch.corner[axis] = of(0);
      patch.first[axis] = of(1) - of(0);
      patch.second[axis] = of(2) - of(0);
    }
    patch.share = area;
    const Nodes nodes = nodes_of(cuts, is_one_way);
    patch.node_first = nodes.first;
    patch.node_count = nodes.count;
  }

  /// In any order of the corners.
  static Key key_of(Corners c, double unit) {
    std::array<std::array<std::int64_t, 3>, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = {std::llround(c[k].x / unit), std::llround(c[k].y / unit),
                 std::llround(c[k].z / unit)};
    std::sort(cell.begin(), cell.end());
    Key out{};
    for (std::size_t k = 0; k < 9; ++k)
      out[k] = cell[k / 3][k % 3];
    return out;
  }

  /// Nodes of a patch with so many steps along its edges, shared by all of them.
  Nodes nodes_of(std::size_t cuts, bool is_one_way) {
    const auto [at, is_new] = nodes_.try_emplace({cuts, is_one_way}, Nodes{});
    if (!is_new)
      return at->second;
    const std::size_t first = out_.node_weight.size();
    if (is_one_way)
      put_strips(cuts);
    else
      put_triangles(cuts);
    while (out_.node_weight.size() % backend::lanes != 0)
      put(0, 0, 0);
    at->second = {static_cast<std::uint32_t>(first),
                  static_cast<std::uint32_t>(out_.node_weight.size() - first)};
    return at->second;
  }

  /// Area falls from the edge without curvature to the corner opposite.
  void put_strips(std::size_t cuts) {
    const double step = 1 / static_cast<double>(cuts), apart = step / std::sqrt(12.0);
    for (std::size_t k = 0; k < cuts; ++k)
      for (const double side : {-apart, apart}) {
        const double u = (static_cast<double>(k) + 0.5) * step + side;
        put(u, 0.5 * (1 - u), step * (1 - u));
      }
  }
  /// Equal triangles.
  void put_triangles(std::size_t cuts) {
    const auto n = static_cast<double>(cuts);
    const double weight = 1 / (3 * n * n);
    for (std::size_t i = 0; i < cuts; ++i)
      for (std::size_t j = 0; i + j < cuts; ++j)
        for (const auto &[u, v] : {std::pair(1.0, 1.0), {4.0, 1.0}, {1.0, 4.0}}) {
          const auto x = static_cast<double>(i), y = static_cast<double>(j);
          put((x + u / 6) / n, (y + v / 6) / n, weight);
          if (i + j + 1 < cuts)
            put((x + 1 - u / 6) / n, (y + 1 - v / 6) / n, weight);
        }
  }
  void put(double first, double second, double weight) {
    out_.node_first.push_back(first);
    out_.node_second.push_back(second);
    out_.node_weight.push_back(weight);
  }

  SceneStore<double> &out_;
  std::map<Key, std::uint32_t> by_key_; ///< patches of the class at hand
  std::map<std::pair<std::size_t, bool>, Nodes> nodes_;
};

bool is_curved(const Elements &elements, const FacetClasses &classes, const FacetClass &c) {
  for (std::uint32_t m = 0; m < c.count; ++m)
    if (!elements.list[classes.element[c.first + m]].is_flat)
      return true;
  return false;
}

} // namespace

void add_patches(const Elements &elements, const FacetClasses &classes, const GroupPlan &plan,
                 CompiledScene &out, const std::atomic<bool> *cancel) {
  Patches patches(out);
  std::vector<backend::PatchRange> ranges(plan.groups.size() * backend::lanes);
  for (const backend::Chunk &chunk : out.data.chunks) {
    backend::SlotTerms &slot = out.data.slots[chunk.slot];
    const std::optional<double> width = width_of(slot, out);
    for (std::uint32_t g = chunk.first; width && g < chunk.first + chunk.count; ++g) {
      leave_if_stopped(cancel);
      for (std::size_t lane = 0; lane < backend::lanes; ++lane) {
        const std::uint32_t member = plan.groups[g].member[lane];
        if (member == no_index || !is_curved(elements, classes, classes.list[member]))
          continue;
        const double spread = patches.add(elements, classes, classes.list[member], *width,
                                          ranges[g * backend::lanes + lane]);
        slot.patch_spread = std::max(slot.patch_spread, static_cast<float>(spread));
      }
    }
  }
  if (!out.data.patches.empty())
    out.data.patches_of = std::move(ranges);
}

} // namespace umov
