#pragma once
// Private: light between surfaces beside what a search has.

#include "jobs/invert_light.h"

namespace umov::jobs {

struct Judgement;

/// What light from surface to surface, up to three of them, is of the light at a turning: the
/// median over a dozen epochs and all bands. 0 where the body is convex and where nothing is lit.
/// Good to a tenth of the light: it is for a note. Interrupted if the monitor says so.
Result<double> share_between(const Scenario &scenario, const SearchedLight &ready,
                             const ObservedCurve &curve, const Turning &at,
                             const JobOptions &options, const Monitor &monitor);
/// Whether it is so much more than the floor that an answer of direct light is none.
bool is_too_much_between(double share, double floor);
/// Where the search left it out: says so if it is more than the floor that was asked for, and takes
/// a verdict back where it is far more: what grows with the misfit covers errors of each row, not
/// one that all share.
/// `meaning`: of what the question is about, as in "so the name may be wrong".
void doubt_direct_light(double share, double floor, std::string_view meaning, Verdict &verdict,
                        std::vector<std::string> &notes);
/// Both, of the best attitude of an answer that fits.
Result<void> judge_direct_light(const Scenario &scenario, const InvertRequest &request,
                                const SearchedLight &ready, const ObservedCurve &curve,
                                const PoseAnswer &answer, const JobOptions &options,
                                const Monitor &monitor, Judgement &out);

} // namespace umov::jobs
