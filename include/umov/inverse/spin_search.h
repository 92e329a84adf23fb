#pragma once
// Which constant spins a curve allows: docs/theory/inverse.md, section 8.

#include <optional>
#include <umov/inverse/pose_search.h>

namespace umov {

/// What is known of a spin before its search.
struct SpinRequest {
  std::vector<double> periods_s;  ///< inertial periods to be tried, each good to a few per cent
  std::optional<Vec3<Body>> axis; ///< in the body, either sense; absent: any
  /// Coarse light for the first steps (DirectionTable::lighting); empty: the light itself, which
  /// then has no parts.
  PoseLighting coarse = {};
  /// Coarser still, which tells the turnings of the first grid that are worth `coarse`; empty: that
  /// thins the grid out too.
  PoseLighting coarsest = {};
  /// Quicker light for what comes between, of the same parts; empty: the light itself.
  PoseLighting first = {};
  std::vector<PartKind> parts = {};         ///< of the light itself, of which `coarse` has none
  std::size_t attitudes = 6000, axes = 150; ///< of the first grid: spacing 14 and 17 deg
};

/// A period with the share of the posterior that it holds.
struct SpinPeriod {
  double period_s = 0, period_err_s = 0, weight = 0;
  std::size_t tried = 0; ///< which of the periods it was found from
};

/// Spins, their attitude at second 0 of the curve.
struct SpinAnswer {
  PoseAnswer pose; ///< modes and samples with rates
  std::vector<SpinPeriod> periods;
};

/// Grid over attitudes and axes on the middle two and a half turns, the best refined on longer and
/// longer stretches, the last by the light itself. Interrupted if it was stopped; BadInput for a
/// curve without measurements or a request without periods.
Result<SpinAnswer> search_spin(const ObservedCurve &curve, const PoseLighting &light,
                               const std::vector<std::size_t> &column, const SpinRequest &request,
                               const SearchOptions &options);

} // namespace umov
