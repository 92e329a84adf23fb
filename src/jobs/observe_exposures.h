#pragma once
// Private: when the exposures of an observation are taken, and which of the grid are not.

#include "jobs/observe_exposure.h"

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/lightcurve/light_curve.h>

namespace umov::jobs {

/// Exposures of the grid that nothing is recorded of, and why.
struct LeftOut {
  std::size_t low = 0;      ///< below the altitude limit, or the horizon
  std::size_t light = 0;    ///< the Sun too high
  std::size_t shadow = 0;   ///< no sunlight
  std::size_t gaps = 0;     ///< in gaps of the ephemeris
  std::size_t unknown = 0;  ///< after the end of the orbit
  std::optional<Error> end; ///< what the orbit says there

  [[nodiscard]] std::size_t sum() const { return low + light + shadow + gaps + unknown; }
};

/// Exposures in order of time.
struct ExposureList {
  std::vector<Exposure> exposures;
  LeftOut left_out;
};

/// Those of a span in which the object is seen. BadInput where an exposure is longer than the span
/// or there are more than 10 million.
Result<ExposureList> exposures_of(const Scenario &scenario, const Track &track,
                                  const LightCurveRequest &request, const Programme &programme,
                                  std::uint32_t object, const Monitor &monitor);

/// Warns of exposures that nobody asked to leave out; what the scenario's own filters leave out is
/// returned as a sentence, empty where it is nothing.
std::string tell_left_out(const LeftOut &left_out, std::size_t all, const Scenario &scenario,
                          const std::string &object, Diagnostics &diagnostics);

/// Circumstances that the models of the air reach badly are warned of; BadInput where they do not
/// reach at all.
Result<void> check_air(const std::vector<Exposure> &exposures, const Setup &setup,
                       Diagnostics &diagnostics);

} // namespace umov::jobs
