#include "light/between/path_sampler.h"

#include "light/between/beam_axes.h"
#include "light/between/directions.h"

#include <cmath>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using Light = PathSampler::Light;

/// Streams of random numbers: one for each surface of a path from either end, and one of its own
/// for the first step of a picture's paths (equal numbers for two steps would tie them together).
constexpr std::uint32_t observer_stream = 0xB0D,
                        sun_stream = observer_stream + PathSampler::surfaces_max,
                        image_stream = sun_stream + PathSampler::surfaces_max,
                        picture_stream = 0xB0B;

} // namespace

PathSampler::PathSampler(const BounceScene &of, const Occluder &occluder, const Pose &pose,
                         const IntegrationOptions &options, const ThermalEmission *emission,
                         const ChainSurfaces *chains, bool has_ends)
    : of_(of), scene_(of.scene_), occluder_(occluder), pose_(pose), options_(options),
      chains_(chains), bands_(of.scene_.grid.nodes().size()),
      seen_(has_ends ? facing(pose.observer) : AreaChoice({}, of.area_m2_, of.groups_)),
      lit_(has_ends ? facing(pose.sun) : AreaChoice({}, of.area_m2_, of.groups_)),
      emission_(emission),
      images_(has_ends && emission == nullptr && options.bounces > 2 ? &of.mirrors() : nullptr,
              pose.sun),
      plane_(plane_normal(pose.observer, pose.sun)) {}

void PathSampler::add(const std::array<double, dimensions> &x, std::uint64_t stream,
                      std::vector<Light> &sum) {
  const Vertex seen = vertex_at(seen_, x[0], x[1], x[2], pose_.observer);
  seen_.learn(seen.triangle, from_observer(seen, x, stream, sum));
  if (emission_ != nullptr)
    return;
  const Vertex lit = vertex_at(lit_, x[0], x[1], x[2], pose_.sun);
  lit_.learn(lit.triangle, from_sun(lit, x, stream, sum));
}

AreaChoice PathSampler::facing(Vec3<Body> direction) const {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < of_.normal_.size(); ++t) {
    const double cosine = dot(of_.normal_[t], direction);
    const bool is_front = cosine > 0;
    if ((is_front ? of_.sides_[t].front : cosine < 0 && of_.sides_[t].back) &&
        (chains_ == nullptr || chains_->leaves_any(chains_->kind_of(
                                   &surface_of_side(scene_, scene_.mesh.triangles[t], is_front)))))
      triangles.push_back(t);
  }
  return {std::move(triangles), of_.area_m2_, of_.groups_};
}

Vertex PathSampler::vertex_at(const AreaChoice &choice, double x, double u, double v,
                              Vec3<Body> towards) const {
  const double root = std::sqrt(u); // even over the triangle
  return of_.vertex_on(choice.at(x), root * (1 - v), root * v, towards);
}

bool PathSampler::is_free(Vec3<Body> from, Vec3<Body> direction) {
  ++rays_;
  unsigned char free = 0;
  occluder_.is_free(std::span(&from, 1), direction, std::span(&free, 1));
  return free != 0;
}

bool PathSampler::next(const Vertex &from, Vec3<Body> direction, Vertex &to, double &distance) {
  ++rays_;
  return of_.next(occluder_, from, direction, to, distance);
}

Light PathSampler::scattered(const Vertex &at, std::size_t band, Vec3<Body> in, Vec3<Body> out,
                             double disk, bool is_by_mirror, const Light &light,
                             bool is_lobe_alone) const {
  const double cosine = dot(at.normal, in);
  if (!(cosine > 0) || !(dot(at.normal, out) > 0))
    return {};
  const double l_v = std::clamp(dot(in, out), -1.0, 1.0);
  if (is_by_mirror) // the one direction there is: radiance is kept but for Fresnel
    return at.surface->mueller(band, l_v) * light * at.surface->mirror_part(band, cosine);
  const auto on = directions_on(at.normal, at.field, in, out, l_v, disk);
  if (is_lobe_alone)
    return at.surface->mueller(band, l_v) * light *
           (at.surface->specular(band, on) / dot(at.normal, out));
  return at.surface->brdf(band, on) * light * cosine;
}

