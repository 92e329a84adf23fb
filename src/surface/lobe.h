#pragma once
// Private: the microfacet lobe, D G2/4, without Fresnel.

#include <memory>
#include <umov/surface/distribution.h>
#include <umov/surface/material.h>

namespace umov {

class MicrofacetLobe {
public:
  MicrofacetLobe(std::shared_ptr<const Distribution> normals, Shadowing shadowing)
      : normals_(std::move(normals)), shadowing_(shadowing) {}

  /// w (n.l)(n.v) = D G2/4 [1/sr] for a Sun of that radius (0: a point); 0 at or below the horizon.
  [[nodiscard]] double operator()(Vec3<Facet> l, Vec3<Facet> v, double l_v,
                                  double disk_radius_rad) const;
  /// The same for an isotropic distribution and a point source from cosines alone. n_h follows from
  /// the others, but not to the 1/m that D needs near grazing.
  [[nodiscard]] double isotropic(double n_l, double n_v, double l_v, double n_h) const;
  [[nodiscard]] const Distribution &normals() const { return *normals_; }
  [[nodiscard]] Shadowing shadowing() const { return shadowing_; }

private:
  std::shared_ptr<const Distribution> normals_;
  Shadowing shadowing_;
};

} // namespace umov
