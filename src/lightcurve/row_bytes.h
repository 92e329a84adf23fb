#pragma once
// Private: the light of a block of rows as bytes, to be kept while a run goes on.

#include <string>
#include <string_view>
#include <umov/light/stokes_table.h>
#include <umov/lightcurve/light_curve.h>

namespace umov {

/// Sunlight (`table`) of `count` rows, and the second lights of rows [begin, begin + count) of the
/// curve. Where the object was is not among it: that is found again in no time.
std::string row_bytes(const StokesTable &table, std::size_t begin, std::size_t count,
                      const LightCurve &curve);
/// Puts them back; false for bytes that do not fit, with the rows to be lit anew.
[[nodiscard]] bool take_row_bytes(std::string_view bytes, std::size_t begin, std::size_t count,
                                  StokesTable &table, LightCurve &curve);

} // namespace umov
