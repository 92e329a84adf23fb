#include "surface/lobe.h"

#include "kernel/microfacet.inl.h"
#include "surface/solar_disk.h"

#include <cmath>

namespace umov {
namespace {

Vec3<Facet> tilted(double cosine) {
  return {std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))), 0, cosine};
}

} // namespace

double MicrofacetLobe::operator()(Vec3<Facet> l, Vec3<Facet> v, double l_v,
                                  double disk_radius_rad) const {
  if (!(l.z > 0 && v.z > 0))
    return 0;
  const double d = density_over_disk(*normals_, l, v, l_v, disk_radius_rad);
  if (!(d > 0))
    return 0;
  return d *
         kernel::joint_masking(shadowing_, normals_->masking(l), normals_->masking(v),
                               std::min(l.z, 1.0), std::min(v.z, 1.0), l_v) /
         4;
}

double MicrofacetLobe::isotropic(double n_l, double n_v, double l_v, double n_h) const {
  if (!(n_l > 0 && n_v > 0 && n_h > 0))
    return 0;
  const double d = normals_->density(tilted(n_h));
  return d *
         kernel::joint_masking(shadowing_, normals_->masking(tilted(n_l)),
                               normals_->masking(tilted(n_v)), n_l, n_v, l_v) /
         4;
}

} // namespace umov
