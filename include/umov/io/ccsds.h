#pragma once
// CCSDS navigation data messages as they are written: OPM, OEM (502.0-B-3), AEM (504.0-B-2) and
// TDM (503.0-B-2), as KVN and XML. Texts are kept as they stand, so that nothing is lost on the
// way from one form to the other; line breaks of XML become blanks, and what is not printable '?'.

#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <vector>

namespace umov::ccsds {

/// KEYWORD = text [unit]. COMMENT is a keyword like others.
struct Field {
  std::string key, text, unit;
  std::size_t line = 0;
};

/// Fields that belong together, by the name of their XML element: "stateVector",
/// "keplerianElements", "spacecraftParameters", "covarianceMatrix", "maneuverParameters",
/// "userDefinedParameters", "attitudeState", "observation"; "comment" for comments alone.
struct Record {
  std::string name;
  std::vector<Field> fields;
  std::size_t line = 0;
};

/// One segment of a message: its metadata, then its data.
struct Segment {
  std::vector<Field> metadata;
  std::vector<Record> data;
};

enum class Kind { Opm, Oem, Aem, Tdm };
enum class Form { Kvn, Xml };

/// A CCSDS navigation message as it was read, field by field.
struct Message {
  Kind kind = Kind::Oem;
  std::string version, file;
  std::vector<Field> header;
  std::vector<Segment> segments;
};

/// "OEM" and so on.
const char *to_text(Kind kind);

/// True if a text begins as one of these messages does; TLE and OMM do not.
bool is_message(std::string_view text);

/// BadInput, with line and keyword, for what is not of the form: keywords out of place, a missing
/// mandatory one, a data line with a wrong number of values, values that are no numbers. Keywords
/// of headers and metadata that are not known are kept. Document types are refused; nothing is
/// fetched.
Result<Message> read_message(std::string_view text, const std::string &file,
                             Diagnostics &diagnostics);

/// BadInput where the form cannot hold what the message has (units in the data lines of KVN).
Result<std::string> write_message(const Message &message, Form form);

/// The last field of a name; null where there is none.
const Field *find(const std::vector<Field> &fields, std::string_view key);

} // namespace umov::ccsds
