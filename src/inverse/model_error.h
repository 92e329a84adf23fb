#pragma once
// Private: how far off the model is, as the data themselves say.

#include "inverse/turning_fit.h"

namespace umov::inverse {

/// Errors of a model as its best fit leaves them.
struct ModelError {
  CurveErrors errors; ///< as asked for, the floor as large as the misfit asks
  double found = 0;   ///< error of the model in parts of I that makes the misfit likeliest
  double related = 1; ///< how many numbers are wrong together
  double chi2 = 0;    ///< of the best, if the error is `found` and all numbers are independent
};

/// Of the best of some turnings. The floor is the one of the largest likelihood, up to `largest`,
/// times the root of how many residuals go together: a wrong material is wrong in all bands and for
/// minutes, and a floor by itself takes its error for new in every number. It is never less than
/// that of `asked`. False if it was stopped.
bool find_model_error(const CurveModel &model, const CurveErrors &asked, double largest,
                      std::span<const Turning> turnings, unsigned threads, ModelError &out);

} // namespace umov::inverse
