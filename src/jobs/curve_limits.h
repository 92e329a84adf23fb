#pragma once
// Private: what a curve cannot tell by itself, whatever is fitted to it.

#include <string>
#include <umov/inverse/likelihood.h>
#include <vector>

namespace umov::jobs {

/// What is asked of a curve.
enum class Asked {
  Attitude, ///< and with it spins and names
  Part      ///< material or change of a part, the attitude being known
};

/// The brightness of no band changes by more than its errors, at the observer or as the light that
/// the object gives (which differ by the range), nor do q and u where they are measured and used,
/// as the instrument has them or in the scattering plane. Errors are those of the likelihood: what
/// the model may be wrong by is no change.
bool is_steady(const ObservedCurve &curve, const CurveErrors &errors);
/// A parabola of the time explains the brightness of every band: the curve shows no turn, and a
/// period that is read from it is one of many.
bool shows_no_turn(const ObservedCurve &curve, const CurveErrors &errors);
/// One epoch, one band, no polarization, no change.
std::vector<std::string> limits_of(const ObservedCurve &curve, const CurveErrors &errors,
                                   Asked asked);

} // namespace umov::jobs
