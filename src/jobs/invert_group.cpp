#include "jobs/invert_group.h"

#include "jobs/known_light.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::jobs {

Result<Scenario> GroupLight::with(const std::string &group, const std::string &material) const {
  Scenario out = scenario_;
  if (!out.own_materials.contains(material)) {
    std::vector<std::string> known = material_library();
    for (const auto &own : out.own_materials)
      known.push_back(own.first);
    if (std::ranges::find(known, material) == known.end()) {
      const auto near = nearest_name(material, known);
      return fail(ErrorCode::Usage,
                  fmt::format("{}: there is no such material{}", printable(material),
                              near ? fmt::format(". Did you mean \"{}\"?", *near)
                                   : "; umov material list tells which there are"));
    }
  }
  out.objects.front().materials[group] = {material, material};
  return out;
}

Result<EndMember> GroupLight::of(const std::string &group, const std::string &material,
                                 const Monitor &monitor, Vec3<Body> turn) {
  Scenario scenario = scenario_;
  if (!group.empty()) {
    UMOV_ASSIGN(changed, with(group, material));
    scenario = std::move(changed);
  }
  UMOV_ASSIGN(out,
              known_light(scenario, {observed_.geometry, observed_.column, request_.method, turn},
                          options_, monitor, used_));
  out.name = material;
  return out;
}

} // namespace umov::jobs
