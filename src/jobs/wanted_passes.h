#pragma once
// Private: a run's part as passes of its objects.

#include <umov/jobs/run.h>

namespace umov::jobs {

/// The light curve of the passes that are wanted of an object.
Result<LightCurveOutcome> compute_wanted(const ObjectRun &one, const LightModels &models,
                                         const Progress &progress, const std::atomic<bool> &cancel,
                                         KeptBlocks blocks);

/// The passes of a range that counts those of all objects, one object after the other: what is
/// wanted of an object whose passes begin at `first` of them and are `count`. No passes if they lie
/// elsewhere.
IndexRange overlap(IndexRange range, std::size_t first, std::size_t count);

/// Leaves of the objects those with passes in the part. Nothing where there are none.
Result<void> take_part(std::vector<ObjectRun> &objects, const JobPart &part,
                       const std::atomic<bool> &cancel);

} // namespace umov::jobs
