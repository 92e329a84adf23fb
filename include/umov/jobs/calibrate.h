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

/// Whether a calibration, read from `path`, belongs to counts: BadInput for another instrument or
/// band, of which it tells nothing; a warning where it is a month older.
Result<void> check_calibration(const CalibrationFile &file, const CountsFile &counts,
                               const std::string &path, Diagnostics &diagnostics);

} // namespace umov::jobs
