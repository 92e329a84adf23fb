#pragma once
// Private: magnitudes of a tracking data message as observations.

#include <umov/io/observations_file.h>

namespace umov::jobs {

/// MAG of a TDM (CCSDS 503.0-B-2), KVN or XML, as rows without errors. A comment of its metadata,
/// "MAG: AB magnitude above the air in BAND", tells the band; the site is the scenario's, since
/// participants have names alone. BadInput with line for another message, another TIME_SYSTEM than
/// UTC, more than one object, two magnitudes of one time and band, and none at all.
Result<ObservationsFile> observations_of_tdm(std::string_view text, const std::string &file,
                                             Diagnostics &diagnostics);

} // namespace umov::jobs
