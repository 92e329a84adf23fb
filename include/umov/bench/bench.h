#pragma once
// Speed and accuracy of the fast path on this machine, side by side.

#include <optional>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/light/device.h>
#include <vector>

namespace umov::bench {

/// What this program found to run on.
struct Machine {
  std::string processor;       ///< as the system names it
  std::string instruction_set; ///< in use for lanes, as Highway names it
  unsigned cores = 0;
};
Machine machine();

/// What of the benchmark of light is measured, and for how long.
struct LightRequest {
  std::vector<std::string> meshes; ///< OBJ files (m, +Z up) instead of the standard cases
  std::string only;                ///< cases with this in their name
  std::size_t geometries = 200;    ///< poses compared with rays; 0: none
  std::uint64_t seed = 3;          ///< of the poses that are compared
  double seconds = 2;              ///< spent on each rate
  /// Cuda, and Auto where there are cards: these beside one core and all cores, in cases of their
  /// own.
  DeviceOptions device = {};
  /// Poses that cards are asked for at a time; empty: 1, 100, 10,000 and 1,000,000. Usage without
  /// cards. What would take longer than a minute is cut (column `batch`).
  std::vector<std::size_t> batches = {};
};

/// Rows of the cases that were measured.
struct LightReport {
  Table table;
  std::optional<Error> stopped; ///< Interrupted: cases are missing
};

/// Rates of the fast path and its errors against rays, case by case. Usage if no case has that
/// name, Device where cards are asked for and lack something. Changes the instruction set in use
/// while it runs: nothing else may be lit meanwhile.
Result<LightReport> light(const LightRequest &request, const jobs::Monitor &monitor,
                          Diagnostics &diagnostics);

/// Rates of SGP4 over a catalogue: one state at a time and in lanes, for every instruction set.
Result<Table> orbit(const std::string &file, Diagnostics &diagnostics);

} // namespace umov::bench
