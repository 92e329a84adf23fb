#include "scene/compiled_materials.h"

#include <algorithm>
#include <cmath>
#include <umov/core/expects.h>

namespace umov {
namespace {

std::vector<Material> distinct(const std::vector<Material> &front,
                               const std::vector<Material> &back) {
  std::vector<Material> out;
  for (const auto *side : {&front, &back})
    for (const Material &material : *side)
      if (std::find(out.begin(), out.end(), material) == out.end())
        out.push_back(material);
  return out;
}

/// What Eq. 7 says of a band, in parts of I.
template <class AtNode>
double relative_change(const std::vector<BandTerm> &terms, const AtNode &at_node) {
  const auto sum = sum_band<Stokes<ScatteringPlane>>(terms, at_node);
  if (!(sum.value.i > 0))
    return 0;
  const double worst =
      std::max({std::abs(sum.change.i), std::abs(sum.change.q), std::abs(sum.change.u)});
  return worst / sum.value.i;
}

/// The worst of the light that a surface can send, term by term: one reflection at any phase, and
/// all other light at a few directions. What an object sends is a sum of those with positive
/// parts, which errs by no more. (The shape of a lobe hardly changes within a band.)
double worst_change(const Surface &surface, const std::vector<BandTerm> &terms) {
  constexpr Stokes<ScatteringPlane> sunlight{1, 0, 0, 0};
  double out = 0;
  for (const double phase_deg : {20., 60., 100., 120., 140., 160., 172.}) {
    const double l_v = std::cos(phase_deg * pi / 180);
    out = std::max(out, relative_change(terms, [&](std::size_t node) {
                     return surface.mueller(node, l_v) * sunlight;
                   }));
  }
  for (const auto &[in_deg, out_deg, azimuth_deg] :
       {std::array{20., 60., 0.}, std::array{60., 10., 180.}, std::array{50., 70., 90.}}) {
    if (!surface.has_diffuse())
      break;
    const SurfaceDirections at =
        directions_from_angles(in_deg * pi / 180, out_deg * pi / 180, azimuth_deg * pi / 180);
    out = std::max(out, relative_change(terms, [&](std::size_t node) {
                     return surface.diffuse(node, at, sunlight);
                   }));
  }
  return out;
}

} // namespace

Result<CompiledMaterials> CompiledMaterials::make(const std::vector<Band> &bands,
                                                  const std::vector<Material> &front,
                                                  const std::vector<Material> &back) {
  const std::vector<Material> materials = distinct(front, back);
  std::vector<double> steps(bands.size(), node_step_nm);
  for (;;) {
    CompiledMaterials out;
    UMOV_ASSIGN(grid, BandGrid::make(bands, steps));
    out.grid_ = std::move(grid);
    for (const Material &material : materials) {
      UMOV_ASSIGN(surface, Surface::compile(material, out.grid_.nodes()));
      out.surfaces_.push_back(std::move(surface));
    }
    bool is_settled = true;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      if (!bands[b].curve || steps[b] <= node_step_min_nm)
        continue;
      double worst = 0;
      for (const Surface &surface : out.surfaces_)
        worst = std::max(worst, worst_change(surface, out.grid_.terms()[b]));
      if (worst > band_error_max) {
        steps[b] /= 2;
        is_settled = false;
      }
    }
    if (is_settled)
      return out;
  }
}

const Surface &CompiledMaterials::of(const Material &material) const {
  const auto found = std::find_if(surfaces_.begin(), surfaces_.end(), [&](const Surface &surface) {
    return surface.material() == material;
  });
  UMOV_EXPECTS(found != surfaces_.end());
  return *found;
}

} // namespace umov
