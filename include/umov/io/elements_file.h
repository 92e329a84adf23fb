#pragma once
// Files of mean elements, told apart by what they hold.

#include <string>
#include <string_view>
#include <umov/io/tle.h>
#include <vector>

namespace umov {

/// Forms of a file of mean elements.
enum class ElementsForm { Tle, OmmKvn, OmmXml, OmmJson, OmmCsv };

/// By content, never by name: TLE is what nothing else is.
ElementsForm form_of_elements(std::string_view text);

/// Reads TLE and 3LE (see read_tle), and the CCSDS Orbit Mean-Elements Message (502.0-B-3) as KVN,
/// XML, JSON and CSV; numbers may be strings, catalogue numbers may have nine digits. KVN and XML
/// must state centre EARTH, frame TEME, time scale UTC and theory SGP4; JSON and CSV, as catalogues
/// serve them, may leave these out. BadInput names message, object and field.
Result<std::vector<ElementSet>> read_elements(std::string_view text, const std::string &file,
                                              const TleOptions &options, Diagnostics &diagnostics);

/// "98067A" of a TLE as "1998-067A"; anything else as it is.
std::string long_designator(const std::string &text);

/// Text of a form. In OMM every element is the shortest decimal that gives back the same number; a
/// TLE has fewer digits, and a warning per field says how many sets lost some. A name that there
/// is none of is written UNKNOWN, which CCSDS wants. BadInput for a catalogue number that a TLE
/// cannot hold. `created` is the message's date.
Result<std::string> write_elements(const std::vector<ElementSet> &sets, ElementsForm form,
                                   Epoch<Utc> created, Diagnostics &diagnostics);

} // namespace umov
