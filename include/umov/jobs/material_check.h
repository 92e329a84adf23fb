#pragma once
// Are materials physical, and does their statistical model hold against a surface that is traced?

#include <cstdint>
#include <string>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <vector>

namespace umov::jobs {

/// Which materials, and how thoroughly.
struct MaterialCheckRequest {
  std::vector<std::string> names;              ///< or TOML files
  std::uint64_t geometries = 10'000, seed = 0; ///< random pairs of directions, per band
};

/// What was found.
struct MaterialCheck {
  Table table;         ///< a row for each material
  std::size_t bad = 0; ///< materials that break a law
  /// What their files leave to be said: "gold: no roughness was measured".
  std::vector<std::string> remarks;
};

/// Reciprocity, realisability, albedo and energy of every material. BadInput for one that cannot be
/// read or compiled.
Result<MaterialCheck> check_materials(const MaterialCheckRequest &request, unsigned threads);

/// A random rough surface, every facet a perfect mirror, and the light that falls on it.
struct RoughSurfaceRequest {
  double slope = 0.3, hurst = 0; ///< as RoughSurfaceOptions
  std::vector<double> theta_deg{60};
  std::size_t cells = 256, realisations = 4;
  double correlation_cells = 8;
  std::uint64_t rays = 200'000; ///< per surface and incidence
  std::uint64_t seed = 0;
};

/// The fraction of light that it scatters once, as traced and by the model of its slopes with each
/// joint masking, and how far the directions differ: a row for each incidence. BadInput for numbers
/// outside their ranges; Interrupted where the monitor cancels.
Result<Table> rough_surface_table(const RoughSurfaceRequest &request, unsigned threads,
                                  const Monitor &monitor);

} // namespace umov::jobs
