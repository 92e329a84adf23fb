#pragma once
// Private: what the microfacet lobe reflects in all.

#include "surface/lobe.h"

#include <functional>
#include <vector>

namespace umov {

/// Reflectance of a microfacet for unpolarized light at an incidence with that cosine; empty for
/// F = 1 (white furnace).
using FacetReflectance = std::function<double(double)>;

/// Fraction of the light from a direction with cosine n_k that one reflection sends out, for an
/// isotropic distribution. n_k in [0, 1]; the limit is taken at 0.
double directional_albedo(double n_k, const MicrofacetLobe &lobe, const FacetReflectance &facet);
/// The same for any distribution and the direction k.
double directional_albedo(Vec3<Facet> k, const MicrofacetLobe &lobe, const FacetReflectance &facet);

/// Directional albedos of an isotropic lobe against sqrt(n.k), and their mean 2 int R mu dmu.
class AlbedoTable {
public:
  AlbedoTable() = default;
  /// `more`: what else the surface sends out, against n.k, added to the lobe's.
  AlbedoTable(const MicrofacetLobe &lobe, const FacetReflectance &facet,
              const FacetReflectance &more = {});
  [[nodiscard]] double operator()(double n_k) const;
  [[nodiscard]] double mean() const { return mean_; }

private:
  std::vector<double> values_;
  double mean_ = 0;
};

} // namespace umov
