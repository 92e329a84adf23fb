#include "jobs/invert_group.h"

#include "jobs/known_light.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/shape/topology.h>

namespace umov::jobs {

Result<Scenario> GroupLight::with(const GroupMaterial &part) const {
  const std::string &material = part.material;
  Scenario out = scenario_;
  if (part.group.empty())
    return out;
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
  out.objects.front().materials[part.group] = {material, material};
  return out;
}

bool GroupLight::has_chains() const {
  return scenario_.light.bounces > 1 && scenario_.light.between == BetweenMethod::Chains &&
         scenario_.objects.front().parts.empty(); // what turns is lit by paths
}

/// The first draws chains for all, and the others take them. Of a convex body there are none.
Result<ChainFamily> GroupLight::family(const GroupMaterial &part, const Monitor &monitor) const {
  ChainFamily out;
  out.elder = first_.model;
  if (!has_chains() || out.elder)
    return out;
  for (const GroupMaterial &other : all_) {
    if (other == part)
      continue;
    UMOV_ASSIGN(scenario, with(other));
    Diagnostics known; // those of the same files, told before
    UMOV_ASSIGN(object, load_object(scenario, 0,
                                    {.allow_old_elements = true, .cancel = monitor.cancel}, known));
    if (out.also.empty()) { // all have one mesh
      const auto ask = [&]() -> Result<bool> {
        return is_proven_convex(object.scene.mesh, monitor.cancel);
      };
      UMOV_ASSIGN(is_convex, without_failures(ask));
      if (is_convex)
        break;
    }
    out.also.push_back(std::move(object.scene));
  }
  return out;
}

Result<EndMember> GroupLight::of(const GroupMaterial &part, const Monitor &monitor,
                                 Vec3<Body> turn) {
  UMOV_ASSIGN(scenario, with(part));
  KnownLightRequest asked{observed_.geometry, observed_.column, request_.method, turn};
  UMOV_ASSIGN(chains, family(part, monitor));
  asked.chains = std::move(chains);
  const bool is_first = has_chains() && (!first_.model || first_.part == part);
  if (is_first)
    asked.model = &first_.model;
  UMOV_ASSIGN(out, known_light(scenario, asked, options_, monitor, used_));
  if (is_first)
    first_.part = part;
  out.name = part.material;
  return out;
}

} // namespace umov::jobs
