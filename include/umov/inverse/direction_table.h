#pragma once
// Light of an object between directions that were lit beforehand: coarse, and millions of poses per
// second.

#include <memory>
#include <umov/core/result.h>
#include <umov/inverse/curve_model.h>

namespace umov {

/// I and Q over pairs of directions (Sun, observer) on the grid of an octahedron, linear between
/// its nodes. Good for a search, not for a fit: a lobe narrower than a cell is blurred.
class DirectionTable {
public:
  /// Lights all pairs of (cells + 1)^2 directions, half of them by reciprocity (Sun and observer
  /// swapped give the same I and Q), with a Sun of one size. Nothing if it was stopped.
  static std::shared_ptr<const DirectionTable> make(const PoseLighting &light, std::size_t cells,
                                                    double sun_radius_rad, unsigned threads);
  /// The same with every second node: a sixteenth of the bytes, which stays in a processor's cache.
  /// BadInput for an odd number of cells, whose second nodes do not end at the octahedron's edge.
  [[nodiscard]] Result<std::shared_ptr<const DirectionTable>> halved() const;
  /// Looks up; `table` is kept alive by it. U and V are 0.
  static PoseLighting lighting(std::shared_ptr<const DirectionTable> table, unsigned threads);

private:
  std::size_t cells_ = 0, bands_ = 0;
  std::size_t stride_ = 0;   ///< numbers of a pair: I and Q of all bands, and what fills up lanes
  std::vector<float> light_; ///< [(sun * nodes + observer) * stride + band * 2 + (I, Q)]
};

} // namespace umov
