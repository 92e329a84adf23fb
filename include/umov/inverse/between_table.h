#pragma once
// Light between surfaces for a search: over directions that are lit when they are first asked for.

#include <cstdint>
#include <functional>
#include <memory>
#include <shared_mutex>
#include <span>
#include <umov/inverse/curve_model.h>
#include <vector>

namespace umov {

/// I, Q and U of light that touched more than one surface, over pairs of directions (Sun, observer)
/// on the grid of an octahedron, linear between its nodes, Q and U in axes that stand in the body.
/// Such light comes from wide lobes and many places, and bends little from node to node; direct
/// light, which does not, is none of it. All ordered pairs: with Sun and observer swapped sunlight
/// has another Q and U (what polarized light would give in I; Sekera 1966), and parts that turn
/// after the Sun make another body. What a node holds does not depend on what was asked before or
/// with it. Thread safe.
class BetweenTable {
public:
  /// Who lights nodes that nobody has asked for before.
  struct Lighting {
    /// One pose a call, from several threads: `indirect` of its table is taken, none is 0.
    PoseLighting whole;
    std::function<void(std::size_t done, std::size_t total)> progress = {};
    unsigned threads = 0;
  };
  /// (cells + 1)^2 directions, 180/cells deg apart, under a Sun of this radius.
  BetweenTable(std::size_t cells, double sun_radius_rad);
  /// Adds what lies between the nodes about each pose to the first bands of `direct` (the rest
  /// are parts of it; curve_model.h), and to half-widths of I, if it has any, what that may miss.
  /// False, and nothing added, if it was stopped.
  [[nodiscard]] bool add_to(StokesTable &direct, std::span<const Pose> poses,
                            const Lighting &lighting);
  /// `direct` with the table's light. `table` is kept alive by it.
  static PoseLighting beside(PoseLighting direct, Lighting lighting,
                             std::shared_ptr<BetweenTable> table);
  /// Nodes that were lit so far.
  [[nodiscard]] std::size_t lit() const;

private:
  [[nodiscard]] Pose node(std::size_t number) const;
  [[nodiscard]] std::vector<std::size_t> missing(std::span<const Pose> poses) const;
  [[nodiscard]] bool light_missing(std::span<const Pose> poses, const Lighting &lighting);
  void add_one(StokesTable &direct, std::size_t k, const Pose &pose) const;

  std::size_t cells_, bands_ = 0;
  double sun_radius_rad_;
  mutable std::shared_mutex mutex_;
  std::vector<std::uint32_t> row_; ///< [sun * nodes + observer]
  std::vector<float> light_; ///< [(row * bands + band) * 3 + (I, Q, U)], of the scattering plane
  std::size_t rows_ = 0;
};

} // namespace umov
