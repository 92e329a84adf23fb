#include "light/between/chain_cover.h"

#include "light/reference/elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace umov {
namespace {

std::uint32_t slots_of(const Scene &scene) {
  return static_cast<std::uint32_t>(scene.front.size() + scene.back.size());
}

Scene without_mesh(const Scene &of) {
  Scene out;
  out.normals = of.normals;
  out.bands = of.bands;
  out.grid = of.grid;
  out.front = of.front;
  out.back = of.back;
  return out;
}

bool is_alike(const Sampler &a, const Sampler &b) {
  return a.mirror_share == b.mirror_share && a.cosine_share == b.cosine_share &&
         a.normals.form.kind == b.normals.form.kind && a.normals.form.shape == b.normals.form.shape;
}

/// Light from a direction, and where it goes: the mirror images about normals tilted by some angles
/// in the plane of incidence and across, which tell a lobe and its surroundings.
struct Probe {
  Vec3<Body> from;
  std::vector<Vec3<Body>> to = {};
};

std::vector<Probe> probes() {
  std::vector<Probe> out;
  for (const double cosine : {0.95, 0.6, 0.2}) {
    Probe &probe = out.emplace_back(Probe{{std::sqrt(1 - cosine * cosine), 0, cosine}});
    for (const double tilt : {0.0, 0.03, 0.06, 0.12, 0.25, 0.5, 0.8})
      for (const Vec3<Body> about : {Vec3<Body>{std::sin(tilt), 0, std::cos(tilt)},
                                     Vec3<Body>{0, std::sin(tilt), std::cos(tilt)}})
        if (const Vec3<Body> to = mirrored(probe.from, about); to.z > 0.02)
          probe.to.push_back(to);
  }
  return out;
}

double mean_albedo(const Surface &surface, std::size_t bands, Vec3<Facet> from) {
  double mean = 0;
  for (std::size_t b = 0; b < bands; ++b)
    mean += surface.albedo(b, from) / static_cast<double>(bands);
  return mean;
}

/// How many times as much as the other in the mean of its bands, of the light from a direction; no
/// less than 1. What is as much brighter everywhere has as much fewer chains, and half-widths know.
double times_as_much(double albedo, double old_mean) {
  constexpr double most = 32;
  return old_mean > 0 ? std::clamp(albedo / old_mean, 1.0, most) : 1;
}

/// Nowhere, and in no band, a few times as much as the other in the mean of its bands beyond that:
/// of what goes where the other sends little few chains would carry most, and no half-width tell.
bool is_within(const Surface &surface, const Surface &old, std::size_t bands,
               std::size_t old_bands) {
  constexpr double most = 8;
  if (surface.is_same(old))
    return true;
  if (surface.has_mirror() && !old.has_mirror())
    return false;
  const Vec3<Body> normal{0, 0, 1}, field{1, 0, 0};
  for (const auto &[from, all_to] : probes()) {
    const Vec3<Facet> on_facet{from.x, from.y, from.z};
    const double old_mean = mean_albedo(old, old_bands, on_facet);
    std::vector<double> allowed;
    for (std::size_t b = 0; b < bands; ++b)
      allowed.push_back(most * times_as_much(surface.albedo(b, on_facet), old_mean));
    double mirrored = 0;
    for (std::size_t b = 0; b < old_bands; ++b)
      mirrored += old.mirror_part(b, from.z) * old.reflection(b, from.z).a;
    for (std::size_t b = 0; b < bands; ++b)
      if (surface.mirror_part(b, from.z) * surface.reflection(b, from.z).a >
          allowed[b] * mirrored / static_cast<double>(old_bands))
        return false;
    for (const Vec3<Body> &to : all_to) {
      const auto on = directions_on(normal, field, from, to, dot(from, to), 0);
      double sum = 0;
      for (std::size_t b = 0; b < old_bands; ++b)
        sum += old.brdf(b, on).m[0][0];
      for (std::size_t b = 0; b < bands; ++b)
        if (surface.brdf(b, on).m[0][0] > allowed[b] * sum / static_cast<double>(old_bands))
          return false;
    }
  }
  return true;
}

} // namespace

