#pragma once
// Private: compiled surfaces as constants and polynomials of the facet kernels.

#include "backend/scene_data.h"

#include <optional>
#include <span>
#include <umov/core/result.h>
#include <umov/surface/surface.h>

namespace umov {

/// What the facet loops sum for one or several surfaces.
struct SurfaceFit {
  std::vector<kernel::LobeConstants<double>> lobes; ///< that differ; none for no lobe
  std::vector<double> widths;                       ///< per lobe: of the slope
  std::optional<backend::LobeFamily<double>> family;
  std::vector<backend::Profile<double>> profiles;
  std::vector<backend::Product> products;
  /// Profiles for one sort of diffuse light, and their products, which stand in the order (0,0)
  /// (0,1) ... (1,1) ... without those that are negligible. Polarized light has profiles of its own
  /// towards the observer, and after the others each product with them twice, for Q and for U.
  struct Term {
    std::uint32_t first = 0, count = 0, product_first = 0, product_count = 0;
    std::uint32_t polarizing_first = 0, polarizing_count = 0;
  };
  std::vector<Term> terms;
};

/// Profiles and lobes that serve all of them; empty if some part of the light of one has no form
/// that the kernels know.
std::optional<SurfaceFit> fit_surfaces(std::span<const Surface *const> surfaces);

/// Light of one product of profiles: coefficients times the sum over the facets, for light without
/// polarization, for light with the Q/I of one reflection, and for Q and U of emitted light.
struct ProductLight {
  double unpolarized = 0, single_bounce = 0, q = 0, u = 0;
};
/// A surface in terms of sums.
struct SurfaceLight {
  std::vector<std::uint32_t> lobe;                 ///< per band
  std::vector<std::vector<ProductLight>> products; ///< [band][product]
  double diffuse_error = 0;                        ///< of the polynomials, relative
};

/// BadInput if the sums are not of its roughness or not of its kind of diffuse light. The profiles
/// of a surface that the fit was not made for may be off by `diffuse_error`.
Result<SurfaceLight> light_in(const SurfaceFit &fit, const Surface &surface);

} // namespace umov
