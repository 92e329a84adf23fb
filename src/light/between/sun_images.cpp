#include "light/between/sun_images.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

/// Widths of the reflected lobe, twice those of its normals, that are looked for beside a part:
/// what lies further out is left to the other ways of drawing paths.
constexpr double looked_beside = 2 * 1.5;
/// A part nearer than this, in parts of its size, is the one that the point lies on, or in its
/// plane.
constexpr double nearest = 1e-3;

void put(std::vector<float> (&to)[3], Vec3<Body> v) {
  to[0].push_back(static_cast<float>(v.x));
  to[1].push_back(static_cast<float>(v.y));
  to[2].push_back(static_cast<float>(v.z));
}
void put(std::vector<float> &to, double x) { to.push_back(static_cast<float>(x)); }

} // namespace

SunImages::SunImages(const MirrorParts *parts, Vec3<Body> sun)
    : parts_(parts != nullptr ? std::span(parts->parts()) : std::span<const MirrorPart>{}),
      sun_(sun), image_(parts_.size(), MirrorParts::none) {
  for (std::uint32_t k = 0; k < parts_.size(); ++k) {
    const MirrorPart &part = parts_[k];
    const Vec3<Body> plane = cross(part.along, part.across) *
                             (dot(cross(part.along, part.across), part.normal) < 0 ? -1.0 : 1.0);
    const Vec3<Body> to = -mirrored(sun, part.normal);
    const double step = dot(to, plane);
    if (!(dot(sun, part.normal) > 0) || !(step < -1e-3))
      continue;
    image_[k] = static_cast<std::uint32_t>(part_.size());
    part_.push_back(k);
    put(lanes_.normal, plane);
    put(lanes_.along, part.along);
    put(lanes_.across, part.across);
    put(lanes_.level, dot(plane, part.centre));
    put(lanes_.per_step, 1 / step);
    put(lanes_.along_step, dot(part.along, to));
    put(lanes_.across_step, dot(part.across, to));
    put(lanes_.along_centre, dot(part.along, part.centre));
    put(lanes_.across_centre, dot(part.across, part.centre));
    put(lanes_.half_along, part.half_along_m);
    put(lanes_.half_across, part.half_across_m);
    put(lanes_.spread, looked_beside * part.width);
    put(lanes_.least_way, nearest * std::max(part.half_along_m, part.half_across_m));
  }
}

void SunImages::look_from(Vec3<Body> point, Choice &out) const {
  const std::size_t count = part_.size();
  out.end.resize(count);
  const auto x = static_cast<float>(point.x), y = static_cast<float>(point.y),
             z = static_cast<float>(point.z);
  const Lanes &l = lanes_;
  const auto on = [&](const std::vector<float>(&v)[3], std::size_t k) {
    return v[0][k] * x + v[1][k] * y + v[2][k] * z;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const float way = (l.level[k] - on(l.normal, k)) * l.per_step[k];
    const float beside = way * l.spread[k];
    const float a = on(l.along, k) + way * l.along_step[k] - l.along_centre[k],
                b = on(l.across, k) + way * l.across_step[k] - l.across_centre[k];
    const float reach_a = l.half_along[k] + beside, reach_b = l.half_across[k] + beside;
    const bool is_near =
        (way > l.least_way[k]) & (a * a < reach_a * reach_a) & (b * b < reach_b * reach_b);
    // The share of the lobe that the part can catch.
    out.end[k] = is_near ? l.half_along[k] * l.half_across[k] / (reach_a * reach_b) : 0;
  }
  float sum = 0;
  for (float &end : out.end)
    end = sum += end;
}

double SunImages::lobe(const MirrorPart &part, Vec3<Body> to) const {
  const Vec3<Body> bisector = sun_ - to;
  const double length = norm(bisector);
  if (!(length > 1e-12))
    return 0;
  const double n_h = dot(part.normal, bisector) / length, s_h = dot(sun_, bisector) / length;
  return n_h > 0 && s_h > 0 ? part.normals.density(std::min(n_h, 1.0)) / (4 * s_h) : 0;
}

double SunImages::density(const Choice &choice, std::uint32_t part, Vec3<Body> to) const {
  const std::uint32_t k = part == MirrorParts::none ? MirrorParts::none : image_[part];
  if (k == MirrorParts::none || choice.is_empty())
    return 0;
  const float chance = choice.end[k] - (k > 0 ? choice.end[k - 1] : 0);
  return static_cast<double>(chance / choice.end.back()) * lobe(parts_[part], to);
}

SunImages::Drawn SunImages::draw(const Choice &choice, double x, double u, double v) const {
  if (choice.is_empty())
    return {};
  const auto wanted = static_cast<float>(x) * choice.end.back();
  const auto found = std::upper_bound(choice.end.begin(), choice.end.end() - 1, wanted);
  Drawn out;
  out.part = part_[static_cast<std::size_t>(found - choice.end.begin())];
  const MirrorPart &part = parts_[out.part];
  const Vec3<Body> h = about(part.normal, part.normals.cosine(u), v);
  out.to = -mirrored(sun_, h);
  out.density = density(choice, out.part, out.to);
  return out;
}

} // namespace umov