Light PathSampler::carried(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                           std::size_t band, Light light, Vec3<Body> axis, Vec3<Body> beam,
                           bool is_lobe_alone) const {
  for (std::size_t i = count; i-- > 0 && light.i != 0;) {
    const Vec3<Body> out = i == 0 ? pose_.observer : -step[i - 1], from = -beam;
    const Vec3<Body> plane = plane_normal(out, from);
    light = scattered(x[i], band, from, out, 0, x[i].is_by_mirror, turned(light, axis, plane, beam),
                      is_lobe_alone && i == 0);
    axis = plane;
    beam = out;
  }
  return light.i != 0 ? turned(light, axis, plane_, pose_.observer) : Light{};
}

Light PathSampler::along(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                         std::size_t band, SunEnd end, bool is_lobe_alone) const {
  const std::size_t last = count - 1;
  const Vec3<Body> out = last == 0 ? pose_.observer : -step[last - 1];
  const Vec3<Body> plane = plane_normal(out, pose_.sun);
  // A mirror shows the Sun only as a disk: a point Sun leaves all but the mirror.
  const double disk = end == SunEnd::Disk ? pose_.sun_radius_rad : 0;
  const Light light = scattered(x[last], band, pose_.sun, out, disk, end == SunEnd::Mirror,
                                turned(options_.source, plane_, plane, -pose_.sun), is_lobe_alone);
  return carried(x, step, last, band, light, plane, out, is_lobe_alone);
}

Light PathSampler::emitted(const Vertex *x, const Vec3<Body> *step, std::size_t last,
                           std::size_t band) const {
  const Vec3<Body> out = last == 0 ? pose_.observer : -step[last - 1];
  const Vertex &at = x[last];
  const Triangle &triangle = scene_.mesh.triangles[at.triangle];
  const auto radiance = emission_->radiance(at.is_front ? triangle.front : triangle.back,
                                            at.is_front, band, dot(at.normal, out));
  return carried(x, step, last, band, {radiance.i, radiance.q, 0, 0}, plane_normal(at.normal, out),
                 out);
}

double PathSampler::add_emitted(const Vertex *x, const Vec3<Body> *step, std::size_t last,
                                double weight, std::vector<Light> &sum) const {
  double first = 0;
  for (std::size_t b = 0; b < bands_; ++b) {
    const Light light = emitted(x, step, last, b) * weight;
    sum[b] += light;
    first += b == 0 ? light.i : 0;
  }
  return first;
}

double PathSampler::sun_over_observer(const Vertex *x, const Vec3<Body> *step,
                                      std::size_t count) const {
  double out = lit_.density(x[count - 1].triangle) / seen_.density(x[0].triangle);
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const Vec3<Body> before = k == 0 ? pose_.observer : -step[k - 1];
    const Vec3<Body> after = k + 2 == count ? pose_.sun : step[k + 1];
    const double outward =
        x[k].sampler->density(x[k].normal, before, step[k]) * dot(x[k + 1].face, -step[k]);
    const double inward =
        x[k + 1].sampler->density(x[k + 1].normal, after, -step[k]) * dot(x[k].face, step[k]);
    out *= outward > 0 ? inward / outward : INFINITY;
  }
  return out;
}

double PathSampler::image_over_observer(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                                        const SunImages::Choice &seen_from) const {
  if (count < 3 || seen_from.is_empty())
    return 0;
  const Vertex &from = x[count - 2];
  const Vec3<Body> to = step[count - 2];
  const double by_chance = from.sampler->density(from.normal, -step[count - 3], to);
  return by_chance > 0
             ? images_.density(seen_from, of_.mirrors().part_of(x[count - 1]), to) / by_chance
             : 0; // behind its shading normal, where it scatters nothing
}

void PathSampler::look_at_images(const Vertex &from, SunImages::Choice &out) const {
  const bool is_wide = from.surface->has_diffuse() || !MirrorParts::is_narrow(*from.surface);
  if (images_.is_empty() || !is_wide || from.sampler->is_mirror())
    out.end.clear();
  else
    images_.look_from(from.point, out);
}

