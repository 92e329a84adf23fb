#pragma once
// Private: how probable a curve is, of an object that is known by a table, of one that is like it,
// and of one that shows nothing of its attitude.

#include <cmath>
#include <umov/inverse/pose_search.h>

namespace umov::inverse {

/// ln of nothing.
inline constexpr double least_log = -1e300;
/// ln(e^a + e^b).
double log_sum(double a, double b);
/// ln, least_log for 0.
double log_of(double x);

/// Errors of an object that is another's like in other colours.
CurveErrors of_recoloured(CurveErrors errors);
/// Errors of an object that is like another, but not that one.
CurveErrors of_kin(CurveErrors errors);

/// ln evidence of an object that shows nothing of its attitude: constant, or a diffuse sphere
/// (Lambert's phase function), of any colour and unpolarized.
double featureless(const ObservedCurve &curve, CurveErrors errors);
/// ln of the mean over `of` attitudes of the likelihoods of those that matter.
Result<double> mean_evidence(const CurveModel &model, const CurveLikelihood &likelihood,
                             const std::vector<Turning> &best, std::span<const std::size_t> epochs,
                             std::size_t of, unsigned threads);
/// ln of the largest likelihood that a candidate's table reaches from some attitudes (best first)
/// on some epochs, at whichever size of its error it is largest: no evidence, but little time.
Result<double> table_peak(const CurveModel &model, const CurveErrors &errors, double table_error,
                          const std::vector<Turning> &best, std::span<const std::size_t> epochs,
                          unsigned threads);
/// ln evidence of one candidate's table, all sizes of its error alike before: found with the
/// largest of them, and carried to the smaller ones by its samples.
Result<double> table_evidence(const CurveModel &model, const SearchOptions &search,
                              double table_error, PoseAnswer &answer);
/// Share of the epochs whose errors of a table of so many cells a side are their own: those within
/// one cell have the same. How far Sun and observer move as seen from the object, in cells.
double independent_share(const ObservedCurve &curve, std::size_t cells);
/// ln of the most that a fit of this p-value may weigh against a better model that nobody has
/// stated, -e p ln p (Sellke, Bayarri & Berger 2001); 0 for p above 1/e.
double log_misfit(const PoseAnswer &answer);

} // namespace umov::inverse
