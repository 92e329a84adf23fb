#pragma once
// Private: what has changed on an object, as tables and in words.

#include "jobs/invert_parts.h"

#include <umov/inverse/health.h>
#include <umov/inverse/null_test.h>
#include <umov/jobs/invert.h>

namespace umov::jobs {

/// What a part of the data says by itself, of the observations and of the baseline if there is one.
struct PartHealth {
  DataPart part;
  Health health;
};

/// health.ecsv.
Table health_table(const Health &health, Verdict verdict);
/// parts.ecsv.
Table parts_table(const std::vector<PartHealth> &parts);
/// report.html.
std::string health_page(const std::string &title, const Table &fit, const Health &health,
                        const std::vector<PartHealth> &parts, const std::string &summary);
/// verdict.json.
std::string json_of(const Health &health, const NullTest &u, Verdict verdict,
                    const std::vector<std::string> &notes);
/// One change explains the data; several do, or one that cannot be; none was needed, or could be
/// seen; nothing does. `baseline`: what it showed by itself, if there is one.
Verdict verdict_of(const Health &health, const Health *baseline);
/// What the answer rests on, and what it cannot tell. `u`, `u_before`: of the best fit, and of that
/// of the baseline.
std::vector<std::string> notes_of(const Health &health, const Health *baseline, Verdict verdict,
                                  const NullTest &u, const NullTest &u_before,
                                  const ObservedCurve &curve, const CurveErrors &errors);

} // namespace umov::jobs
