#include "light/fast/pose_data.h"

#include "kernel/disk_lobe.h"
#include "light/fast/octahedron.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace umov {
namespace {

void put(Vec3<Body> v, double *out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

} // namespace

void prepare_pose(const Pose &pose, double cos_phase,
                  const std::vector<kernel::LobeConstants<double>> &lobes, bool has_polarized_body,
                  const backend::Masks *masks, PoseStore<double> &out) {
  put(pose.sun, out.facet.sun);
  put(pose.observer, out.facet.observer);
  out.facet.cos_phase = cos_phase;
  const double apart = norm(pose.sun - pose.observer);
  out.facet.along_scale = apart > 1e-7 ? 1 / apart : 0;
  if (has_polarized_body) {
    const Vec3<Body> across = cross(pose.observer, pose.sun);
    const double sine = norm(across);
    out.facet.per_sine = sine > 1e-12 ? 1 / sine : 0;
    put(out.facet.per_sine * across, out.facet.across);
  }
  const kernel::DiskImage disk = kernel::disk_image(pose.sun_radius_rad, cos_phase);
  out.facet.half_shift = apart > 1e-7 ? disk.shift() : 0;
  put(kernel::mean_half_vector(pose.sun, pose.observer, any_perpendicular(pose.sun), apart, disk),
      out.facet.half);
  out.resize(lobes.size());
  for (std::size_t k = 0; k < lobes.size(); ++k)
    kernel::put_lobe_at_pose(lobes[k], disk, out.lobe_room[k]);
  if (masks != nullptr) {
    out.small_sun = look_around(masks->small.cells, pose.sun);
    out.small_observer = look_around(masks->small.cells, pose.observer);
    if (masks->large.cells == masks->small.cells) {
      out.large_sun = out.small_sun;
      out.large_observer = out.small_observer;
    } else {
      out.large_sun = look_around(masks->large.cells, pose.sun);
      out.large_observer = look_around(masks->large.cells, pose.observer);
    }
  }
}

namespace {

float f(double x) { return static_cast<float>(x); }

} // namespace

void round_pose(const backend::PoseData<double> &from, PoseStore<float> &to) {
  for (std::size_t k = 0; k < 3; ++k) {
    to.facet.sun[k] = f(from.facet.sun[k]);
    to.facet.observer[k] = f(from.facet.observer[k]);
    to.facet.half[k] = f(from.facet.half[k]);
    to.facet.across[k] = f(from.facet.across[k]);
  }
  to.facet.cos_phase = f(from.facet.cos_phase);
  to.facet.along_scale = f(from.facet.along_scale);
  to.facet.per_sine = f(from.facet.per_sine);
  to.facet.half_shift = f(from.facet.half_shift);
  to.resize(from.lobes.size());
  for (std::size_t k = 0; k < from.lobes.size(); ++k)
    kernel::round_lobe_at_pose(from.lobes[k], to.lobe_room[k]);
  to.small_sun = from.small_sun;
  to.small_observer = from.small_observer;
  to.large_sun = from.large_sun;
  to.large_observer = from.large_observer;
}

} // namespace umov
