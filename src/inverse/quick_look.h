#pragma once
// Private: the cheap look at every object of a library.

#include "inverse/light_codes.h"

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <umov/inverse/likelihood.h>
#include <umov/inverse/signature.h>
#include <vector>

namespace umov::inverse {

/// A curve beside the light of signatures at the nodes nearest to the directions of a grid of
/// attitudes. Which nodes those are does not depend on the object: they are found once, and an
/// object costs a few nanoseconds a pose. Thread safe.
class QuickLook {
public:
  /// Of `epochs` epochs at most. The model is taken to be a third off: the nearest node is.
  QuickLook(const ObservedCurve &curve, const CurveErrors &errors, std::size_t grid,
            std::size_t epochs);

  /// chi2 of every attitude of the grid, scale free. Band b of the curve is column[b] of the
  /// signature.
  [[nodiscard]] std::vector<float> look(const Signature &signature,
                                        std::span<const std::size_t> column) const;
  /// ln of the mean likelihood over the grid.
  [[nodiscard]] static double log_evidence(const std::vector<float> &chi2);
  /// Numbers of the `count` best attitudes, best first.
  [[nodiscard]] static std::vector<std::size_t> best(const std::vector<float> &chi2,
                                                     std::size_t count);
  /// An attitude of the grid.
  [[nodiscard]] Quaternion attitude(std::size_t k) const { return grid_[k]; }
  /// Poses that one look takes.
  [[nodiscard]] std::size_t poses() const { return grid_.size() * slots_.size(); }

private:
  /// A measurement, in floats: this is only for ranking.
  struct Row {
    std::uint32_t slot = 0, band = 0;
    float i = 0, weight = 0, q_code = 0, q_weight = 0;
  };
  static constexpr std::size_t attitudes_at_once = 8;
  /// chi2 of so many attitudes; `rows` with the place of their band's codes for its number.
  void look_at(const Signature &signature, const LightCodes &codes, std::span<const Row> rows,
               const std::uint32_t *pairs, float *out) const;
  /// Pairs of nodes: [attitude * slots + slot], and as many zeros as a look takes at once.
  std::shared_ptr<const std::vector<std::uint32_t>> pairs_for(std::size_t cells) const;

  const ObservedCurve &curve_;
  std::vector<Quaternion> grid_;
  std::vector<std::size_t> slots_; ///< epochs
  std::vector<Row> rows_;
  double data_ = 0; ///< chi2 of no light at all
  mutable std::mutex lock_;
  mutable std::map<std::size_t, std::shared_ptr<const std::vector<std::uint32_t>>> pairs_;
};

} // namespace umov::inverse
