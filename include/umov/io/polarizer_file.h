#pragma once
// Counts behind a polarizer that is turned before an instrument.

#include <string>
#include <string_view>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// One channel at one angle of the polarizer.
struct PolarizerCount {
  std::string channel;  ///< empty where the file has one channel alone
  double angle_rad = 0; ///< of the polarizer, from wherever its circle begins
  double counts = 0;    ///< without sky and dark [electron]
  double variance = 0;  ///< of them [electron^2]
};

/// Reads a CSV or ECSV with the columns angle_deg and counts, and channel and variance where they
/// are there; without a variance that of the photons. BadInput with line for what is missing, no
/// number, or a variance of 0.
Result<std::vector<PolarizerCount>> read_polarizer_text(std::string_view text,
                                                        const std::string &file);

} // namespace umov
