#pragma once
// Private: electrons held against the light of a model: docs/theory/inverse.md, section 2.

#include "algebra/whitener.h"

#include <umov/inverse/likelihood.h>
#include <vector>

namespace umov::inverse {

/// Counts and the model's electrons, both whitened: residuals are net - gain * light.
struct WhitenedCounts {
  std::vector<double> net, light;
  double log_det = 0;                     ///< of the covariances
  std::vector<std::vector<double>> parts; ///< electrons of each part, by the same whitening
};

/// The channels of exposures, ready to be compared with many models.
class CountLikelihood {
public:
  /// Channels of one exposure in one band; `begin`: among all channels.
  struct Set {
    std::size_t at = 0, group = 0; ///< in the model's light; of the gain
    std::size_t begin = 0, size = 0;
  };

  CountLikelihood(const ObservedCurve &curve, const CurveErrors &errors, double median_i,
                  std::span<const std::size_t> epochs);
  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  [[nodiscard]] const std::vector<Set> &sets() const { return sets_; }
  /// The scale that the data's own variances give; for a first guess.
  [[nodiscard]] double first_scale(const ModelLight &model) const;
  /// With the variances that the model has at a scale.
  [[nodiscard]] WhitenedCounts whitened(const ModelLight &model, double scale) const;

private:
  void whiten_set(const Set &set, const ModelLight &model, double scale,
                  algebra::Whitener &whitener, WhitenedCounts &out) const;
  std::vector<ObservedCount> counts_;
  std::vector<Set> sets_;
  CurveErrors errors_;
  double median_i_ = 0;
};

} // namespace umov::inverse
