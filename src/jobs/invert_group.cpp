#include "jobs/invert_group.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/inverse/attitude_grid.h>
#include <umov/observation/track.h>

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
  Diagnostics known; // those of the same files, told before
  UMOV_ASSIGN(object, load_object(scenario, 0, {.allow_old_elements = true}, known));
  const auto &moving = scenario.objects.front().parts;
  UMOV_ASSIGN(
      track, Track::make({*object.orbit, scenario.observer.value_or(Site()), ShadowModel::Ellipsoid,
                          object.attitude, moving, scenario.has_solar_disk}));
  LightOptions lit = light_options(scenario, options_);
  lit.method = request_.method;
  UMOV_ASSIGN(light, make_light(object.scene, joints_of(moving), lit));
  std::vector<Pose> poses;
  std::vector<double> angles;
  for (const ObservingGeometry &geometry : observed_.geometry) {
    UMOV_ASSIGN(point, track.place(geometry));
    const auto turned_back = rotation_from<Body, Body>(turned({}, turn)); // directions in the body
    poses.push_back({normalized(turned_back * point.pose.sun),
                     normalized(turned_back * point.pose.observer), point.pose.sun_radius_rad});
    angles.insert(angles.end(), point.joint_angles_rad.begin(), point.joint_angles_rad.end());
  }
  StokesTable table;
  LightTask task;
  task.threads = options_.threads;
  task.cancel = monitor.cancel;
  if (!light->evaluate(poses, angles, table, task))
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  (void)light->keep_masks(); // a cache that cannot be written costs time alone
  if (const LightFacts &facts = light->facts(); !used_.device.starts_with("cpu"))
    used_ = {scenario.objects.front().name, name_of(facts.method), facts.visibility,
             light->instruction_set(), light->device()};
  EndMember out{material, {}, {}, {}};
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (const std::size_t column : observed_.column) {
      out.i.push_back(table.i[k * table.bands + column]);
      out.q.push_back(table.q[k * table.bands + column]);
      out.u.push_back(table.u[k * table.bands + column]);
    }
  return out;
}

} // namespace umov::jobs