ChainPart PathSampler::part_of_chains(const Vertex &first, const Vertex &last) const {
  return chains_ == nullptr
             ? ChainPart::Nothing
             : chains_->part(chains_->kind_of(first.surface), chains_->kind_of(last.surface));
}

double PathSampler::add_path(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                             double weight, SunEnd end, std::vector<Light> &sum) const {
  const ChainPart by_chains = part_of_chains(x[0], x[count - 1]);
  if (by_chains == ChainPart::Whole)
    return 0;
  double first = 0;
  for (std::size_t b = 0; b < bands_; ++b) {
    const Light light =
        along(x, step, count, b, end, by_chains == ChainPart::WithoutLobes) * weight;
    sum[b] += light;
    first += b == 0 ? light.i : 0;
  }
  return first;
}

double PathSampler::from_observer(const Vertex &first, const std::array<double, dimensions> &x,
                                  std::uint64_t stream, std::vector<Light> &sum) {
  const double leaving = dot(first.normal, pose_.observer);
  if (!(leaving > 0) || !is_free(first.point, pose_.observer))
    return 0;
  return go_on(first, leaving / seen_.density(first.triangle), false, x, stream, sum);
}

void PathSampler::look(const SurfacePoint &at, std::uint64_t stream, std::vector<Light> &sum) {
  const auto u = uniform4(options_.seed, picture_stream, stream);
  const Vertex first = of_.vertex_on(at.triangle, at.second, at.third, pose_.observer);
  if (dot(first.normal, pose_.observer) > 0)
    go_on(first, 1, true, {0, 0, 0, u[0], u[1], u[2]}, stream, sum);
}

double PathSampler::go_on(const Vertex &first, double weight, bool is_alone,
                          const std::array<double, dimensions> &x, std::uint64_t stream,
                          std::vector<Light> &sum) {
  auto &path = path_;
  auto &step = step_;
  path[0] = first;
  double found = emission_ != nullptr ? add_emitted(path.data(), step.data(), 0, weight, sum) : 0;
  Vec3<Body> back = pose_.observer;
  for (std::size_t k = 0; k + 1 < std::min(options_.bounces, surfaces_max); ++k) {
    if (k > 0 && !is_alone && emission_ == nullptr) {
      look_at_images(path[k], from_here_);
      found += add_by_image(k, weight, stream, sum);
    }
    std::array<double, 4> u{x[3], x[4], x[5], 0};
    if (k > 0)
      u = uniform4(options_.seed, observer_stream + static_cast<std::uint32_t>(k), stream);
    const Direction d = path[k].sampler->draw(path[k].normal, back, u[0], u[1], u[2]);
    path[k].is_by_mirror = d.is_by_mirror;
    is_alone = is_alone || d.is_by_mirror; // the Sun's side does not go by mirrors
    double distance = 0;
    if (!(d.density > 0) || !next(path[k], d.to, path[k + 1], distance))
      return found;
    weight /= d.density;
    step[k] = d.to;
    back = -d.to;
    if (emission_ != nullptr) {
      found += add_emitted(path.data(), step.data(), k + 1, weight, sum);
      continue;
    }
    const Vertex &end = path[k + 1];
    if (!(dot(end.face, pose_.sun) > 0) || !is_asked(first, end) || !is_free(end.point, pose_.sun))
      continue;
    const auto add = [&](double factor, SunEnd what) {
      found += add_path(path.data(), step.data(), k + 2, weight * factor, what, sum);
    };
    const double mirror_share = end.sampler->mirror_share;
    if (is_alone) {
      add(1, SunEnd::Disk);
      continue;
    }
    // The Sun's image in a mirror, seen by one more surface, is found from the Sun's side; behind
    // more of them it is met by chance.
    if (k > 0 && mirror_share > 0)
      add(1, SunEnd::Disk);
    if (mirror_share == 1)
      continue;
    // The same path could have been drawn from the Sun, or led to it: the balance heuristic (Veach
    // & Guibas 1995).
    const double share = 1 / (1 + sun_over_observer(path.data(), step.data(), k + 2) +
                              image_over_observer(path.data(), step.data(), k + 2, from_here_));
    if (mirror_share == 0)
      add(share, SunEnd::Disk);
    else
      add(k > 0 ? share - 1 : share, SunEnd::WithoutMirror); // all of it was in the disk's, above
  }
  return found;
}

