#pragma once
// What a material is and does, as a page of figures.

#include <string>
#include <umov/core/result.h>
#include <vector>

namespace umov::jobs {

/// Which materials are drawn, and how.
struct MaterialPageRequest {
  std::vector<std::string> names; ///< of the library, or TOML files
  std::vector<double> wavelengths_nm{425, 550, 650};
  double theta_i_deg = 60; ///< source from the normal, for lobes and colour
};

/// One HTML page with a figure for each material of the library: Q of a sphere against phase, by
/// the wavelengths that its tables cover.
Result<std::string> material_gallery(const std::vector<double> &wavelengths_nm);

/// One HTML page: Q of a sphere and of one reflection against phase, Fresnel curves, n and k, lobes
/// and colour ratio.
Result<std::string> material_page(const MaterialPageRequest &request);

} // namespace umov::jobs
