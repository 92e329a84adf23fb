#pragma once
// What the air over a site takes, as the site has measured it.

#include <string>
#include <string_view>
#include <umov/atmosphere/air.h>
#include <umov/core/result.h>

namespace umov {

/// Reads CSV or ECSV with the columns wavelength_nm and k_mag [mag per air mass]. BadInput with
/// line for what is missing, no number, beyond what air does, or does not increase in wavelength.
Result<MeasuredExtinction> read_extinction_text(std::string_view text, const std::string &file);

} // namespace umov
