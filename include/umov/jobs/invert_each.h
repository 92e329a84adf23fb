#pragma once
// Many light curves, each a question of its own: which attitude, or which object.

#include <umov/jobs/identify.h>
#include <umov/jobs/invert.h>
#include <umov/jobs/ranged_job.h>

namespace umov::jobs {

/// `umov invert pose --each` by curves: every file of `request.observations` is one. Tables: curves
/// (a row of each: verdict, or what the problem with it is), then those of invert_pose with a first
/// column `curve`. A curve that cannot be inverted ends none of the others. Interrupted where
/// `monitor` cancels.
Result<std::unique_ptr<RangedJob>> ranged_poses(const Scenario &scenario,
                                                const InvertRequest &request,
                                                const JobOptions &options, const Monitor &monitor,
                                                Diagnostics &diagnostics);
/// The same of `umov identify --each` and identify_object.
Result<std::unique_ptr<RangedJob>>
ranged_identities(const Scenario &scenario, const IdentifyRequest &request,
                  const JobOptions &options, const Monitor &monitor, Diagnostics &diagnostics);

/// Answers to a part of the curves.
struct CurveAnswers {
  std::vector<NamedTable> tables;
  std::size_t curves = 0;
  std::vector<std::string> failed; ///< file and problem of those without an answer
  std::vector<InputFile> inputs;   ///< read for them
};
/// Usage for a part beyond the curves; Interrupted after a stop.
Result<CurveAnswers> answer_curves(RangedJob &job, const JobPart &part, const Monitor &monitor,
                                   Diagnostics &diagnostics);

/// BadInput where curves have no answer, with the problems of the first few.
Result<void> all_answered(const std::vector<std::string> &problems, std::size_t curves);

/// Tables, log, locked scenario and manifest.
Result<void> write_answers(const CurveAnswers &answers, const Scenario &scenario,
                           ManifestInput manifest, const Diagnostics &diagnostics,
                           RunFolder &folder);

} // namespace umov::jobs
