#pragma once
// Private: a compiled surface as constants and polynomials of the facet kernels.

#include "backend/scene_data.h"

#include <optional>
#include <umov/surface/surface.h>

namespace umov {

/// Light of one product of profiles in one band: coefficient times the sum over the facets.
struct ProductLight {
  double coefficient = 0;
  bool is_single_bounce = false; ///< has the Q/I of one reflection; else unpolarized
};

/// One surface as the facet loops see it.
struct SurfaceFit {
  std::vector<kernel::LobeConstants<double>> lobes; ///< one, or one per band; none for no lobe
  std::vector<double> widths;                       ///< per lobe: slope, against the Sun's size
  std::vector<backend::Profile<double>> profiles;
  std::vector<backend::Product> products;
  std::vector<std::vector<ProductLight>> light; ///< [band][product]
  double diffuse_error = 0; ///< of the polynomials, relative to the diffuse light of a facet
};

/// Empty if some part of the surface's light has no form that the kernels know.
std::optional<SurfaceFit> fit_surface(const Surface &surface);

} // namespace umov
