#pragma once
// Files of mean elements and CCSDS messages: what they hold, and the same in another form.

#include <optional>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>
#include <umov/time/epoch.h>

namespace umov::jobs {

/// A file of orbits: TLE, 3LE, OMM, OEM, OPM, AEM or TDM.
struct OrbitFile {
  std::string path;
  int norad = 0; ///< only the sets of this catalogue number; 0: all
  bool allow_bad_checksum = false;
  bool keep_going = false; ///< bad sets are reported, the others kept
};

/// A row per element set, or per segment of a message.
Result<Table> orbit_file_table(const OrbitFile &file, Diagnostics &diagnostics);

/// A file in another form.
struct ConversionRequest {
  OrbitFile file;
  std::string form;                      ///< tle, kvn, xml, json, csv or oem
  std::string output;                    ///< where the text will go, for messages
  std::optional<Epoch<Utc>> start, stop; ///< of an OEM, both included
  double step_s = 60;
  Epoch<Utc> written{}; ///< date of the new file
};

/// The text of the new file. An OEM samples any orbit at even steps; a message stays what it is, as
/// KVN or XML; elements take any other form. Usage where a form is missing or does not fit.
Result<std::string> convert_orbit_file(const ConversionRequest &request, Diagnostics &diagnostics);

} // namespace umov::jobs
