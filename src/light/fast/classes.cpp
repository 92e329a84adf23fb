#include "light/fast/classes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <umov/core/stop.h>
#include <unordered_map>

namespace umov {
namespace {

/// Cell of space of a normal and its slot (`width` 0), or a cell of that width on the face x of a
/// cube of directions.
struct Cell {
  std::int64_t x, y, z;
  std::uint32_t slot, side;
  double width;
  bool operator==(const Cell &) const = default;
};
struct CellHash {
  std::size_t operator()(const Cell &c) const {
    std::uint64_t h = 1469598103934665603ull; // FNV-1a over the numbers
    for (const std::uint64_t part :
         {static_cast<std::uint64_t>(c.x), static_cast<std::uint64_t>(c.y),
          static_cast<std::uint64_t>(c.z), static_cast<std::uint64_t>(c.slot) * 2 + c.side,
          std::bit_cast<std::uint64_t>(c.width)})
      h = (h ^ part) * 1099511628211ull;
    return static_cast<std::size_t>(h ^ (h >> 29));
  }
};

class Joiner {
public:
  explicit Joiner(std::span<const double> tolerance_of) : tolerance_of_(tolerance_of) {}

  /// `cell` > 0: with all others that have their `place` in the same cell of directions, that wide.
  void add(std::uint32_t element, Vec3<Body> normal, Vec3<Body> place, double area,
           std::uint32_t slot, float side, double cell) {
    const std::uint32_t at = cell > 0 ? of_cell(place, slot, side, cell) : find(normal, slot, side);
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

  std::uint32_t add_class(const Cell &cell, Vec3<Body> n) {
    const auto at = static_cast<std::uint32_t>(sums_.size());
    sums_.push_back({{}, n, 0, cell.slot, cell.side == 0 ? 1.0f : -1.0f});
    by_cell_.emplace(cell, at);
    return at;
  }

  /// Cells on the faces of a cube, even in angle. A ring about an axis runs along their middles.
  std::uint32_t of_cell(Vec3<Body> n, std::uint32_t slot, float side, double width) {
    const double size[3] = {std::abs(n.x), std::abs(n.y), std::abs(n.z)}, to[3] = {n.x, n.y, n.z};
    const std::size_t axis =
        size[0] >= size[1] ? (size[0] >= size[2] ? 0 : 2) : (size[1] >= size[2] ? 1 : 2);
    const auto cell = [&](std::size_t k) {
      const double angle = std::atan2(to[(axis + k) % 3], size[axis]);
      return static_cast<std::int64_t>(std::floor(angle / width + 0.5));
    };
    const Cell home{static_cast<std::int64_t>(2 * axis) + (to[axis] < 0 ? 1 : 0),
                    cell(1),
                    cell(2),
                    slot,
                    side > 0 ? 0u : 1u,
                    width};
    const auto found = by_cell_.find(home);
    return found != by_cell_.end() ? found->second : add_class(home, n);
  }

  /// The class whose first normal is near, or a new one. Cells are twice the tolerance wide, so
  /// that the eight around the nearest corner hold all that is near.
  std::uint32_t find(Vec3<Body> n, std::uint32_t slot, float side) {
    const double tolerance = std::max(tolerance_of_[slot], equal_normals_rad), size = 2 * tolerance;
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size)); };
    const Cell home{cell(n.x), cell(n.y), cell(n.z), slot, side > 0 ? 0u : 1u, 0};
    const auto step = [&](double x, std::int64_t c) {
      return x / size - static_cast<double>(c) < 0.5 ? -1 : 1;
    };
    const std::int64_t sx = step(n.x, home.x), sy = step(n.y, home.y), sz = step(n.z, home.z);
    for (int k = 0; k < 8; ++k) {
      Cell c = home;
      c.x += (k & 1) != 0 ? sx : 0;
      c.y += (k & 2) != 0 ? sy : 0;
      c.z += (k & 4) != 0 ? sz : 0;
      const auto [first, last] = by_cell_.equal_range(c);
      for (auto it = first; it != last; ++it)
        if (norm(sums_[it->second].first - n) <= tolerance)
          return it->second;
    }
    return add_class(home, n);
  }

  std::span<const double> tolerance_of_; ///< of each slot
  std::vector<Sum> sums_;
  std::vector<Member> members_;
  std::unordered_multimap<Cell, std::uint32_t, CellHash> by_cell_;
};

/// Width w of the cells whose elements are joined, such that the normals of a class vary no more
/// than over one element of a part of the largest turn T: w^2/12 + e^2/36 along each axis for
/// triangles that turn by e. A part, as cells take in now one, now two elements, and what lit
/// middles miss cancels between neighbours only where they are alike (engine.md). e is rounded up
/// to quarters of T, so that neighbours share their cells. 0: not joined.
double cell_of(const Element &e) {
  constexpr double part = 0.75;
  if (e.is_flat)
    return 0;
  const double most = static_cast<double>(e.turn_max_rad),
               own = 0.25 * std::ceil(4 * static_cast<double>(e.turn_rad) / most);
  return own < part ? most * std::sqrt((part * part - own * own) / 3) : 0;
}

/// Where an element is among the cells. Of a strip that is curved one way both triangles are in its
/// middle, so that they are never in two classes: their middles, a third and two thirds across,
/// are an uneven lattice when only some are joined.
Vec3<Body> place_of(const Element &e, Vec3<Body> middle) {
  const double equal = 0.02 * static_cast<double>(e.turn_rad);
  for (std::size_t k = 0; k < 3; ++k)
    if (norm(e.normal[k] - e.normal[(k + 1) % 3]) < equal)
      return normalized(e.normal[k] + e.normal[(k + 2) % 3]);
  return middle;
}

} // namespace

FacetClasses join_facets(const Elements &elements, std::span<const double> tolerance_rad,
                         const std::atomic<bool> *cancel) {
  Joiner joiner(tolerance_rad);
  for (std::size_t i = 0; i < elements.list.size(); ++i) {
    leave_if_stopped(cancel, i);
    const Element &e = elements.list[i];
    const Vec3<Body> middle = shading_normal(e, 1.0 / 3, 1.0 / 3, 1.0 / 3);
    const SideSlots slots = elements.slots[e.triangle];
    const auto index = static_cast<std::uint32_t>(i);
    const double cell = cell_of(e);
    const Vec3<Body> place = cell > 0 ? place_of(e, middle) : middle;
    if (slots.front != no_index)
      joiner.add(index, middle, place, e.area_m2, slots.front, 1, cell);
    if (slots.back != no_index)
      joiner.add(index, -middle, -place, e.area_m2, slots.back, -1, cell);
  }
  return joiner.finish();
}

} // namespace umov
