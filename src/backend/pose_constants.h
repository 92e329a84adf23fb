#pragma once
// From a pose to what the loops over facets read of it, in double, for every
// machine.

#include "backend/octahedron.h"
#include "kernel/disk_lobe.h"

#include <umov/core/vec3.h>

namespace umov::backend {

/// A pose as it comes: directions from the object, unit vectors.
struct PoseDirections {
  Vec3<Body> sun, observer;
  double sun_radius_rad = 0;
  double cos_phase = 1;   ///< within [-1, 1]
  bool has_plane = false; ///< of scattering (has_scattering_plane); only where light is asked for
};

UMOV_KERNEL void put_vector(const Vec3<Body> &v, double *out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

/// What the directions make; the image of the Sun's disk, for the lobes.
UMOV_KERNEL kernel::DiskImage put_directions(const PoseDirections &pose, bool has_polarized_body,
                                             kernel::FacetPose<double> &out) {
  put_vector(pose.sun, out.sun);
  put_vector(pose.observer, out.observer);
  out.cos_phase = pose.cos_phase;
  const double apart = norm(pose.sun - pose.observer);
  out.along_scale = apart > 1e-7 ? 1 / apart : 0;
  if (has_polarized_body) {
    const Vec3<Body> across = cross(pose.observer, pose.sun);
    const double sine = norm(across);
    out.per_sine = sine > 1e-12 ? 1 / sine : 0;
    put_vector(out.per_sine * across, out.across);
  }
  const kernel::DiskImage disk = kernel::disk_image(pose.sun_radius_rad, pose.cos_phase);
  out.half_shift = apart > 1e-7 ? disk.shift() : 0;
  put_vector(
      kernel::mean_half_vector(pose.sun, pose.observer, any_perpendicular(pose.sun), apart, disk),
      out.half);
  return disk;
}

/// Where both directions stand in the grids of the masks.
template <class T>
UMOV_KERNEL void put_looks(const PoseDirections &pose, const Masks &masks, PoseData<T> &out) {
  out.small_sun = look_around(masks.small.cells, pose.sun);
  out.small_observer = look_around(masks.small.cells, pose.observer);
  if (masks.large.cells == masks.small.cells) {
    out.large_sun = out.small_sun;
    out.large_observer = out.small_observer;
  } else {
    out.large_sun = look_around(masks.large.cells, pose.sun);
    out.large_observer = look_around(masks.large.cells, pose.observer);
  }
}

/// The directions in single precision.
UMOV_KERNEL void round_directions(const kernel::FacetPose<double> &from,
                                  kernel::FacetPose<float> &to) {
  using kernel::rounded;
  for (std::size_t k = 0; k < 3; ++k) {
    to.sun[k] = rounded(from.sun[k]);
    to.observer[k] = rounded(from.observer[k]);
    to.half[k] = rounded(from.half[k]);
    to.across[k] = rounded(from.across[k]);
  }
  to.cos_phase = rounded(from.cos_phase);
  to.per_sine = rounded(from.per_sine);
  // (n.l - n.v) times this scale: its rounding would be as large as itself. Below 1e-3 rad the
  // image of the Sun's disk is a circle to 1e-7, and where a normal lies around it is all one.
  const bool has_along = from.along_scale < 1e3;
  to.along_scale = has_along ? rounded(from.along_scale) : 0;
  to.half_shift = has_along ? rounded(from.half_shift) : 0;
}

} // namespace umov::backend
