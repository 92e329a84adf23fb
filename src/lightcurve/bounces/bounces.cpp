#include "lightcurve/bounces/bounces.h"

#include "lightcurve/bounces/path_sampler.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

using Light = PathSampler::Light;

constexpr std::size_t replicates = 16; ///< independent shifts of the lattice
/// Paths per replicate before its half-width is believed, twice in a row: with fewer, rare bright
/// paths are missed and their absence is taken for accuracy.
constexpr std::size_t trusted_count = 512;
/// Two-sided 95 % quantile of Student's t with 15 degrees of freedom.
constexpr double student_95 = 2.131449545559323;

} // namespace

BounceScene::BounceScene(const Scene &scene) : scene_(scene), sides_(visible_sides(scene.mesh)) {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Triangle &t : scene.mesh.triangles) {
    const Vec3<Body> doubled = area_vector_doubled(scene.mesh, t);
    const double length = norm(doubled);
    normal_.push_back(length > 0 ? doubled / length : Vec3<Body>{});
    area_m2_.push_back(length / 2);
    for (const std::uint32_t v : t.vertex) {
      const Vec3<Body> p = scene.mesh.positions[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  size_m_ = norm(high - low);
  for (std::size_t g = 0; g < scene.front.size(); ++g) {
    front_sampler_.emplace_back(scene.front[g]);
    back_sampler_.emplace_back(scene.back[g]);
  }
  group_triangles();
}

void BounceScene::group_triangles() {
  double whole = 0;
  for (const double area : area_m2_)
    whole += area;
  constexpr double groups_wanted = 400;
  const Triangle *last = nullptr;
  double area = 0;
  for (std::size_t t = 0; t < area_m2_.size(); ++t) {
    const Triangle &triangle = scene_.mesh.triangles[t];
    const bool is_new = last == nullptr || triangle.front != last->front ||
                        dot(normal_[t], normal_[t - 1]) < 0.8 || area > whole / groups_wanted;
    if (is_new) {
      ++groups_.count;
      area = 0;
    }
    area += area_m2_[t];
    groups_.of.push_back(static_cast<std::uint32_t>(groups_.count - 1));
    last = &triangle;
  }
}

namespace {

/// Mean and half-width of replicates' means.
BandResult summed(const std::vector<std::vector<Light>> &sums, std::size_t band, double count) {
  const auto one = [&](double Light::*part) {
    double mean = 0, squares = 0;
    for (const auto &sum : sums)
      mean += sum[band].*part / count;
    mean /= static_cast<double>(sums.size());
    for (const auto &sum : sums)
      squares += std::pow(sum[band].*part / count - mean, 2);
    const double n = static_cast<double>(sums.size());
    return std::pair{mean, student_95 * std::sqrt(squares / (n * (n - 1)))};
  };
  const auto [i, di] = one(&Light::i);
  const auto [q, dq] = one(&Light::q);
  const auto [u, du] = one(&Light::u);
  const auto [v, dv] = one(&Light::v);
  return {{i, q, u, v}, {di, dq, du, dv}};
}

} // namespace

IndirectLight BounceScene::light(const Occluder &occluder, const Pose &pose,
                                 const IntegrationOptions &options,
                                 const std::vector<double> &direct_i) const {
  const std::size_t bands = scene_.bands.size();
  IndirectLight out;
  out.bands.resize(bands);
  PathSampler sampler(*this, occluder, pose, options);
  if (!sampler.has_any())
    return out;
  std::vector<Lattice> lattices;
  for (std::size_t r = 0; r < replicates; ++r)
    lattices.emplace_back(options.seed, r);
  std::vector<std::vector<Light>> sums(replicates, std::vector<Light>(bands));
  std::size_t done = 0;
  bool was_enough = false;
  const auto most = std::max(trusted_count, options.max_points / replicates);
  for (std::size_t count = 64; count <= most; count *= 2) {
    for (std::size_t r = 0; r < replicates; ++r)
      for (std::size_t k = done; k < count; ++k)
        sampler.add(lattices[r].at(k), r * most + k, sums[r]);
    done = count;
    sampler.adapt();
    bool is_enough = count >= trusted_count;
    for (std::size_t b = 0; b < bands; ++b) {
      out.bands[b] = summed(sums, b, static_cast<double>(count));
      const double whole = direct_i[b] + out.bands[b].stokes.i;
      is_enough = is_enough && out.bands[b].half_width.i <= options.accuracy * whole;
    }
    if (is_enough && was_enough)
      break;
    was_enough = is_enough;
  }
  out.rays = sampler.rays();
  return out;
}

} // namespace umov