double PathSampler::add_by_image(std::size_t k, double weight, std::uint64_t stream,
                                 std::vector<Light> &sum) {
  if (from_here_.is_empty())
    return 0;
  const auto u = uniform4(options_.seed, image_stream + static_cast<std::uint32_t>(k), stream);
  const SunImages::Drawn drawn = images_.draw(from_here_, u[0], u[1], u[2]);
  double distance = 0;
  Vertex &end = path_[k + 1];
  // Met first by something else, the direction is another path's.
  if (!(drawn.density > 0) || !(dot(path_[k].normal, drawn.to) > 0) ||
      !next(path_[k], drawn.to, end, distance) || of_.mirrors().part_of(end) != drawn.part ||
      !(dot(end.face, pose_.sun) > 0) || !is_asked(path_[0], end) || !is_free(end.point, pose_.sun))
    return 0;
  step_[k] = drawn.to;
  const double led = image_over_observer(path_.data(), step_.data(), k + 2, from_here_);
  const double share = led / (1 + sun_over_observer(path_.data(), step_.data(), k + 2) + led);
  return add_path(path_.data(), step_.data(), k + 2, weight / drawn.density * share, SunEnd::Disk,
                  sum);
}

double PathSampler::from_sun(const Vertex &first, const std::array<double, dimensions> &x,
                             std::uint64_t stream, std::vector<Light> &sum) {
  const std::size_t most = std::min(options_.bounces, surfaces_max);
  // Filled from the end: path[at] is the surface that the observer is asked to see.
  auto &path = path_;
  auto &step = step_;
  std::size_t at = most - 1;
  path[at] = first;
  const double arriving = dot(first.normal, pose_.sun);
  if (!(arriving > 0) || !is_free(first.point, pose_.sun))
    return 0;
  double weight = 1 / lit_.density(first.triangle), found = 0;
  Vec3<Body> back = pose_.sun;
  for (std::size_t k = 0; k + 1 < most; ++k) {
    std::array<double, 4> u{x[3], x[4], x[5], 0};
    if (k > 0)
      u = uniform4(options_.seed, sun_stream + static_cast<std::uint32_t>(k), stream);
    const Direction d = path[at].sampler->draw(path[at].normal, back, u[0], u[1], u[2]);
    if (d.is_by_mirror && k > 0)
      return found; // from the observer's side alone
    double distance = 0;
    if (!(d.density > 0) || !next(path[at], d.to, path[at - 1], distance))
      return found;
    --at;
    step[at] = back = -d.to; // from the surface just met to the one before
    const Vertex &end = path[at];
    if (end.sampler->is_mirror())
      return found; // only the observer's side meets it
    const double leaving = dot(end.normal, pose_.observer), received = dot(end.normal, back);
    // In area measure the integrand holds the cosines at both ends of each step.
    weight *= dot(path[at + 1].face, d.to) / d.density / dot(end.face, back);
    if (k == 0 && !d.is_by_mirror)
      look_at_images(end, from_first_);
    const bool is_seen = dot(end.face, pose_.observer) > 0 && leaving > 0 && is_asked(end, first) &&
                         is_free(end.point, pose_.observer);
    if (d.is_by_mirror) { // the flux of the Sun's image: f1 without its cosine; no further surface
      return is_seen && received > 0 ? add_path(&path[at], &step[at], 2,
                                                leaving * arriving / received /
                                                    lit_.density(first.triangle) / d.density,
                                                SunEnd::Mirror, sum)
                                     : 0;
    }
    if (!is_seen)
      continue;
    const double sun = sun_over_observer(&path[at], &step[at], k + 2),
                 others = 1 + image_over_observer(&path[at], &step[at], k + 2, from_first_);
    found += add_path(&path[at], &step[at], k + 2, weight * leaving / (1 + others / sun),
                      first.sampler->mirror_share > 0 ? SunEnd::WithoutMirror : SunEnd::Disk, sum);
  }
  return found;
}

} // namespace umov
