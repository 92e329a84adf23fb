// Glints of flat parts: which classes can have them, and how much of a pose's light they are.

#include "light/fast/state.h"

#include <algorithm>
#include <cmath>
#include <umov/light/glints.h>

namespace umov {

namespace {

/// Per group of classes: what its chunk has as its slot.
std::vector<std::uint32_t> slot_of_groups(const SceneStore<double> &scene) {
  std::vector<std::uint32_t> out(scene.groups.size());
  for (const backend::Chunk &chunk : scene.chunks)
    std::fill_n(out.begin() + chunk.first, chunk.count, chunk.slot);
  return out;
}

} // namespace

std::vector<Engine::State::Flat> Engine::State::find_flats() const {
  std::vector<Engine::State::Flat> out;
  const std::vector<std::uint32_t> slot = slot_of_groups(compiled.data);
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g)
    for (std::uint32_t lane = 0; lane < backend::lanes; ++lane) {
      const std::uint32_t member = plan.groups[g].member[lane];
      if (member == no_index)
        continue;
      const FacetClass &c = classes.list[member];
      const Element &e = elements.list[classes.element[c.first]];
      if (!e.is_flat)
        continue;
      const double half_width = surface_of_slot(scene, c.slot).half_width_rad();
      if (!(half_width <= widest_glint_rad))
        continue;
      out.push_back(
          {c.normal, std::cos(half_width + 0.5 * sun_radius_at_1au_rad), g, lane, slot[g]});
    }
  return out;
}

/// The flat that a facet is; nullptr if it is none.
const Engine::State::Flat *Engine::State::flat_of(const backend::SeenFacet &facet) const {
  const auto place = [](const auto &of) { return std::pair(of.group, of.lane); };
  const auto found = std::lower_bound(flats.begin(), flats.end(), facet,
                                      [&](const Flat &flat, const backend::SeenFacet &wanted) {
                                        return place(flat) < place(wanted);
                                      });
  return found != flats.end() && place(*found) == place(facet) ? &*found : nullptr;
}

double Engine::State::glint_share(const Pose &pose, const Prepared &at, Workspace &work) const {
  const Vec3<Body> sum = pose.sun + pose.observer;
  if (!(norm(sum) > 1e-12) || !(work.light.i[0] > 0))
    return 0;
  const Vec3<Body> half = normalized(sum);
  work.near_flats.clear();
  for (const Flat &flat : flats) {
    const backend::Chunk group{flat.group, 1, flat.slot};
    if (dot(flat.normal, half) >= flat.cosine &&
        (work.near_flats.empty() || work.near_flats.back().first != group.first))
      work.near_flats.push_back(group);
  }
  if (work.near_flats.empty())
    return 0;
  work.seen.reset(work.near_flats.size() * backend::lanes);
  backend::list_seen(views.whole, work.near_flats, hiding(), mask_error, at.pose, work.seen);
  double light = 0;
  for (const backend::SeenFacet &facet : work.seen)
    if (const Flat *flat = flat_of(facet);
        flat != nullptr && dot(flat->normal, half) >= flat->cosine)
      light += facet.area * work.factors.a[compiled.colours.column(facet.slot)] *
               compiled.colours.surface(facet.slot).specular(0, directions(pose, at, facet));
  return light / work.light.i[0];
}

} // namespace umov
