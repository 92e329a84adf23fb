#include "jobs/known_light.h"

#include <umov/inverse/attitude_grid.h>
#include <umov/observation/track.h>

namespace umov::jobs {

Result<EndMember> known_light(const Scenario &scenario, const KnownLightRequest &request,
                              const JobOptions &options, const Monitor &monitor,
                              ManifestInput::Light &used) {
  Diagnostics known; // those of the same files, told before
  UMOV_ASSIGN(object, load_object(scenario, 0,
                                  {.allow_old_elements = true, .cancel = monitor.cancel}, known));
  const auto &moving = scenario.objects.front().parts;
  UMOV_ASSIGN(
      track, Track::make({*object.orbit, scenario.observer.value_or(Site()), ShadowModel::Ellipsoid,
                          object.attitude, moving, scenario.has_solar_disk}));
  LightOptions lit = light_options(scenario, options);
  lit.method = request.method.value_or(lit.method);
  std::shared_ptr<const LightModel> light = request.model != nullptr ? *request.model : nullptr;
  if (!light) {
    UMOV_ASSIGN(made,
                make_light(object.scene, joints_of(moving), lit, monitor.cancel, request.chains));
    light = std::move(made);
    if (request.model != nullptr)
      *request.model = light;
  }
  const auto turned_back = rotation_from<Body, Body>(turned({}, request.turn)); // of directions
  std::vector<Pose> poses;
  std::vector<double> angles;
  for (const ObservingGeometry &geometry : request.geometry) {
    UMOV_ASSIGN(point, track.place(geometry));
    poses.push_back({normalized(turned_back * point.pose.sun),
                     normalized(turned_back * point.pose.observer), point.pose.sun_radius_rad});
    angles.insert(angles.end(), point.joint_angles_rad.begin(), point.joint_angles_rad.end());
  }
  StokesTable table;
  LightTask task;
  task.threads = options.threads;
  task.cancel = monitor.cancel;
  if (!light->evaluate(poses, angles, table, task))
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  (void)light->keep_masks(); // a cache that cannot be written costs time alone
  if (const LightFacts &facts = light->facts(); !used.device.starts_with("cpu"))
    used = {scenario.objects.front().name, name_of(facts.method), facts.visibility,
            light->instruction_set(), light->device()};
  EndMember out;
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (const std::size_t column : request.column) {
      out.i.push_back(table.i[k * table.bands + column]);
      out.q.push_back(table.q[k * table.bands + column]);
      out.u.push_back(table.u[k * table.bands + column]);
    }
  return out;
}

} // namespace umov::jobs
