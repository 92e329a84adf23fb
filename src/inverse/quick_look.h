#pragma once
// Private: the first look at an object of a library, at microseconds an attitude.

#include "inverse/turning_fit.h"

#include <umov/inverse/signature.h>

namespace umov::inverse {

/// A curve held against many objects over the same attitudes, each of which is given by its pairs
/// of directions at some epochs: the numbers of the pairs are found once and serve all.
class QuickLook {
public:
  /// `column`: which band of the signatures each band of the curve is.
  QuickLook(const ObservedCurve &curve, const std::vector<std::size_t> &column, std::size_t cells,
            std::size_t attitudes, unsigned threads);

  /// The best attitudes of one object by the nearest nodes, robustly.
  [[nodiscard]] std::vector<Turning> best(const Signature &signature, std::size_t count) const;
  /// -2 ln of the likelihood of the best of them, refined roughly between the nodes, with the norm
  /// of its errors.
  [[nodiscard]] double score(const Signature &signature, const CurveErrors &errors) const;

private:
  [[nodiscard]] float cost(const Signature &signature, std::size_t attitude,
                           std::vector<float> &ln_ratio) const;
  struct Row {
    std::size_t epoch = 0, band = 0;
    float ln_i = 0, weight_i = 0, q = 0, weight_q = 0;
  };
  const ObservedCurve &curve_;
  const std::vector<std::size_t> &column_;
  std::vector<Row> rows_;
  std::vector<Quaternion> attitudes_;
  std::vector<std::size_t> epochs_;
  std::vector<std::uint32_t> pair_; ///< [attitude * epochs + epoch]
};

} // namespace umov::inverse
