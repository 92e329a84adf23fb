#include "lightcurve/bounces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <umov/core/quantity.h>
#include <umov/core/random.h>

namespace umov {
namespace {

using Light = Stokes<ScatteringPlane>;

constexpr double offset_of_size = 1e-5;
constexpr std::size_t replicates = 16; ///< independent shifts of the lattice
/// Two-sided 95 % quantile of Student's t with 15 degrees of freedom.
constexpr double student_95 = 2.131449545559323;
constexpr std::size_t surfaces_max = 64;

/// A point of the surface, on the side that faces where the path came from.
struct Vertex {
  Vec3<Body> point{}, face{}, normal{}; ///< face: geometric, normal: shading; out of that side
  Vec3<Body> field{};
  const Surface *surface = nullptr;
};

/// Axis +Q of a beam that leaves towards `out` and came from direction `in`: the normal of the
/// plane.
Vec3<Body> plane_normal(Vec3<Body> out, Vec3<Body> in) {
  const Vec3<Body> s = cross(out, in);
  return norm(s) > 1e-14 ? normalized(s) : any_perpendicular(out);
}

/// Light that travels along k, from axes s to axes t.
Light turned(const Light &light, Vec3<Body> s, Vec3<Body> t, Vec3<Body> k) {
  return rotate_to<ScatteringPlane>(light,
                                    Angle::radians(std::atan2(dot(t, cross(k, s)), dot(t, s))));
}

/// Points of a cumulative table of areas.
struct AreaTable {
  std::vector<std::uint32_t> triangle;
  std::vector<double> end; ///< area up to and with each triangle
  [[nodiscard]] double area() const { return end.empty() ? 0 : end.back(); }
};

/// Kronecker's sequence with the powers of the root of x^7 = x + 1 (Roberts 2018), shifted.
constexpr std::size_t dimensions = 6;
class Lattice {
public:
  Lattice(std::uint64_t seed, std::size_t replicate) {
    for (std::size_t d = 0; d < dimensions; d += 2) {
      const auto u = uniform4(seed, 0xB0C, replicate * dimensions + d);
      shift_[d] = u[0];
      shift_[d + 1] = u[1];
    }
  }
  [[nodiscard]] std::array<double, dimensions> at(std::size_t index) const {
    constexpr double root = 1.1127756842787055; // of x^7 = x + 1
    std::array<double, dimensions> out{};
    double power = 1;
    for (std::size_t d = 0; d < dimensions; ++d) {
      power /= root;
      const double x = shift_[d] + power * static_cast<double>(index);
      out[d] = x - std::floor(x);
    }
    return out;
  }

private:
  std::array<double, dimensions> shift_{};
};

struct Direction {
  Vec3<Body> to{};
  double density = 0; ///< [1/sr]
};

bool is_mirror(const Surface &surface) {
  const Distribution *normals = surface.normals(0);
  return normals != nullptr && normals->is_mirror();
}
Vec3<Body> mirrored(Vec3<Body> direction, Vec3<Body> normal) {
  return normalized(normal * (2 * dot(direction, normal)) - direction);
}

/// How directions are drawn at a surface: Lambert's cosine, or the mirror image about a normal
/// drawn from a lobe as wide as the surface's.
struct Sampler {
  double cosine_share, exponent;
  explicit Sampler(const Surface &surface) {
    const double slope = std::clamp(surface.width(), 1e-3, 1.0);
    exponent = std::clamp(1 / (slope * slope) - 2, 0.0, 1e6);
    cosine_share = surface.has_diffuse() ? 0.5 : 0.2;
  }
  [[nodiscard]] double density(Vec3<Body> normal, Vec3<Body> from, Vec3<Body> to) const {
    const double cosine = dot(normal, to);
    if (!(cosine > 0))
      return 0;
    const Vec3<Body> sum = from + to;
    const double length = norm(sum);
    double lobe = 0;
    if (length > 1e-12) {
      const double n_h = dot(normal, sum) / length, f_h = dot(from, sum) / length;
      if (n_h > 0 && f_h > 0)
        lobe = (exponent + 1) / (2 * pi) * std::pow(n_h, exponent) / (4 * f_h);
    }
    return cosine_share * cosine / pi + (1 - cosine_share) * lobe;
  }
  [[nodiscard]] Direction draw(Vec3<Body> normal, Vec3<Body> from, double choice, double u,
                               double v) const {
    const Vec3<Body> x = any_perpendicular(normal), y = cross(normal, x);
    const double azimuth = 2 * pi * v;
    const auto about_normal = [&](double c) {
      const double s = std::sqrt(std::max(0.0, 1 - c * c));
      return normal * c + x * (s * std::cos(azimuth)) + y * (s * std::sin(azimuth));
    };
    Vec3<Body> to;
    if (choice < cosine_share) {
      to = about_normal(std::sqrt(u));
    } else {
      const Vec3<Body> h = about_normal(std::pow(u, 1 / (exponent + 1)));
      to = mirrored(from, h);
    }
    return {to, density(normal, from, to)};
  }
};

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
}

/// Paths of one pose.
class PathSampler {
public:
  PathSampler(const BounceScene &of, const Occluder &occluder, const Pose &pose,
              const IntegrationOptions &options)
      : of_(of), scene_(of.scene_), occluder_(occluder), pose_(pose), options_(options),
        bands_(of.scene_.bands.size()), seen_(facing(pose.observer)), lit_(facing(pose.sun)),
        plane_(plane_normal(pose.observer, pose.sun)) {}

