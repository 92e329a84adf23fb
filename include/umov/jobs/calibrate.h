#pragma once
// What standard stars tell of a polarimeter.

#include <umov/core/diagnostics.h>
#include <umov/io/calibration_file.h>
#include <umov/io/counts_file.h>
#include <umov/io/standards_file.h>

namespace umov::jobs {

/// Efficiency, angle and own polarization from counts whose `name` is that of a standard. BadInput
/// where names, bands or the choice of standards do not do, or the frame is not equatorial.
Result<CalibrationFile> calibrate(const CountsFile &counts,
                                  const std::vector<PolarizedStandard> &standards,
                                  Diagnostics &diagnostics);

} // namespace umov::jobs
