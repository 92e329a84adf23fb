#include "light/between/chain_cover.h"

#include "light/reference/elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <umov/core/stop.h>

namespace umov {
namespace {

std::uint32_t slots_of(const Scene &scene) {
  return static_cast<std::uint32_t>(scene.front.size() + scene.back.size());
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

constexpr std::array probe_cosines{0.95, 0.6, 0.2};

std::vector<Probe> probes() {
  std::vector<Probe> out;
  for (const double cosine : probe_cosines) {
    Probe &probe = out.emplace_back(Probe{{std::sqrt(1 - cosine * cosine), 0, cosine}});
    for (const double tilt : {0.0, 0.03, 0.06, 0.12, 0.25, 0.5, 0.8})
      for (const Vec3<Body> about : {Vec3<Body>{std::sin(tilt), 0, std::cos(tilt)},
                                     Vec3<Body>{0, std::sin(tilt), std::cos(tilt)}})
        if (const Vec3<Body> to = mirrored(probe.from, about); to.z > 0.02)
          probe.to.push_back(to);
  }
  return out;
}

double mean_brdf(const Surface &surface, std::size_t bands, const SurfaceDirections &on) {
  double mean = 0;
  for (std::size_t b = 0; b < bands; ++b)
    mean += surface.brdf(b, on).m[0][0] / static_cast<double>(bands);
  return mean;
}

/// As much of the light as goes like from a mirror.
double mirrored_part(const Surface &surface, std::size_t band, double cosine) {
  return surface.mirror_part(band, cosine) * surface.reflection(band, cosine).a;
}

std::size_t bands_of(const Scene &scene) { return scene.grid.nodes().size(); }

/// Calls `f` with the directions of each probe.
template <class F> void for_each_probe(const F &f) {
  const Vec3<Body> normal{0, 0, 1}, field{1, 0, 0};
  for (const auto &[from, all_to] : probes())
    for (const Vec3<Body> &to : all_to)
      f(directions_on(normal, field, from, to, dot(from, to), 0));
}

/// What tells materials apart, and orders them, whatever they are called: all of their matrices,
/// since some differ in nothing but polarization.
std::vector<double> looks_of(const Scene &sides, const std::atomic<bool> *cancel) {
  std::vector<double> out;
  for (std::uint32_t slot = 0; slot < slots_of(sides); ++slot) {
    leave_if_stopped(cancel);
    const Surface &surface = surface_of_slot(sides, slot);
    for (std::size_t b = 0; b < bands_of(sides); ++b) {
      for (const double cosine : probe_cosines) {
        const double part = surface.mirror_part(b, cosine);
        const MuellerEntries mirrored = surface.reflection(b, cosine);
        for (const double entry : {mirrored.a, mirrored.b, mirrored.z.real(), mirrored.z.imag()})
          out.push_back(part * entry);
      }
      for_each_probe([&](const SurfaceDirections &on) {
        for (const auto &row : surface.brdf(b, on).m)
          out.insert(out.end(), std::begin(row), std::end(row));
      });
    }
    const Vec3<Body> direction = surface.material().direction.value_or(Vec3<Body>{});
    out.insert(out.end(), {direction.x, direction.y, direction.z});
  }
  return out;
}

/// By their looks: sums over members and draws among them are the same to the last bit for whoever
/// draws first.
void put_in_order(std::vector<ChainMember> &members, const std::atomic<bool> *cancel) {
  if (members.size() < 2)
    return;
  std::vector<std::pair<std::vector<double>, ChainMember>> keyed;
  for (ChainMember &member : members) {
    std::vector<double> looks = looks_of(*member.sides, cancel);
    keyed.emplace_back(std::move(looks), std::move(member));
  }
  std::ranges::stable_sort(
      keyed, {}, [](const auto &one) -> const auto & { return one.first; });
  for (std::size_t m = 0; m < members.size(); ++m)
    members[m] = std::move(keyed[m].second);
}

bool has_same_nodes(const Scene &a, const Scene &b) {
  return std::ranges::equal(a.grid.nodes(), b.grid.nodes(), [](const Band &x, const Band &y) {
    return x.wavelength.nm() == y.wavelength.nm();
  });
}

/// Compiled of the same. A measured table is known by its file, which each reads anew.
bool is_of_same(const Surface &a, const Surface &b) {
  if (a.is_same(b))
    return true;
  Material x = a.material();
  const Material &y = b.material();
  if (x.measured && y.measured && !x.measured_file.empty() && x.measured_file == y.measured_file)
    x.measured = y.measured;
  return x == y;
}

bool is_black(const Surface &surface, std::size_t bands) {
  for (std::size_t b = 0; b < bands; ++b)
    for (const Probe &probe : probes())
      if (surface.albedo(b, {probe.from.x, probe.from.y, probe.from.z}) > 0)
        return false;
  return true;
}

} // namespace

ChainCover::ChainCover(std::vector<ChainMember> members, const std::atomic<bool> *cancel)
    : members_(std::move(members)) {
  put_in_order(members_, cancel);
  std::map<std::vector<std::uint32_t>, std::uint32_t> known; // kinds in all members
  for (std::uint32_t slot = 0; slot < slots_of(sides(0)); ++slot) {
    std::vector<std::uint32_t> of_members;
    for (const ChainMember &member : members_)
      of_members.push_back(member.surfaces->kind_of(&surface_of_slot(*member.sides, slot)));
    const auto found = known.emplace(of_members, static_cast<std::uint32_t>(slot_.size()));
    kind_.push_back(found.first->second);
    if (!found.second)
      continue;
    slot_.push_back(slot);
    std::vector<Sampler> &ways = samplers_.emplace_back();
    for (const ChainMember &member : members_) {
      const Sampler own(surface_of_slot(*member.sides, slot));
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

std::optional<std::size_t> ChainCover::member_like(const Scene &scene) const {
  for (std::size_t m = 0; m < members_.size(); ++m) {
    bool is_like = slots_of(scene) == kind_.size() && has_same_nodes(scene, sides(m));
    for (std::uint32_t slot = 0; is_like && slot < kind_.size(); ++slot)
      is_like = is_of_same(surface_of_slot(scene, slot), surface_of_slot(sides(m), slot));
    if (is_like)
      return m;
  }
  return {};
}

bool ChainCover::has_kinds_of(const Scene &scene, const ChainSurfaces &other) const {
  if (slots_of(scene) != kind_.size())
    return false;
  const auto kind = [&](std::uint32_t slot) {
    return other.kind_of(&surface_of_slot(scene, slot));
  };
  for (std::uint32_t slot = 0; slot < kind_.size(); ++slot)
    if (kind(slot) != kind(slot_[kind_[slot]]))
      return false;
  for (std::uint32_t a = 0; a < slot_.size(); ++a)
    for (std::uint32_t b = 0; b < slot_.size(); ++b)
      if (!is_any(a, b) && other.part(kind(slot_[a]), kind(slot_[b])) != ChainPart::Nothing)
        return false;
  return std::ranges::all_of(slot_, [&](std::uint32_t slot) {
    const Surface &surface = surface_of_slot(scene, slot);
    bool has_mirror = false, has_light = false;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const Surface &known = surface_of_slot(sides(m), slot);
      has_mirror = has_mirror || known.has_mirror();
      has_light = has_light || !is_black(known, bands_of(sides(m)));
    }
    return (has_mirror || !surface.has_mirror()) &&
           (has_light || is_black(surface, bands_of(scene)));
  });
}

bool ChainCover::is_within(const Scene &scene, std::uint32_t slot, double most) const {
  const Surface &surface = surface_of_slot(scene, slot);
  return std::ranges::any_of(members_, [&](const ChainMember &member) {
    const Surface &known = surface_of_slot(*member.sides, slot);
    if (is_of_same(surface, known) && has_same_nodes(scene, *member.sides))
      return true;
    const std::size_t of_known = bands_of(*member.sides);
    bool holds = true;
    for (std::size_t b = 0; b < bands_of(scene) && holds; ++b) {
      for (const double cosine : probe_cosines) {
        double mean = 0;
        for (std::size_t k = 0; k < of_known; ++k)
          mean += mirrored_part(known, k, cosine) / static_cast<double>(of_known);
        holds = holds && mirrored_part(surface, b, cosine) <= most * mean;
      }
      for_each_probe([&](const SurfaceDirections &on) {
        holds = holds && surface.brdf(b, on).m[0][0] <= most * mean_brdf(known, of_known, on);
      });
    }
    return holds;
  });
}

} // namespace umov
