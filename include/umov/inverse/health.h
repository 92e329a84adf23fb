#pragma once
// Has an object changed since its light was modelled: docs/theory/inverse.md, section 11.

#include <string>
#include <umov/inverse/unmix.h>
#include <vector>

namespace umov {

/// A way in which an object may have changed, or in which it is not known.
struct LightChange {
  std::string name;
  EndMember light; ///< of the object changed by `step`, to first order
  double step = 1; ///< in the unit of the parameter
  double sd = 0;   ///< of an unknown that is not asked for: what it may be; else not used
};

/// What a curve says of one change, the others being none.
struct HealthRow {
  std::string name;
  double change = 0, change_err = 0; ///< error 0: the data hold no light of it
  double sigma = 0;                  ///< change over its error
  double detectable = 0;             ///< smallest change that shows at three standard deviations
  double chi2_gain = 0;              ///< of the change against none
  /// False: the data ask for more of the change than leaves every measured row its light; as much
  /// as does is told.
  bool is_settled = true;
};

/// A score test of each change.
struct Health {
  std::vector<HealthRow> rows;
  double chi2 = 0; ///< without any change
  std::size_t measurements = 0;
  /// All changes fitted together, in the order of the rows, and their covariance [row * n +
  /// column].
  std::vector<double> joint, joint_covariance;
  /// Light of the best fit with one change, the one that explains most, in the model's units.
  EndMember fitted;
};

/// Least squares of the data on the object as it was, one change at a time, and all unknowns under
/// their priors; the scale is free, zero points and the floor are as in `unmix`. q and u are used
/// where the object as it was gives light. No step of a fit goes where one of these rows had none.
Health check_health(const ObservedCurve &curve, const CurveErrors &errors, const EndMember &before,
                    const std::vector<LightChange> &changes,
                    const std::vector<LightChange> &unknowns);

} // namespace umov
