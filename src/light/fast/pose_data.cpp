#include "light/fast/pose_data.h"

#include "kernel/microfacet.inl.h"
#include "kernel/solar_nodes.inl.h"
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

/// Half vector of a direction of light; some vector where there is none (phase 180), when no facet
/// is lit for the observer.
void put_half_vector(Vec3<Body> l, Vec3<Body> v, double *out) {
  const Vec3<Body> sum = l + v;
  const double length = norm(sum);
  put(length > 1e-12 ? (1 / length) * sum : any_perpendicular(l), out);
}

/// Half vectors of the ring of the disk's nodes.
void put_ring(const Pose &pose, kernel::FacetPose<double> &out) {
  const Vec3<Body> across = cross(pose.observer, pose.sun);
  const double length = norm(across);
  const Vec3<Body> e2 = length > 1e-12 ? across / length : any_perpendicular(pose.sun);
  const Vec3<Body> e1 = cross(e2, pose.sun);
  const double sine = std::sin(pose.sun_radius_rad);
  constexpr double half_root_3 = std::numbers::sqrt3 / 2;
  constexpr double ring[][2] = {{1, 0},  {0.5, half_root_3},   {-0.5, half_root_3},
                                {-1, 0}, {-0.5, -half_root_3}, {0.5, -half_root_3}};
  for (std::size_t k = 1; k < kernel::source_nodes; ++k)
    put_half_vector(kernel::disk_direction(pose.sun, e1, e2, sine, kernel::source_ring,
                                           ring[k - 1][0], ring[k - 1][1]),
                    pose.observer, out.half[k]);
}

} // namespace

void prepare_pose(const Pose &pose, double cos_phase,
                  const std::vector<kernel::LobeConstants<double>> &lobes,
                  const std::vector<double> &widths, const backend::Masks *masks,
                  PoseStore<double> &out) {
  put(pose.sun, out.facet.sun);
  put(pose.observer, out.facet.observer);
  out.facet.cos_phase = cos_phase;
  const double apart = norm(pose.sun - pose.observer);
  out.facet.along_scale = apart > 1e-7 ? 1 / apart : 0;
  put_half_vector(pose.sun, pose.observer, out.facet.half[0]);
  bool needs_ring = false;
  const auto kappa = kernel::disk_variances(pose.sun_radius_rad, cos_phase);
  out.resize(lobes.size());
  for (std::size_t k = 0; k < lobes.size(); ++k) {
    kernel::LobeAtPose<double> &at = out.lobe_room[k];
    at = {};
    const double q = widths[k] > 0 ? kappa.across / (widths[k] * widths[k]) : HUGE_VAL;
    out.narrow_room[k] =
        pose.sun_radius_rad > 0 ? (q < kernel::nodes_max ? 0 : 1) : (widths[k] > 0 ? 0 : 1);
    if (lobes[k].kind == LobeKind::BlinnPhong && q < kernel::closed_form_max) {
      const auto by = kernel::blinn_phong_spread(lobes[k].shape, kappa.along, kappa.across);
      at = {true, false, lobes[k].peak * by.scale, by.along * std::numbers::log2e,
            by.across * std::numbers::log2e};
    } else {
      at.uses_nodes = pose.sun_radius_rad > 0;
      needs_ring = needs_ring || at.uses_nodes;
    }
  }
  if (needs_ring)
    put_ring(pose, out.facet);
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

void round_pose(const backend::PoseData<double> &from, PoseStore<float> &to) {
  const auto f = [](double x) { return static_cast<float>(x); };
  for (std::size_t k = 0; k < 3; ++k) {
    to.facet.sun[k] = f(from.facet.sun[k]);
    to.facet.observer[k] = f(from.facet.observer[k]);
    for (std::size_t n = 0; n < kernel::source_nodes; ++n)
      to.facet.half[n][k] = f(from.facet.half[n][k]);
  }
  to.facet.cos_phase = f(from.facet.cos_phase);
  to.facet.along_scale = f(from.facet.along_scale);
  to.resize(from.lobes.size());
  for (std::size_t k = 0; k < from.lobes.size(); ++k) {
    const auto &l = from.lobes[k];
    to.lobe_room[k] = {l.has_closed_form, l.uses_nodes, f(l.peak), f(l.along), f(l.across)};
  }
  std::copy(from.is_narrow.begin(), from.is_narrow.end(), to.narrow_room.begin());
  to.small_sun = from.small_sun;
  to.small_observer = from.small_observer;
  to.large_sun = from.large_sun;
  to.large_observer = from.large_observer;
}

} // namespace umov
