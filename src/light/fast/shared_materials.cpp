#include "light/fast/shared_materials.h"

#include <algorithm>

namespace umov {

std::vector<const Surface *> surfaces_of(const Scene &scene, const std::vector<Scene> &hypotheses,
                                         std::uint32_t slot) {
  std::vector<const Surface *> out{&surface_of_slot(scene, slot)};
  for (const Scene &other : hypotheses)
    out.push_back(&surface_of_slot(other, slot));
  return out;
}

SharedSlots share_materials(const Scene &scene, const std::vector<Scene> &hypotheses,
                            Elements &elements) {
  const auto count = static_cast<std::uint32_t>(2 * scene.mesh.groups.size());
  std::vector<char> is_used(count, 0);
  for (const SideSlots &sides : elements.slots)
    for (const std::uint32_t slot : {sides.front, sides.back})
      if (slot != no_index)
        is_used[slot] = 1;
  const auto is_alike = [&](std::uint32_t a, std::uint32_t b) {
    const auto x = surfaces_of(scene, hypotheses, a), y = surfaces_of(scene, hypotheses, b);
    return std::equal(x.begin(), x.end(), y.begin(),
                      [](const Surface *s, const Surface *t) { return s->is_same(*t); });
  };
  SharedSlots out(count);
  std::vector<std::uint32_t> first(count, no_index);
  for (std::uint32_t slot = 0; slot < count; ++slot) {
    if (is_used[slot] == 0)
      continue;
    std::uint32_t other = 0;
    while (other < slot && (out[other].empty() || !is_alike(other, slot)))
      ++other;
    first[slot] = other;
    out[other].push_back(slot);
  }
  for (SideSlots &sides : elements.slots)
    for (std::uint32_t *slot : {&sides.front, &sides.back})
      if (*slot != no_index)
        *slot = first[*slot];
  return out;
}

} // namespace umov
