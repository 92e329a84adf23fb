#pragma once
#include <string>
#include <umov/core/result.h>
#include <umov/reduction/calibration.h>

namespace umov {

/// A calibration with what it belongs to.
struct CalibrationFile {
  std::string instrument, band, pol_frame, made_utc;
  PolarimeterCalibration calibration;
};

/// Reads TOML as `calibration_as_toml` writes it.
Result<CalibrationFile> read_calibration_text(const std::string &text, const std::string &file);
/// Efficiency, angle and own polarization with their standard deviations.
std::string calibration_as_toml(const CalibrationFile &file);

} // namespace umov