  [[nodiscard]] bool has_any() const { return seen_.area() > 0 && lit_.area() > 0; }

  /// Adds what one pair of paths carries: one from the observer, one from the Sun.
  void add(const std::array<double, dimensions> &x, std::uint64_t stream, std::vector<Light> &sum) {
    from_observer(x, stream, sum);
    from_sun(x, sum);
  }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

private:
  [[nodiscard]] AreaTable facing(Vec3<Body> direction) const {
    AreaTable out;
    double area = 0;
    for (std::uint32_t t = 0; t < of_.normal_.size(); ++t) {
      const double cosine = dot(of_.normal_[t], direction);
      if (!(cosine > 0 ? of_.sides_[t].front : cosine < 0 && of_.sides_[t].back))
        continue;
      area += of_.area_m2_[t];
      out.triangle.push_back(t);
      out.end.push_back(area);
    }
    return out;
  }

  [[nodiscard]] Vertex vertex_on(std::uint32_t t, double b1, double b2, Vec3<Body> towards) const {
    const Mesh &mesh = scene_.mesh;
    const Triangle &triangle = mesh.triangles[t];
    const double side = dot(of_.normal_[t], towards) < 0 ? -1 : 1;
    const double weight[3] = {1 - b1 - b2, b1, b2};
    Vertex out;
    out.face = side * of_.normal_[t];
    out.normal = out.face;
    Vec3<Body> bent{};
    bool is_smooth = scene_.normals == NormalMode::Smooth;
    for (std::size_t k = 0; k < 3; ++k) {
      out.point += weight[k] * mesh.positions[triangle.vertex[k]];
      is_smooth = is_smooth && triangle.normal[k] != no_index;
      if (is_smooth)
        bent += weight[k] * mesh.normals[triangle.normal[k]];
    }
    if (is_smooth && norm(bent) > 0)
      out.normal = normalized(dot(bent, out.face) < 0 ? -bent : bent);
    out.point += out.face * (offset_of_size * of_.size_m_);
    out.surface = side > 0 ? &scene_.front[triangle.front] : &scene_.back[triangle.back];
    out.field = direction_field(mesh, *out.surface, t);
    return out;
  }

  [[nodiscard]] Vertex vertex_at(const AreaTable &table, double x, double u, double v,
                                 Vec3<Body> towards) const {
    const double wanted = x * table.area();
    const auto it = std::upper_bound(table.end.begin(), table.end.end(), wanted);
    const auto k =
        std::min(static_cast<std::size_t>(it - table.end.begin()), table.triangle.size() - 1);
    const double root = std::sqrt(u); // even over the triangle
    return vertex_on(table.triangle[k], root * (1 - v), root * v, towards);
  }

