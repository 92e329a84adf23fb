#pragma once
// Bands as tables and text for a person.

#include <string>
#include <umov/io/passband_file.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// Every compiled-in curve: wavelengths, zero points, and the Sun's magnitude in it.
Result<Table> band_list();
/// One band as a scenario spells it. Usage for a name that stands for several.
Result<Band> band_named(const std::string &name, const PassbandForm &form = {});
/// Its numbers, a line each.
Result<std::string> band_text(const Band &band);
/// Its response to photons against wavelength; of one wavelength a single row.
Result<Table> band_table(const Band &band);

} // namespace umov::jobs
