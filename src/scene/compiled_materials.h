#pragma once
// Private: the materials of a scene, compiled at the wavelengths that its bands need.

#include <umov/optics/band_grid.h>
#include <umov/surface/surface.h>

namespace umov {

/// A band's light may err by this part of I for being summed from few wavelengths.
inline constexpr double band_error_max = 1e-3;

/// Each distinct material once; copies of a Surface share their tables. The wavelengths of a band
/// stand closer where the colours of a material ask for it (docs/theory/bands.md, Eq. 8): a
/// property of the scene, so that no pose's light depends on which others are asked for.
class CompiledMaterials {
public:
  static Result<CompiledMaterials> make(const std::vector<Band> &bands,
                                        const std::vector<Material> &front,
                                        const std::vector<Material> &back);

  [[nodiscard]] const BandGrid &grid() const { return grid_; }
  /// One of those that it was made from.
  [[nodiscard]] const Surface &of(const Material &material) const;

private:
  BandGrid grid_;
  std::vector<Surface> surfaces_;
};

} // namespace umov
