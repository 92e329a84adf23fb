#include "light/model/ray_tracer.h"

#include "light/reference/elements.h"
#include "light/unless_stopped.h"

#include <algorithm>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>
#include <umov/light/point_budget.h>

namespace umov {

IntegrationOptions integration_of(const LightOptions &options, std::vector<double> floor_i) {
  IntegrationOptions out;
  out.accuracy = options.accuracy;
  out.seed = options.seed;
  out.source = options.source;
  out.bounces = options.bounces;
  out.between = options.between;
  out.poses_in_all = options.poses_in_all;
  out.floor_i = std::move(floor_i);
  if (options.max_points > 0)
    out.max_points = options.max_points;
  else if (options.bounces > 1)
    out.max_points = most_points::of_paths;
  return out;
}

std::vector<std::uint32_t> material_of_slots(const Scene &scene,
                                             const std::vector<std::string> &names) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t slot = 0; slot < 2 * scene.mesh.groups.size(); ++slot) {
    const std::string &name = surface_of_slot(scene, slot).material().name;
    out.push_back(
        static_cast<std::uint32_t>(std::find(names.begin(), names.end(), name) - names.begin()));
  }
  return out;
}

RayTracer::RayTracer(const Scene &scene, const std::vector<Joint> &joints,
                     IntegrationOptions options, const std::vector<std::string> &materials,
                     ChainSharing chains)
    : scene_(scene), joints_(joints), options_(std::move(options)),
      material_of_(material_of_slots(scene, materials)), materials_(materials.size()),
      chains_(without_meshes(std::move(chains), scene)) {
  if (!joints_.empty()) // another body at every pose: nothing to share
    options_.between = BetweenMethod::Paths;
}

const Integrator &RayTracer::integrator(const std::atomic<bool> *cancel) const {
  std::call_once(
      is_made_, [&] { integrator_ = std::make_shared<const Integrator>(scene_, cancel, chains_); });
  return *integrator_;
}

Scene turned(const Scene &scene, const std::vector<Joint> &joints,
             std::span<const double> angles_rad, std::size_t pose) {
  const auto angles = angles_rad.subspan(pose * joints.size(), joints.size());
  Scene out = scene;
  out.mesh = posed(scene.mesh, joints, {angles.begin(), angles.end()});
  return out;
}

void RayTracer::put(const PoseResult &result, std::size_t row, StokesTable &out) const {
  out.is_dark[row] = result.is_dark ? 1 : 0;
  out.method[row] = result.rays > 0 ? PoseMethod::Rays : PoseMethod::Exact;
  for (std::size_t b = 0; b < out.bands; ++b)
    out.put(row, b, result.bands[b]);
  for (std::size_t b = 0; b < result.indirect.size(); ++b)
    out.indirect[row * out.bands + b] = result.indirect[b];
  if (!out.glint_share.empty())
    out.glint_share[row] = result.glint_share;
  if (out.material_i.empty())
    return;
  double *to = out.material_i.data() + row * materials_ * out.bands;
  std::fill_n(to, materials_ * out.bands, 0);
  for (std::size_t slot = 0; slot < material_of_.size(); ++slot)
    for (std::size_t b = 0; b < out.bands; ++b)
      to[material_of_[slot] * out.bands + b] += result.slot_i[slot * out.bands + b];
}

bool RayTracer::light(std::span<const Pose> poses, std::span<const double> angles_rad,
                      std::span<const std::size_t> which, StokesTable &out,
                      const LightTask &task) const {
  return unless_stopped(task.cancel, [&] {
    std::vector<Pose> chosen;
    for (const std::size_t k : which)
      chosen.push_back(poses[k]);
    std::vector<PoseResult> found;
    if (joints_.empty()) {
      found = integrator(task.cancel).evaluate(chosen, options_, task.threads, task.cancel);
    } else {
      found.resize(which.size());
      parallel_for(which.size(), task.threads, [&](std::size_t k) {
        if (is_stopped(task.cancel))
          return;
        const Integrator own(turned(scene_, joints_, angles_rad, which[k]), task.cancel);
        auto one = own.evaluate(std::vector{chosen[k]}, options_, 1, task.cancel);
        if (!one.empty())
          found[k] = std::move(one.front());
      });
    }
    if (is_stopped(task.cancel) || found.size() < which.size())
      return false;
    if (options_.bounces > 1)
      out.indirect.resize(out.i.size());
    for (std::size_t k = 0; k < which.size(); ++k)
      put(found[k], which[k], out);
    return true;
  });
}

bool RayTracer::add_indirect(std::span<const Pose> poses, std::span<const double> angles_rad,
                             StokesTable &out, const LightTask &task) const {
  return unless_stopped(task.cancel, [&] {
    const std::vector<double> direct = out.i;
    std::vector<IndirectLight> more;
    if (joints_.empty()) {
      more = integrator(task.cancel).indirect(poses, direct, options_, task.threads, task.cancel);
    } else {
      more.resize(poses.size());
      parallel_for(poses.size(), task.threads, [&](std::size_t k) {
        if (is_stopped(task.cancel))
          return;
        auto one =
            Integrator(turned(scene_, joints_, angles_rad, k), task.cancel)
                .indirect(poses.subspan(k, 1), std::span(direct).subspan(k * out.bands, out.bands),
                          options_, 1, task.cancel);
        if (!one.empty())
          more[k] = std::move(one.front());
      });
    }
    if (is_stopped(task.cancel) || more.size() < poses.size())
      return false;
    out.indirect.resize(out.i.size());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const double before = out.i[k * out.bands];
      for (std::size_t b = 0; b < out.bands; ++b) {
        BandResult whole = out.at(k, b);
        add(more[k].bands[b], whole);
        out.put(k, b, whole);
        out.indirect[k * out.bands + b] = more[k].bands[b].stokes;
        if (more[k].bands[b].stokes.i > 0)
          out.is_dark[k] = 0;
      }
      if (!out.glint_share.empty() && before > 0)
        out.glint_share[k] *= before / out.i[k * out.bands];
    }
    return true;
  });
}

} // namespace umov
