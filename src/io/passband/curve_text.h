#pragma once
// Private: what a file of a curve says, before it is a band.

#include <umov/io/passband_file.h>

namespace umov::passband {

/// Wavelengths in the unit of the file, responses in its convention.
struct Curve {
  std::vector<double> wavelength, response;
  std::vector<std::size_t> line; ///< of each point
  PassbandForm form;             ///< as far as the file says
  std::string source;
  /// Spectral flux of magnitude 0 in the Vega system [Jy]; 0: the file has none.
  double vega_zero_jy = 0;
};

/// Two columns.
Result<Curve> read_columns(const std::string &text, const std::string &file);
/// A VOTable of the SVO Filter Profile Service.
Result<Curve> read_votable(const std::string &text, const std::string &file);

/// One unit of length in nm by its name (nm, um, Angstrom and their spellings); 0: unknown.
double unit_nm(std::string_view name);

} // namespace umov::passband
