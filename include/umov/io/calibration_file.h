#pragma once
#include <optional>
#include <string>
#include <umov/core/result.h>
#include <umov/reduction/calibration.h>
#include <vector>

namespace umov {

/// A calibration with what it belongs to.
struct CalibrationFile {
  std::string instrument, band, pol_frame, made_utc;
  std::optional<PolarimeterCalibration> calibration; ///< of q and u
  /// Of brightness. Instrumental magnitudes are those of the counts' own w0 behind the air, so that
  /// the zero point is what theirs is off.
  std::optional<PhotometricCalibration> photometry;
  std::vector<std::string> warnings; ///< of the fit: comments of the file
};

/// Reads TOML as `calibration_as_toml` writes it.
Result<CalibrationFile> read_calibration_text(const std::string &text, const std::string &file);
/// Efficiency, angle and own polarization with their standard deviations; zero point, extinction
/// and colour terms with their covariance.
std::string calibration_as_toml(const CalibrationFile &file);

} // namespace umov
