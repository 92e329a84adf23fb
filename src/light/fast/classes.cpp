#include "light/fast/classes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace umov {
namespace {

/// Cell of space of a normal and its slot.
struct Cell {
  std::int64_t x, y, z;
  std::uint32_t slot, side;
  bool operator==(const Cell &) const = default;
};
struct CellHash {
  std::size_t operator()(const Cell &c) const {
    std::uint64_t h = 1469598103934665603ull; // FNV-1a over the numbers
    for (const std::uint64_t part :
         {static_cast<std::uint64_t>(c.x), static_cast<std::uint64_t>(c.y),
          static_cast<std::uint64_t>(c.z), static_cast<std::uint64_t>(c.slot) * 2 + c.side})
      h = (h ^ part) * 1099511628211ull;
    return static_cast<std::size_t>(h ^ (h >> 29));
  }
};

class Joiner {
public:
  explicit Joiner(double tolerance) : tolerance_(tolerance), size_(2 * tolerance) {}

  void add(std::uint32_t element, Vec3<Body> normal, double area, std::uint32_t slot, float side) {
    const std::uint32_t at = find(normal, slot, side);
    members_.push_back({at, element});
    Sum &sum = sums_[at];
    sum.normal += area * normal;
    sum.area += area;
  }

  FacetClasses finish() {
    FacetClasses out;
    out.list.resize(sums_.size());
    for (const Member &m : members_)
      ++out.list[m.of].count;
    std::uint32_t at = 0;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      FacetClass &c = out.list[i];
      const Sum &sum = sums_[i];
      c.first = at;
      at += c.count;
      c.count = 0;
      const double length = norm(sum.normal);
      c.normal = length > 0 ? sum.normal / length : sum.first;
      c.area_m2 = sum.area;
      // |mean of unit normals| = 1 - half their mean square deviation.
      c.spread2 = sum.area > 0 ? std::max(0.0, 2 * (1 - length / sum.area)) : 0;
      c.slot = sum.slot;
      c.side = sum.side;
    }
    out.element.resize(members_.size());
    for (const Member &m : members_) {
      FacetClass &c = out.list[m.of];
      out.element[c.first + c.count++] = m.element;
    }
    return out;
  }

private:
  struct Sum {
    Vec3<Body> normal{}, first;
    double area = 0;
    std::uint32_t slot = 0;
    float side = 1;
  };
  struct Member {
    std::uint32_t of, element;
  };

  /// The class whose first normal is near, or a new one. Cells are twice the tolerance wide, so
  /// that the eight around the nearest corner hold all that is near.
  std::uint32_t find(Vec3<Body> n, std::uint32_t slot, float side) {
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size_)); };
    const Cell home{cell(n.x), cell(n.y), cell(n.z), slot, side > 0 ? 0u : 1u};
    const auto step = [&](double x, std::int64_t c) {
      return x / size_ - static_cast<double>(c) < 0.5 ? -1 : 1;
    };
    const std::int64_t sx = step(n.x, home.x), sy = step(n.y, home.y), sz = step(n.z, home.z);
    for (int k = 0; k < 8; ++k) {
      Cell c = home;
      c.x += (k & 1) != 0 ? sx : 0;
      c.y += (k & 2) != 0 ? sy : 0;
      c.z += (k & 4) != 0 ? sz : 0;
      const auto [first, last] = by_cell_.equal_range(c);
      for (auto it = first; it != last; ++it)
        if (norm(sums_[it->second].first - n) <= tolerance_)
          return it->second;
    }
    const auto at = static_cast<std::uint32_t>(sums_.size());
    sums_.push_back({{}, n, 0, slot, side});
    by_cell_.emplace(home, at);
    return at;
  }

  double tolerance_, size_;
  std::vector<Sum> sums_;
  std::vector<Member> members_;
  std::unordered_multimap<Cell, std::uint32_t, CellHash> by_cell_;
};

} // namespace

FacetClasses join_facets(const Elements &elements, double tolerance_rad) {
  Joiner joiner(std::max(tolerance_rad, equal_normals_rad));
  for (std::size_t i = 0; i < elements.list.size(); ++i) {
    const Element &e = elements.list[i];
    const Vec3<Body> middle = shading_normal(e, 1.0 / 3, 1.0 / 3, 1.0 / 3);
    const SideSlots slots = elements.slots[e.triangle];
    const auto index = static_cast<std::uint32_t>(i);
    if (slots.front != no_index)
      joiner.add(index, middle, e.area_m2, slots.front, 1);
    if (slots.back != no_index)
      joiner.add(index, -middle, e.area_m2, slots.back, -1);
  }
  return joiner.finish();
}

} // namespace umov
