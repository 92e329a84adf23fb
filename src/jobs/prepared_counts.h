#pragma once
// Private: counts as options of the reduction want them, before anything is fitted.

#include <umov/jobs/reduce.h>

namespace umov::jobs {

/// Some option asks for other counts than those of the file.
bool is_prepared(const ReduceOptions &options);

/// The counts with aperture losses beside scintillation, behind the photometry that was
/// calibrated, and with the turn of their axes. BadInput where the file does not tell what an
/// option needs.
Result<CountsFile> prepare(CountsFile file, const ReduceOptions &options);

} // namespace umov::jobs
