// Glints of flat parts: which classes can have them, and how much of a pose's light they are.

#include "light/fast/state.h"

#include <algorithm>
#include <cmath>

namespace umov {

std::vector<Engine::State::Flat> Engine::State::find_flats() const {
  std::vector<Engine::State::Flat> out;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g)
    for (std::uint32_t lane = 0; lane < backend::lanes; ++lane) {
      const std::uint32_t member = plan.groups[g].member[lane];
      if (member == no_index)
        continue;
      const FacetClass &c = classes.list[member];
      const Element &e = elements.list[classes.element[c.first]];
      if (!e.is_flat)
        continue;
      const double reach =
          surface_of_slot(scene, c.slot).half_width_rad() + 0.5 * sun_radius_at_1au_rad;
      out.push_back({c.normal, std::cos(std::min(reach, pi)), g, lane});
    }
  return out;
}

double Engine::State::glint_share(const Pose &pose, const Prepared &at, Workspace &work) const {
  const Vec3<Body> sum = pose.sun + pose.observer;
  if (!(norm(sum) > 1e-12) || !(work.light.i[0] > 0))
    return 0;
  const Vec3<Body> half = normalized(sum);
  const auto is_near = [&](const Flat &flat) { return dot(flat.normal, half) >= flat.cosine; };
  if (std::none_of(flats.begin(), flats.end(), is_near))
    return 0;
  work.seen.reset(views.whole.groups.size() * backend::lanes);
  backend::list_seen(views.whole, hiding(), mask_error, at.pose, work.seen);
  double light = 0;
  for (const Flat &flat : flats)
    if (is_near(flat))
      for (const backend::SeenFacet &facet : work.seen)
        if (facet.group == flat.group && facet.lane == flat.lane) {
          const Surface &surface = compiled.colours.surface(facet.slot);
          light += facet.area * work.factors.a[compiled.colours.column(facet.slot)] *
                   surface.specular(0, directions(pose, at, facet));
        }
  return light / work.light.i[0];
}

} // namespace umov
