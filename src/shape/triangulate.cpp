#include <umov/shape/triangulate.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace umov {
namespace {

struct Point {
  double x, y;
};

double turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_inside(Point p, Point a, Point b, Point c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

Triangulation fan(std::size_t count) {
  Triangulation out;
  for (std::uint32_t i = 1; i + 1 < count; ++i)
    out.triangles.push_back({0, i, i + 1});
  return out;
}

/// Halves of halves of a convex polygon. A fan of a thousand slivers has boxes that all overlap,
/// and whatever searches among them takes their number squared.
Triangulation halved(std::size_t count) {
  Triangulation out;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open{
      {0, static_cast<std::uint32_t>(count - 1)}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    if (last - first < 2)
      continue;
    const std::uint32_t middle = first + (last - first) / 2;
    out.triangles.push_back({first, middle, last});
    open.emplace_back(middle, last);
    open.emplace_back(first, middle);
  }
  return out;
}

/// Clips one ear after the other; false if none is left although corners are, or if the work grows
/// past what a sane outline needs (one that crosses itself all over).
bool clip_ears(const std::vector<Point> &p, Triangulation &out) {
  std::vector<std::uint32_t> ring(p.size());
  for (std::uint32_t i = 0; i < p.size(); ++i)
    ring[i] = i;
  const auto reflex_now = [&](std::size_t k) {
    const std::size_t n = ring.size();
    return turn(p[ring[(k + n - 1) % n]], p[ring[k]], p[ring[(k + 1) % n]]) <= 0;
  };
  // Only a reflex corner can lie in an ear, and clipping never makes a convex corner reflex.
  std::vector<bool> is_reflex(p.size());
  std::vector<std::uint32_t> reflex;
  for (std::size_t k = 0; k < ring.size(); ++k)
    if (reflex_now(k)) {
      is_reflex[k] = true;
      reflex.push_back(static_cast<std::uint32_t>(k));
    }
  std::size_t at = 0, tried = 0, work = 0;
  const std::size_t limit = 40 * p.size() * std::max<std::size_t>(p.size(), 64);
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    if (tried > n || work > limit)
      return false;
    const std::uint32_t a = ring[(at + n - 1) % n], b = ring[at % n], c = ring[(at + 1) % n];
    bool is_ear = turn(p[a], p[b], p[c]) > 0;
    for (std::size_t k = 0; is_ear && k < reflex.size(); ++k, ++work) {
      const std::uint32_t v = reflex[k];
      const auto same = [&](std::uint32_t w) { return p[v].x == p[w].x && p[v].y == p[w].y; };
      // A corner repeated by a bridge to a hole touches the ear but does not lie in it.
      if (is_reflex[v] && !same(a) && !same(b) && !same(c))
        is_ear = !is_inside(p[v], p[a], p[b], p[c]);
    }
    if (!is_ear) {
      at = (at + 1) % n;
      ++tried;
      continue;
    }
    out.triangles.push_back({a, b, c});
    is_reflex[b] = false;
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at % n));
    at = at % ring.size();
    for (const std::size_t k : {at, (at + ring.size() - 1) % ring.size()})
      if (is_reflex[ring[k]] && !reflex_now(k))
        is_reflex[ring[k]] = false;
    tried = 0;
  }
  out.triangles.push_back({ring[0], ring[1], ring[2]});
  return true;
}

} // namespace

Triangulation triangulate(std::span<const Vec3<Body>> corners) {
  const std::size_t count = corners.size();
  if (count <= 3)
    return fan(count);
  Vec3<Body> normal{}; // Newell: twice the area vector
  double size = 0;
  for (std::size_t i = 0; i < count; ++i) {
    normal += cross(corners[i] - corners[0], corners[(i + 1) % count] - corners[0]);
    size = std::max(size, norm(corners[i] - corners[0]));
  }
  Triangulation out = fan(count);
  const double doubled = norm(normal);
  if (!(doubled > 1e-14 * size * size)) {
    out.is_simple = false;
    return out;
  }
  const Vec3<Body> z = normal / doubled, x = any_perpendicular(z), y = cross(z, x);
  std::vector<Point> flat(count);
  double height = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3<Body> d = corners[i] - corners[0];
    flat[i] = {dot(d, x), dot(d, y)};
    height = std::max(height, std::abs(dot(d, z)));
  }
  bool is_convex = true;
  double fan_area = 0;
  for (std::size_t i = 0; i < count; ++i) {
    is_convex = is_convex &&
                turn(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) >= -1e-12 * doubled;
    if (i > 0 && i + 1 < count)
      fan_area += std::abs(turn(flat[0], flat[i], flat[i + 1]));
  }
  // A pentagram turns left everywhere too; its fan covers more than its area.
  if (!is_convex || fan_area > doubled * (1 + 1e-9)) {
    Triangulation ears;
    if (clip_ears(flat, ears))
      out = std::move(ears);
    double area = 0;
    for (const auto &t : out.triangles)
      area += std::abs(turn(flat[t[0]], flat[t[1]], flat[t[2]]));
    out.is_simple = std::abs(area - doubled) <= 1e-9 * doubled;
    if (!out.is_simple)
      out.triangles = fan(count).triangles;
  }
  out.is_convex = is_convex && out.is_simple;
  constexpr std::size_t largest_fan = 64;
  if (out.is_convex && count > largest_fan)
    out.triangles = halved(count).triangles;
  out.is_planar = height <= 1e-3 * size;
  return out;
}

} // namespace umov
