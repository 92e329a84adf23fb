#pragma once
// Light between surfaces for a search: over directions that are lit when they are first asked for.

#include <cstdint>
#include <memory>
#include <shared_mutex>
#include <span>
#include <umov/inverse/curve_model.h>
#include <vector>

namespace umov {

/// I, Q and U of light that touched more than one surface, over pairs of directions (Sun, observer)
/// on the grid of an octahedron, linear between its nodes. Such light comes from wide lobes and
/// many places, and bends little from node to node; direct light, which does not, is none of it.
/// What a node holds does not depend on what was asked before. Thread safe.
class BetweenTable {
public:
  /// (cells + 1)^2 directions, 180/cells deg apart. `is_reciprocal`: Sun and observer swapped give
  /// the same I and Q and -U, so that half of the pairs are lit (not of parts that turn after the
  /// Sun).
  BetweenTable(std::size_t cells, double sun_radius_rad, bool is_reciprocal);
  /// Adds what lies between the nodes about each pose to the first bands of `direct` (the rest
  /// are parts of it; curve_model.h), and to its half-widths, if it has any, what that may miss.
  /// `whole` lights nodes that nobody has asked for before: of its table `indirect` is taken,
  /// none is 0. False, and nothing added, if `whole` was stopped.
  [[nodiscard]] bool add_to(StokesTable &direct, std::span<const Pose> poses,
                            const PoseLighting &whole, unsigned threads);
  /// `direct` with the table's light. `table` is kept alive by it.
  static PoseLighting lighting(PoseLighting direct, PoseLighting whole,
                               std::shared_ptr<BetweenTable> table, unsigned threads);
  /// Nodes that were lit so far.
  [[nodiscard]] std::size_t lit() const;

private:
  [[nodiscard]] std::size_t number_of(std::size_t sun, std::size_t observer) const;
  [[nodiscard]] Pose node(std::size_t number) const;
  std::vector<std::size_t> take_missing(std::span<const Pose> poses);
  [[nodiscard]] bool light_missing(std::span<const Pose> poses, const PoseLighting &whole);
  void add_one(StokesTable &direct, std::size_t k, const Pose &pose) const;

  std::size_t cells_, bands_ = 0;
  double sun_radius_rad_;
  bool is_reciprocal_;
  mutable std::shared_mutex mutex_;
  std::vector<std::uint32_t> row_; ///< of each pair of nodes
  std::vector<float> light_;       ///< [(row * bands + band) * 3 + (I, Q, U)]
  std::size_t rows_ = 0;
};

} // namespace umov
