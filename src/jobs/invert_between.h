#pragma once
// Private: the light that a search leaves out.

#include "jobs/invert_light.h"

namespace umov::jobs {

struct Judgement;

/// What light from surface to surface, up to three of them, is of the light at a turning: the
/// median over a dozen epochs and all bands. Searches have direct light alone; none is told where
/// the scenario has them count all of it. 0 where the body is convex and where nothing is lit. Good
/// to a tenth of the light: it is for a note. Interrupted if the monitor says so.
Result<std::optional<double>> share_between(const Scenario &scenario, const SearchedLight &ready,
                                            const ObservedCurve &curve, const Turning &at,
                                            const JobOptions &options, const Monitor &monitor);
/// Says so where it is more than the floor that was asked for, and takes a verdict back where it is
/// far more: what grows with the misfit covers errors of each row, not one that all share.
void doubt_direct_light(std::optional<double> share, double floor, Verdict &verdict,
                        std::vector<std::string> &notes);
/// Both, of the best attitude of an answer that fits.
Result<void> judge_direct_light(const Scenario &scenario, const InvertRequest &request,
                                const SearchedLight &ready, const ObservedCurve &curve,
                                const PoseAnswer &answer, const JobOptions &options,
                                const Monitor &monitor, Judgement &out);

} // namespace umov::jobs
