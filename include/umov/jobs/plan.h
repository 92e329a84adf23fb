#pragma once
// Before the night: which passes, bands and Stokes components would tell alternatives apart.

#include <string>
#include <umov/jobs/invert.h>
#include <vector>

namespace umov::jobs {

/// Something that may be the case: an object with its materials and attitude.
struct PlanAlternative {
  std::string name;
  Scenario scenario; ///< of its first object; orbit, observer, time and bands are the plan's
  double prior = 1;  ///< chance before, relative to the others
};

/// The attitudes that an answer of umov invert left open, "mode 1" on, each with its weight where
/// that is above 1 %: the scenario's first object so turned. `answer`: its folder, or its
/// modes.ecsv (attitudes body_from_gcrs; with rates it turns from epoch_utc of the header on).
/// BadInput as `read_modes_text`, and where fewer than two are left.
Result<std::vector<PlanAlternative>> alternatives_of_modes(const Scenario &scenario,
                                                           const std::string &answer);

/// What is asked, beside the alternatives.
struct PlanRequest {
  CurveErrors errors; ///< of the model and the zero points, as the later fit will have them
  LightMethod method = LightMethod::Auto;
  /// Signal to noise of I in a row as bright as the median one of its band; 0: what the scenario's
  /// [observation] and its instrument reach, or 100 where it has none.
  double snr = 0;
  double sky_mag = 21;             ///< of the instrument's sky, AB in the band [mag / arcsec2]
  bool allow_old_elements = false; ///< over 30 days from the span
};

/// Which of the passes within the scenario's [time] would tell the alternatives apart: a row for
/// each pass, best first; what each band and I alone would tell, which pairs are hardest, which
/// passes together. The verdict is `determined` where one pass has a chance of 95 % that the true
/// one gets more than 95 %, `ambiguous` where only several together do, else `undetermined`. Usage
/// for fewer than two alternatives or names that stand twice, Nothing where there is no epoch.
Result<Inversion> plan_observations(const Scenario &scenario,
                                    const std::vector<PlanAlternative> &alternatives,
                                    const PlanRequest &request, const JobOptions &options,
                                    const Monitor &monitor, Diagnostics &diagnostics);

} // namespace umov::jobs
