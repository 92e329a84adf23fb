#pragma once
// Measured surfaces in files.

#include <filesystem>
#include <string>
#include <umov/core/result.h>
#include <umov/surface/measured.h>
#include <vector>

namespace umov {

/// CSV with columns wavelength_nm, theta_i_deg, theta_o_deg, phi_deg [deg, 0 to 180] and m00
/// [1/sr], and m01 ... m33 too for a Mueller table (scattering plane). `accept` takes a table that
/// is not reciprocal or gives more than it gets; what is odd about it goes to `remarks`.
Result<MeasuredBrdf> read_measured_file(const std::filesystem::path &path, bool accept,
                                        std::vector<std::string> &remarks);

/// The same from a text; `file` is for messages.
Result<MeasuredBrdf> read_measured(std::string_view text, const std::string &file, bool accept,
                                   std::vector<std::string> &remarks);

/// Density of normals: CSV with columns theta_deg (from 0, increasing) and density (any unit).
struct NormalsTable {
  std::vector<double> angle_deg, density;
};
/// Reads such a table. BadInput with the line of what is wrong.
Result<NormalsTable> read_normals_file(const std::filesystem::path &path);
/// The same from a text.
Result<NormalsTable> read_normals(std::string_view text, const std::string &file);

} // namespace umov
