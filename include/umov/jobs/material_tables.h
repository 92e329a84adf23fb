#pragma once
// What there is to know about materials and indices, as tables.

#include <string>
#include <umov/io/table.h>
#include <umov/optics/band.h>
#include <umov/optics/index.h>
#include <umov/surface/material.h>
#include <vector>

namespace umov::jobs {

/// "300-1000" [nm], or "any".
std::string range_text(WavelengthRange range);
/// Wavelengths of the paper where the material has them, else the middle of its range.
std::vector<Band> bands_for(const Material &material);

/// Every material of the library: range, lobe, what it does to sunlight.
Result<Table> material_list();
/// Every distribution of normals and its numbers.
Table model_list();
/// What interface and whole surface do, band by band, with the material itself in the notes.
Result<Table> material_table(const Material &material);
/// Every table of optical constants: range and source.
Result<Table> index_list();
/// n and k of one table. BadInput with the tables that cover a wavelength where this one does not.
Result<Table> index_table(const IndexTable &index, const std::vector<double> &wavelengths_nm);

} // namespace umov::jobs
