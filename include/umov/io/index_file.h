#pragma once
// Refractive indices in files, and those that are compiled in.

#include <filesystem>
#include <string>
#include <umov/core/result.h>
#include <umov/optics/index.h>
#include <vector>

namespace umov {

/// Reads a page of refractiveindex.info as it is published (YAML: DATA with tabulated nk, n, k or
/// formula 1 to 9; wavelengths in um), or columns of wavelength, n and k between blanks, commas or
/// semicolons (nm or um by the header, else by the numbers; k may be absent). BadInput with file
/// and line for an unknown type or formula, wavelengths that are not increasing or look like nm, k
/// < 0, n <= 0.
Result<IndexTable> read_index_text(const std::string &text, const std::string &file);
/// The same from a file.
Result<IndexTable> read_index_file(const std::filesystem::path &path);

/// The suffix says that a name is one of a file: .yml, .yaml, .csv, .txt, .dat.
bool is_index_file_name(const std::filesystem::path &name);

/// Names of the compiled-in tables (stems of data/nk, and paper_au and so on), sorted.
std::vector<std::string> index_names();
/// A compiled-in table by name; BadInput with the nearest name if there is none.
Result<IndexTable> find_index(const std::string &name);

/// Names of compiled-in tables of the same substance ("Al" of "Al_Rakic") that cover a wavelength,
/// for the message of one that does not; all that cover it if there is none.
std::vector<std::string> indices_covering(const std::string &name, Wavelength wavelength);

} // namespace umov
