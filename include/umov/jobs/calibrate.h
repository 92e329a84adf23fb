#pragma once
// What standard stars tell of a polarimeter.

#include <umov/core/diagnostics.h>
#include <umov/io/calibration_file.h>
#include <umov/io/counts_file.h>
#include <umov/io/polarizer_file.h>
#include <umov/io/standards_file.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// Efficiency, angle and own polarization from counts whose `name` is that of a polarimetric
/// standard; zero point, extinction and colour term from those of known magnitude, with
/// `has_second_order` k'' too. BadInput where names, bands or the choice of standards do not do, or
/// the frame is not equatorial; where the rest can be told, photometry that cannot is a warning.
Result<CalibrationFile> calibrate(const CountsFile &counts,
                                  const std::vector<StandardStar> &standards, bool has_second_order,
                                  Diagnostics &diagnostics);

/// What each channel takes of I, Q, U, from counts behind a polarizer that was turned before the
/// instrument: one row per channel. Angles are from where the polarizer's circle begins; a
/// polarized standard tells where that is on the sky. BadInput where angles do not tell all three.
Result<Table> calibrate_channels(const std::vector<PolarizerCount> &counts,
                                 Diagnostics &diagnostics);

/// Whether a calibration, read from `path`, belongs to counts: BadInput for another instrument or
/// band, of which it tells nothing; a warning where it is a month older.
Result<void> check_calibration(const CalibrationFile &file, const CountsFile &counts,
                               const std::string &path, Diagnostics &diagnostics);

} // namespace umov::jobs