  bool is_free(Vec3<Body> from, Vec3<Body> direction) {
    ++rays_;
    unsigned char free = 0;
    occluder_.is_free(std::span(&from, 1), direction, std::span(&free, 1));
    return free != 0;
  }

  /// The next surface, if there is one that can be seen from outside.
  bool next(const Vertex &from, Vec3<Body> direction, Vertex &to, double &distance) {
    ++rays_;
    if (!(dot(from.face, direction) > 0))
      return false;
    const Occluder::Hit hit = occluder_.nearest(from.point, direction);
    if (hit.triangle == no_index)
      return false;
    to =
        vertex_on(hit.triangle, static_cast<double>(hit.u), static_cast<double>(hit.v), -direction);
    distance = hit.distance_m;
    return distance > 0;
  }

  /// f (n.in) applied to light that comes from direction `in` and leaves to `out`. The light's axes
  /// are those of this plane, before and after.
  [[nodiscard]] Light scattered(const Vertex &at, std::size_t band, Vec3<Body> in, Vec3<Body> out,
                                double disk, bool is_drawn_by_mirror, const Light &light) const {
    const double cosine = dot(at.normal, in);
    if (!(cosine > 0) || !(dot(at.normal, out) > 0))
      return {};
    if (is_drawn_by_mirror) // the one direction there is: radiance is kept but for Fresnel
      return at.surface->mueller(band, std::clamp(dot(in, out), -1.0, 1.0)) * light;
    const auto on =
        directions_on(at.normal, at.field, in, out, std::clamp(dot(in, out), -1.0, 1.0), disk);
    return at.surface->brdf(band, on) * light * cosine;
  }

  /// Light of the Sun that goes x[count-1] ... x[0] and then to the observer, in the pose's axes.
  /// `step[i]`: direction from x[i] to x[i+1].
  [[nodiscard]] Light along(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                            std::size_t band, bool is_sun_mirrored = false) const {
    Light light = options_.source;
    Vec3<Body> axis = plane_, from = pose_.sun;
    for (std::size_t i = count; i-- > 0;) {
      const Vec3<Body> out = i == 0 ? pose_.observer : -step[i - 1];
      const Vec3<Body> plane = plane_normal(out, from);
      const bool is_last = i + 1 == count;
      light = scattered(x[i], band, from, out, is_last ? pose_.sun_radius_rad : 0,
                        (!is_last || is_sun_mirrored) && is_mirror(*x[i].surface),
                        turned(light, axis, plane, -from));
      if (light.i == 0)
        return {};
      axis = plane;
      from = -out; // the next surface sees it coming from here
    }
    return turned(light, axis, plane_, pose_.observer);
  }

  void from_observer(const std::array<double, dimensions> &x, std::uint64_t stream,
                     std::vector<Light> &sum) {
    std::array<Vertex, surfaces_max> path;
    std::array<Vec3<Body>, surfaces_max> step;
    path[0] = vertex_at(seen_, x[0], x[1], x[2], pose_.observer);
    const double leaving = dot(path[0].normal, pose_.observer);
    if (!(leaving > 0) || !is_free(path[0].point, pose_.observer))
      return;
    double weight = leaving * seen_.area();
    Vec3<Body> back = pose_.observer;
    for (std::size_t k = 0; k + 1 < std::min(options_.bounces, surfaces_max); ++k) {
      std::array<double, 4> u{x[3], x[4], x[5], 0};
      if (k > 0)
        u = uniform4(options_.seed, 0xB0D + static_cast<std::uint32_t>(k), stream);
      const bool is_delta = is_mirror(*path[k].surface);
      const Direction d =
          is_delta ? Direction{mirrored(back, path[k].normal), 1}
                   : Sampler(*path[k].surface).draw(path[k].normal, back, u[0], u[1], u[2]);
      double distance = 0;
      if (!(d.density > 0) || !next(path[k], d.to, path[k + 1], distance))
        return;
      weight /= d.density;
      step[k] = d.to;
      back = -d.to;
      const Vertex &end = path[k + 1];
      if (!(dot(end.face, pose_.sun) > 0) || !is_free(end.point, pose_.sun))
        continue;
      double share = 1;
      if (k == 0 && !is_delta && is_mirror(*end.surface))
        continue;                // only the Sun's side meets its image
      if (k == 0 && !is_delta) { // the same path could have been drawn from the Sun
        const double d2 = distance * distance;
        const double here = d.density * dot(end.face, back) / d2 / seen_.area();
        const double there = Sampler(*end.surface).density(end.normal, pose_.sun, back) *
                             dot(path[0].face, d.to) / d2 / lit_.area();
        share = here / (here + there); // the balance heuristic (Veach & Guibas 1995)
      }
      for (std::size_t b = 0; b < bands_; ++b)
        sum[b] += along(path.data(), step.data(), k + 2, b) * (weight * share);
    }
  }

