#pragma once
// Refractive indices against wavelength.

#include <complex>
#include <string>
#include <umov/core/quantity.h>
#include <umov/core/result.h>
#include <variant>
#include <vector>

namespace umov {

/// Values at increasing wavelengths, linear in between; without wavelengths one constant value.
struct Tabulated {
  std::vector<double> wavelength_nm;
  std::vector<double> value;
  bool operator==(const Tabulated &) const = default;
};

/// One of the nine dispersion formulas of refractiveindex.info (Polyanskiy 2024, its file
/// "Dispersion formulas"), with the wavelength in um in it.
struct DispersionFormula {
  int number = 0; ///< 1 to 9
  std::vector<double> coefficients;
  double first_nm = 0, last_nm = 0; ///< where it holds
  bool operator==(const DispersionFormula &) const = default;
};

/// Complex refractive index n + ik; k >= 0 absorbs (time factor exp(-i omega t)). It ends where n
/// or k ends.
struct IndexTable {
  std::string name;
  std::variant<Tabulated, DispersionFormula> n;
  Tabulated k{{}, {0}};
  bool has_k = true; ///< false: the source gives no k, and 0 stands for "transparent or unknown"
  std::string file;  ///< of a table that is not compiled in
  std::string reference;   ///< where the numbers come from
  bool holds_ends = false; ///< within a band with a curve its end values hold beyond it
  bool operator==(const IndexTable &) const = default;
};

/// An index that is the same at every wavelength.
IndexTable constant_index(std::complex<double> eta);
/// n and k at the same wavelengths.
IndexTable tabulated_index(std::string name, std::vector<double> wavelength_nm,
                           const std::vector<std::complex<double>> &eta);

/// First and last wavelength [nm] at which both n and k are known; 0 and infinity for a constant.
struct WavelengthRange {
  double first_nm = 0, last_nm = 0;
};
/// The range of a table.
WavelengthRange range_of(const IndexTable &table);

/// eta at a wavelength; BadInput outside the table (no extrapolation) and where a formula has no
/// real value there.
Result<std::complex<double>> index_at(const IndexTable &table, Wavelength wavelength);

/// A tabulated value at a wavelength; BadInput outside, named `what`.
Result<double> value_at(const Tabulated &table, Wavelength wavelength, const std::string &what);

/// Increasing wavelengths that are plausible in nm, as many values, n > 0, k >= 0, a formula that
/// is known with as many coefficients as it takes. BadInput says what was found and how to mend it.
Result<void> check_index(const IndexTable &table);
/// The wavelengths alone: increasing, and as many values; `what` names the table in messages.
Result<void> check_tabulated(const Tabulated &table, const std::string &what);

} // namespace umov
