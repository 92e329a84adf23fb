#pragma once
// Private: the keywords of CCSDS messages, their records and the columns of their data lines.

#include <string>
#include <string_view>
#include <umov/io/ccsds.h>
#include <vector>

namespace umov::ccsds {

struct KindInfo {
  Kind kind;
  const char *name;    ///< "OEM"
  const char *element; ///< "oem"
};
const KindInfo &info_of(Kind kind);
const KindInfo *find_kind(std::string_view name);

bool is_header_key(std::string_view key);
/// Metadata that a kind must have.
const std::vector<std::string> &mandatory_metadata(Kind kind);
bool is_metadata_key(Kind kind, std::string_view key);

/// The record that a keyword of an OPM's data belongs to; "" if unknown.
std::string_view opm_record(std::string_view key);

/// True if a kind has records of this name.
bool is_record(Kind kind, std::string_view name);

/// "an OEM", "a TDM".
std::string with_article(std::string_view name);

/// Six state columns, then three accelerations where a line has them.
const std::vector<std::string> &state_columns();
/// Lower triangle, row by row: CX_X, CY_X, CY_Y, ...
const std::vector<std::string> &covariance_keys();

/// How one type of attitude stands in a data line and in XML.
struct AttitudeForm {
  const char *type;    ///< ATTITUDE_TYPE
  const char *element; ///< of XML, below attitudeState
  struct Group {
    const char *element; ///< "" for fields beside the epoch
    std::vector<std::string> keys;
  };
  std::vector<Group> groups;
};
/// By ATTITUDE_TYPE; null if unknown.
const AttitudeForm *attitude_form(std::string_view type);
/// The columns after the epoch; QC stands first where the metadata say QUATERNION_TYPE = FIRST.
std::vector<std::string> attitude_columns(const AttitudeForm &form, const Segment &segment);

/// What a field of a data line is in where nothing is said; "" for no unit.
std::string_view standard_unit(std::string_view key);
/// True where KVN has the field in a data line, which has no room for a unit.
bool is_in_data_line(Kind kind, std::string_view record);

/// The field that a writer needs; BadInput where the message was put together without it.
Result<const Field *> needed_field(const Message &message, const Record &record,
                                   std::string_view key);
Result<const AttitudeForm *> needed_form(const Message &message, const Segment &segment);

/// Checks that hold for every form: records and keywords that are known, mandatory ones, numbers
/// where numbers belong, duplicates.
Result<void> check_message(const Message &message, Diagnostics &diagnostics);

Result<Message> read_kvn(std::string_view text, const std::string &file);
Result<Message> read_xml(std::string_view text, const std::string &file);
Result<std::string> write_kvn(const Message &message);
Result<std::string> write_xml(const Message &message);

} // namespace umov::ccsds
