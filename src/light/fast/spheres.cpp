#include "light/fast/spheres.h"

#include <algorithm>
#include <cmath>

namespace umov {

Sphere around(std::span<const Vec3<Body>> points) {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Vec3<Body> &p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  Sphere out{(low + high) / 2, 0};
  for (const Vec3<Body> &p : points)
    out.radius = std::max(out.radius, norm(p - out.centre));
  return out;
}

std::vector<Sphere> cover(const Mesh &mesh) {
  constexpr std::size_t pieces = 32;
  std::vector<std::vector<std::uint32_t>> parts{{}};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    parts[0].push_back(t);
  const auto corners = [&](const std::vector<std::uint32_t> &of) {
    std::vector<Vec3<Body>> out;
    for (const std::uint32_t t : of)
      for (const std::uint32_t v : mesh.triangles[t].vertex)
        out.push_back(mesh.positions[v]);
    return out;
  };
  while (parts.size() < pieces) {
    const auto largest = std::max_element(parts.begin(), parts.end(), [&](auto &a, auto &b) {
      return (a.size() < 2 ? 0 : around(corners(a)).radius) <
             (b.size() < 2 ? 0 : around(corners(b)).radius);
    });
    if (largest->size() < 2)
      break;
    const auto points = corners(*largest);
    Vec3<Body> low = points[0], high = points[0];
    for (const Vec3<Body> &p : points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3<Body> d = high - low;
    const auto along = [&](std::uint32_t t) {
      const Triangle &x = mesh.triangles[t];
      const Vec3<Body> c =
          mesh.positions[x.vertex[0]] + mesh.positions[x.vertex[1]] + mesh.positions[x.vertex[2]];
      return d.x >= d.y && d.x >= d.z ? c.x : d.y >= d.z ? c.y : c.z;
    };
    std::stable_sort(largest->begin(), largest->end(),
                     [&](std::uint32_t a, std::uint32_t b) { return along(a) < along(b); });
    const auto half = static_cast<std::ptrdiff_t>(largest->size() / 2);
    std::vector<std::uint32_t> rest(largest->begin() + half, largest->end());
    largest->erase(largest->begin() + half, largest->end());
    parts.push_back(std::move(rest));
  }
  std::vector<Sphere> out;
  for (const auto &part : parts)
    if (!part.empty())
      out.push_back(around(corners(part)));
  return out;
}

bool may_hide(const Sphere &from, const Sphere &other, Vec3<Body> direction) {
  const Vec3<Body> w = other.centre - from.centre;
  const double reach = from.radius + other.radius, ahead = dot(w, direction);
  return ahead > -reach && dot(w, w) - ahead * ahead < reach * reach;
}

} // namespace umov