ChainCover::Member::Member(const Scene &of) : sides(without_mesh(of)), surfaces(sides) {}

ChainCover::ChainCover(const std::vector<const Scene *> &scenes) {
  for (const Scene *scene : scenes)
    members_.push_back(std::make_unique<const Member>(*scene));
  std::map<std::vector<std::uint32_t>, std::uint32_t> known; // kinds in all members
  for (std::uint32_t slot = 0; slot < slots_of(*scenes.front()); ++slot) {
    std::vector<std::uint32_t> of_members;
    for (const auto &member : members_)
      of_members.push_back(member->surfaces.kind_of(&surface_of_slot(member->sides, slot)));
    const auto found = known.emplace(of_members, static_cast<std::uint32_t>(slot_.size()));
    kind_.push_back(found.first->second);
    if (!found.second)
      continue;
    slot_.push_back(slot);
    std::vector<Sampler> &ways = samplers_.emplace_back();
    for (const auto &member : members_) {
      const Sampler own(surface_of_slot(member->sides, slot));
      if (std::ranges::none_of(ways, [&](const Sampler &way) { return is_alike(way, own); }))
        ways.push_back(own);
    }
    of_members_.push_back(std::move(of_members));
  }
  const std::size_t kinds = slot_.size();
  is_any_.resize(kinds * kinds);
  for (std::size_t a = 0; a < kinds; ++a)
    for (std::size_t b = 0; b < kinds; ++b)
      for (std::size_t m = 0; m < members_.size(); ++m)
        if (surfaces(m).part(of_members_[a][m], of_members_[b][m]) != ChainPart::Nothing)
          is_any_[a * kinds + b] = 1;
}

Direction ChainCover::draw(std::uint32_t slot, Vec3<Body> normal, Vec3<Body> from,
                           const std::array<double, 4> &u) const {
  const std::vector<Sampler> &ways = samplers(slot);
  const std::size_t which =
      std::min(ways.size() - 1, static_cast<std::size_t>(u[3] * static_cast<double>(ways.size())));
  Direction out = ways[which].draw(normal, from, u[0], u[1], u[2]);
  if (ways.size() == 1 || !(out.density > 0))
    return out;
  out.density = 0;
  for (const Sampler &way : ways)
    out.density += (out.is_by_mirror ? way.mirror_share : way.density(normal, from, out.to)) /
                   static_cast<double>(ways.size());
  return out;
}

/// Slots that chains do not tell apart must be alike, and what chains left to paths must stay
/// there.
bool ChainCover::has_kinds_of(const Scene &scene, const ChainSurfaces &surfaces) const {
  const auto kind = [&](std::uint32_t slot) {
    return surfaces.kind_of(&surface_of_slot(scene, slot));
  };
  for (std::uint32_t slot = 0; slot < kind_.size(); ++slot)
    if (kind(slot) != kind(slot_[kind_[slot]]))
      return false;
  for (std::uint32_t a = 0; a < slot_.size(); ++a)
    for (std::uint32_t b = 0; b < slot_.size(); ++b)
      if (!is_any(a, b) && surfaces.part(kind(slot_[a]), kind(slot_[b])) != ChainPart::Nothing)
        return false;
  return true;
}

bool ChainCover::serves(const Scene &scene, const ChainSurfaces &surfaces) const {
  if (slots_of(scene) != kind_.size() || !has_kinds_of(scene, surfaces))
    return false;
  return std::ranges::any_of(members_, [&](const auto &member) {
    return std::ranges::all_of(slot_, [&](std::uint32_t slot) {
      return is_within(surface_of_slot(scene, slot), surface_of_slot(member->sides, slot),
                       scene.grid.nodes().size(), member->sides.grid.nodes().size());
    });
  });
}

} // namespace umov
