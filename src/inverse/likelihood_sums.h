#pragma once
// Private: what the likelihood and the fit of a model's parts share.

#include "inverse/count_likelihood.h"

namespace umov::inverse {

/// Factors between model and data, and the common scale behind them.
struct Gains {
  std::vector<double> gain; ///< per group
  double scale = 1;
  double prior_chi2 = 0; ///< of the gains' own priors
  double log_det = 0;    ///< what the integrals over scale and gains leave behind
};

/// Data as a model is held against them.
struct Weighed {
  std::vector<double> weights; ///< of the rows
  WhitenedCounts counts;
  double scale = 1; ///< at which the counts were whitened
  double grown = 0; ///< ln of what variances have grown by, and of those that the model makes
};

/// Sums over data and model that the gains follow from, of each group and of all.
struct GainSums {
  std::vector<double> cross, square;
  double all_cross = 0, all_square = 0;
  void add(std::size_t group, double weight, double data, double model) {
    cross[group] += weight * data * model;
    square[group] += weight * model * model;
    all_cross += weight * data * model;
    all_square += weight * model * model;
  }
};

} // namespace umov::inverse