  /// Paths of two surfaces begun where the Sun shines.
  void from_sun(const std::array<double, dimensions> &x, std::vector<Light> &sum) {
    std::array<Vertex, 2> path; // [0] is seen, [1] is lit
    path[1] = vertex_at(lit_, x[0], x[1], x[2], pose_.sun);
    if (!(dot(path[1].normal, pose_.sun) > 0) || !is_free(path[1].point, pose_.sun))
      return;
    const bool is_delta = is_mirror(*path[1].surface);
    const Direction d =
        is_delta ? Direction{mirrored(pose_.sun, path[1].normal), 1}
                 : Sampler(*path[1].surface).draw(path[1].normal, pose_.sun, x[3], x[4], x[5]);
    double distance = 0;
    if (!(d.density > 0) || !next(path[1], d.to, path[0], distance))
      return;
    const Vec3<Body> back = -d.to; // from the seen surface to the lit one
    if (!(dot(path[0].face, pose_.observer) > 0) || !is_free(path[0].point, pose_.observer))
      return;
    const double leaving = dot(path[0].normal, pose_.observer);
    if (!(leaving > 0))
      return;
    if (is_mirror(*path[0].surface))
      return;       // only the observer's side meets it
    if (is_delta) { // the flux of the Sun's image: f1 without its cosine
      const double arriving = dot(path[0].normal, back);
      for (std::size_t b = 0; arriving > 0 && b < bands_; ++b)
        sum[b] += along(path.data(), &back, 2, b, true) *
                  (leaving * lit_.area() * dot(path[1].normal, pose_.sun) / arriving);
      return;
    }
    const double d2 = distance * distance;
    const double here = d.density * dot(path[0].face, back) / d2 / lit_.area();
    const double there = Sampler(*path[0].surface).density(path[0].normal, pose_.observer, back) *
                         dot(path[1].face, d.to) / d2 / seen_.area();
    // The flux that goes out towards `d.to` is spread over the seen surface: in area measure the
    // integrand is f f cos cos cos cos / d^2, and the density is `here` of both points.
    const double weight = leaving * dot(path[1].face, d.to) / d2 / (here + there);
    for (std::size_t b = 0; b < bands_; ++b)
      sum[b] += along(path.data(), &back, 2, b) * weight;
  }

  const BounceScene &of_;
  const Scene &scene_;
  const Occluder &occluder_;
  const Pose &pose_;
  const IntegrationOptions &options_;
  std::size_t bands_;
  AreaTable seen_, lit_;
  Vec3<Body> plane_; ///< normal of the pose's scattering plane
  std::uint64_t rays_ = 0;
};

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
  const auto most = std::max<std::size_t>(64, options.max_points / replicates);
  for (std::size_t count = 64; count <= most; count *= 2) {
    for (std::size_t r = 0; r < replicates; ++r)
      for (std::size_t k = done; k < count; ++k)
        sampler.add(lattices[r].at(k), r * most + k, sums[r]);
    done = count;
    bool is_enough = true;
    for (std::size_t b = 0; b < bands; ++b) {
      out.bands[b] = summed(sums, b, static_cast<double>(count));
      const double whole = direct_i[b] + out.bands[b].stokes.i;
      is_enough = is_enough && out.bands[b].half_width.i <= options.accuracy * whole;
    }
    if (is_enough)
      break;
  }
  out.rays = sampler.rays();
  return out;
}

} // namespace umov
