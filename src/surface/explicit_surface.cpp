#include <umov/surface/explicit_surface.h>

#include "kernel/gauss.h"
#include "surface/lobe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <umov/shape/occluder.h>

namespace umov {
namespace {

constexpr std::uint32_t stream_of_rays = 0x72617973; // "rays"
constexpr std::uint64_t rays_per_unit = 4096;

/// Bin of a direction; the light comes from +x, so the mirror direction lies at azimuth 180 deg.
template <class F> std::size_t bin_of(Vec3<F> v) {
  constexpr std::size_t zones = SingleScatter::zones;
  const double theta = std::acos(std::clamp(v.z, 0.0, 1.0));
  const double from_mirror = pi - std::abs(std::atan2(v.y, v.x));
  const auto cell = [](double x, double width) {
    return std::min(zones - 1, static_cast<std::size_t>(std::max(0.0, x) / width));
  };
  return cell(theta, pi / 12) * zones + cell(from_mirror, pi / 6);
}

class Tracer {
public:
  explicit Tracer(const HeightField &field)
      : mesh_(mesh_of(field)), occluder_(mesh_), side_(field.side_m()), lift_(1e-3 * field.cell_m) {
    const auto [low, high] = std::minmax_element(field.height_m.begin(), field.height_m.end());
    low_ = *low;
    high_ = *high + 1e-3 * field.cell_m;
  }

  /// Direction in which light leaves after one reflection; nothing if it met more facets.
  bool once(double x, double y, Vec3<Body> direction, Vec3<Body> &out) const {
    Vec3<Body> at{x * side_, y * side_, high_};
    for (int bounces = 0; bounces < 2; ++bounces) {
      std::uint32_t triangle = no_index;
      if (!next_hit(at, direction, triangle))
        return bounces == 1;
      if (bounces == 1)
        return false;
      const Vec3<Body> n = normalized(area_vector_doubled(mesh_, mesh_.triangles[triangle]));
      direction = direction - 2 * dot(direction, n) * n;
      at += lift_ * n;
      out = direction;
    }
    return false;
  }

private:
  /// Moves to the next facet, across the edges of the tile; false where the light leaves upwards.
  bool next_hit(Vec3<Body> &at, Vec3<Body> direction, std::uint32_t &triangle) const {
    constexpr int tiles_max = 10'000; // a ray that grazes for ever counts as gone
    for (int tile = 0; tile < tiles_max; ++tile) {
      const auto hit = occluder_.nearest(at, direction);
      const double to_x = edge(at.x, direction.x), to_y = edge(at.y, direction.y);
      const double to_z =
          direction.z > 0 ? (high_ - at.z) / direction.z : std::numeric_limits<double>::infinity();
      const double exit = std::min(to_x, to_y);
      if (hit.triangle != no_index && hit.distance_m <= std::min(exit, to_z) + lift_) {
        triangle = hit.triangle;
        at += hit.distance_m * direction;
        return true;
      }
      if (to_z <= exit || !std::isfinite(exit))
        return false;
      at += exit * direction;
      wrap(at.x, direction.x);
      wrap(at.y, direction.y);
      if (at.z < low_ - side_)
        return false; // slipped through an edge between tiles: lost, and counted so by the caller
    }
    return false;
  }
  [[nodiscard]] double edge(double x, double d) const {
    return d > 0 ? (side_ - x) / d : d < 0 ? -x / d : std::numeric_limits<double>::infinity();
  }
  void wrap(double &x, double d) const {
    if (d > 0 && x >= side_ * (1 - 1e-12))
      x -= side_;
    else if (d < 0 && x <= side_ * 1e-12)
      x += side_;
  }

  Mesh mesh_;
  Occluder occluder_;
  double side_, lift_, low_ = 0, high_ = 0;
};

} // namespace

SingleScatter trace_height_field(const HeightField &field, double theta_rad, std::uint64_t rays,
                                 std::uint64_t seed, unsigned threads) {
  const Tracer tracer(field);
  const std::uint64_t units = (rays + rays_per_unit - 1) / rays_per_unit;
  std::vector<std::array<std::uint64_t, SingleScatter::zones * SingleScatter::zones>> counts(units);
  const Vec3<Body> down{-std::sin(theta_rad), 0, -std::cos(theta_rad)};
  parallel_for(units, threads, [&](std::size_t unit) {
    const std::uint64_t first = unit * rays_per_unit;
    for (std::uint64_t i = first; i < std::min(rays, first + rays_per_unit); ++i) {
      const auto u = uniform4(seed, stream_of_rays, i);
      Vec3<Body> out{};
      if (tracer.once(u[0], u[1], down, out) && out.z > 0)
        ++counts[unit][bin_of(out)];
    }
  });
  SingleScatter out;
  for (const auto &unit : counts)
    for (std::size_t k = 0; k < unit.size(); ++k)
      out.flux[k] += static_cast<double>(unit[k]) / static_cast<double>(rays);
  for (const double f : out.flux)
    out.once += f;
  return out;
}

SingleScatter model_scatter(const Distribution &normals, Shadowing shadowing, double theta_rad) {
  // Over microfacet normals: dw_v = 4 (h.l) dw_h puts each bit of light into its bin.
  const std::shared_ptr<const Distribution> borrowed(&normals, [](const Distribution *) {});
  const MicrofacetLobe lobe(borrowed, shadowing);
  const Vec3<Facet> l{std::sin(theta_rad), 0, std::cos(theta_rad)};
  SingleScatter out;
  constexpr int tilts = 600, azimuths = 720;
  const double last = std::min(pi / 2, normals.reach_rad());
  for (int i = 0; i < tilts; ++i) {
    const double tilt = last * (i + 0.5) / tilts, s = std::sin(tilt), c = std::cos(tilt);
    for (int j = 0; j < azimuths; ++j) {
      const double phi = 2 * pi * (j + 0.5) / azimuths;
      const Vec3<Facet> h{s * std::cos(phi), s * std::sin(phi), c};
      const double h_l = dot(h, l);
      const Vec3<Facet> v = 2 * h_l * h - l;
      if (h_l <= 0 || v.z <= 0)
        continue;
      const double flux = lobe(l, v, 2 * h_l * h_l - 1, 0) * 4 * h_l * s * (last / tilts) *
                          (2 * pi / azimuths) / l.z;
      out.flux[bin_of(v)] += flux;
      out.once += flux;
    }
  }
  return out;
}

} // namespace umov
