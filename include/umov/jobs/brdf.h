#pragma once
// Mueller BRDFs of a material, direction by direction.

#include <string>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/surface/material.h>
#include <vector>

namespace umov::jobs {

/// One geometry; angles from the normal, azimuth of the observer minus that of the source.
struct BrdfGeometry {
  double wavelength_nm = 550, theta_i_deg = 0, theta_o_deg = 0, phi_deg = 0;
  double azimuth_deg = 0; ///< of the source from the direction field of an anisotropic surface
};

/// A material and what is asked of it.
struct BrdfRequest {
  Material material;
  std::vector<BrdfGeometry> rows;
  bool with_terms = false; ///< the parts of m00 besides
  std::string file;        ///< that the rows were read from, for messages; "": the command line
};

/// Geometries of a CSV file with wavelength_nm, theta_i_deg, theta_o_deg and phi_deg.
Result<std::vector<BrdfGeometry>> read_brdf_geometries(const std::string &path, double azimuth_deg);

/// A row per geometry: all sixteen entries [1/sr]. Usage or BadInput (of a file) for angles that
/// are not between 0 and 90 deg; Interrupted where the monitor cancels.
Result<Table> brdf_table(const BrdfRequest &request, const Monitor &monitor = {});

} // namespace umov::jobs
