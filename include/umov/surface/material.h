#pragma once
// What a surface is made of, as the user names it.

#include <complex>
#include <optional>
#include <string>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <vector>

namespace umov {

/// Complex refractive index n + ik (k >= 0 absorbs) against wavelength: linear between its points,
/// refused outside them. A single point with no wavelength is a constant.
struct IndexTable {
  std::string name;
  std::vector<double> wavelength_nm; ///< increasing; empty: one value at every wavelength
  std::vector<std::complex<double>> eta;
};

/// eta at a wavelength, linear in n and k; BadInput outside the table (no extrapolation).
Result<std::complex<double>> index_at(const IndexTable &table, Wavelength wavelength);

/// Combination of the masking of both directions (physics.md section 3).
enum class Shadowing { Ashikhmin, Smith, SmithDirectional, Separable };

/// Light scattered below the surface (the paper's unpolarized lobe, eq. 16): reflectance R_sub.
struct BodyLobe {
  std::vector<double> wavelength_nm; ///< increasing; empty: constant
  std::vector<double> reflectance;   ///< 0..1
};

/// A surface with a Blinn-Phong distribution of microfacet normals.
struct Material {
  std::string name;
  IndexTable index;
  double exponent = 200; ///< Blinn-Phong m >= 0
  Shadowing shadowing = Shadowing::Ashikhmin;
  std::optional<BodyLobe> body; ///< absent: none
};

/// Checks numbers and lists: n > 0, k >= 0, 0 <= m <= 1e9, reflectance 0..1, wavelengths in nm,
/// increasing. BadInput says what was found and expected.
Result<void> check(const Material &material);

/// Table 1 of the paper: paper_au, paper_al, paper_bk7, paper_asi, paper_spectralon, paper_mylar,
/// with m = 200, ashikhmin shadowing and the paper's body lobe (product decisions).
std::vector<std::string> builtin_material_names();
/// BadInput, with the nearest name, if there is none of that name.
Result<Material> builtin_material(const std::string &name);
/// The refractive index of a built-in table by name (the same six names).
Result<IndexTable> builtin_index(const std::string &name);

} // namespace umov
