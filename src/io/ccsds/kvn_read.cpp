// KEYWORD = VALUE [unit], metadata between META_START and META_STOP, data lines.

#include "io/ccsds/keywords.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <umov/core/text.h>
#include <utility>

namespace umov::ccsds {
namespace {

/// "51.6 [deg]" as value and unit.
Field field_of(std::string key, std::string_view text, std::size_t line) {
  text = trimmed(text);
  Field out{std::move(key), std::string(text), "", line};
  const std::size_t open = text.rfind('[');
  if (open != std::string_view::npos && text.ends_with(']') && open > 0 &&
      parse_number(trimmed(text.substr(0, open)))) {
    out.text = trimmed(text.substr(0, open));
    out.unit = text.substr(open + 1, text.size() - open - 2);
  }
  return out;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos)
      return out;
    line.remove_prefix(begin);
    const std::size_t end = line.find_first_of(" \t");
    out.push_back(line.substr(0, end));
    if (end == std::string_view::npos)
      return out;
    line.remove_prefix(end);
  }
}

enum class Place { Header, Metadata, Data, Covariance };

/// Lines that open and close the parts of a segment, and where each may stand. A lost or doubled
/// one would put what follows into a part that is not there.
struct Mark {
  const char *key;
  std::vector<Place> after; ///< the parts that it may end
  Place next;
  const char *expected;
};

const Mark *find_mark(std::string_view key) {
  static const std::vector<Mark> all{
      {"META_START",
       {Place::Header, Place::Data},
       Place::Metadata,
       "the META_STOP or COVARIANCE_STOP of what stands before"},
      {"META_STOP", {Place::Metadata}, Place::Data, "META_START"},
      {"DATA_START", {Place::Data}, Place::Data, "META_START and META_STOP"},
      {"DATA_STOP", {Place::Data}, Place::Data, "META_START and META_STOP"},
      {"COVARIANCE_START", {Place::Data}, Place::Covariance, "META_START and META_STOP"},
      {"COVARIANCE_STOP", {Place::Covariance}, Place::Data, "COVARIANCE_START"}};
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Mark &mark) { return key == mark.key; });
  return found == all.end() ? nullptr : &*found;
}

class KvnReader {
public:
  explicit KvnReader(const std::string &file) { out_.file = file; }

  Result<Message> read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.find_first_of("\r\n");
      const std::string_view line = trimmed(text.substr(0, end));
      const bool is_pair = end != std::string_view::npos && text.substr(end).starts_with("\r\n");
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + (is_pair ? 2 : 1));
      ++line_;
      if (!line.empty())
        UMOV_TRY(take(line));
    }
    if (!has_kind_)
      return fail(ErrorCode::BadInput, "holds no CCSDS message", {out_.file});
    if (place_ == Place::Covariance)
      return refuse("COVARIANCE_START has no COVARIANCE_STOP");
    if (place_ == Place::Metadata && out_.kind != Kind::Opm)
      return refuse("META_START has no META_STOP");
    end_record();
    put_comments_alone();
    return std::move(out_);
  }

private:
  [[nodiscard]] tl::unexpected<Error> refuse(const std::string &message) const {
    return fail(ErrorCode::BadInput, message, {out_.file, line_});
  }

  Result<void> take(std::string_view line) {
    if (line.starts_with("COMMENT"))
      return take_comment(line.substr(7));
    const std::size_t equals = line.find('=');
    const std::string key(trimmed(line.substr(0, equals)));
    if (!has_kind_)
      return take_version(key, equals == std::string_view::npos ? "" : line.substr(equals + 1));
    if (const Mark *mark = find_mark(key))
      return take_mark(*mark);
    if (place_ == Place::Covariance)
      return equals == std::string_view::npos ? take_covariance_row(line)
                                              : take_covariance_key(key, line.substr(equals + 1));
    if (equals == std::string_view::npos) {
      if (place_ == Place::Data && (out_.kind == Kind::Oem || out_.kind == Kind::Aem))
        return take_data_line(line);
      return refuse(
          fmt::format("\"{}\" has no '='; KEYWORD = VALUE was expected", line.substr(0, 60)));
    }
    return take_field(field_of(key, line.substr(equals + 1), line_));
  }

  Result<void> take_version(const std::string &key, std::string_view value) {
    const KindInfo *info = key.starts_with("CCSDS_") && key.ends_with("_VERS")
                               ? find_kind(std::string_view(key).substr(6, key.size() - 11))
                               : nullptr;
    if (info == nullptr)
      return refuse(fmt::format("\"{}\" was found, CCSDS_OPM_VERS, CCSDS_OEM_VERS, CCSDS_AEM_VERS "
                                "or CCSDS_TDM_VERS was expected first",
                                key.substr(0, 60)));
    out_.kind = info->kind;
    out_.version = trimmed(value);
    has_kind_ = true;
    return {};
  }

  Result<void> take_mark(const Mark &mark) {
    const std::string_view key = mark.key;
    if (std::find(mark.after.begin(), mark.after.end(), place_) == mark.after.end())
      return refuse(fmt::format("{} was found, {} was expected before it. Put the missing line in, "
                                "or remove this one.",
                                key, mark.expected));
    if (key == "COVARIANCE_START" && out_.kind != Kind::Oem)
      return refuse(fmt::format("COVARIANCE_START was found; only an OEM has such a block, this is "
                                "{}. Remove the block.",
                                with_article(to_text(out_.kind))));
    end_record();
    if (key == "META_START" || key == "DATA_STOP")
      put_comments_alone();
    if (key == "META_START")
      out_.segments.emplace_back();
    place_ = mark.next;
    return {};
  }

  Result<void> take_comment(std::string_view text) {
    Field field{"COMMENT", std::string(trimmed(text)), "", line_};
    if (place_ == Place::Header)
      out_.header.push_back(std::move(field));
    else if (place_ == Place::Metadata)
      out_.segments.back().metadata.push_back(std::move(field));
    else {
      end_record();
      comments_.push_back(std::move(field));
    }
    return {};
  }

  Result<void> take_field(Field field) {
    if (place_ == Place::Header) {
      if (is_header_key(field.key) || out_.kind != Kind::Opm) {
        out_.header.push_back(std::move(field));
        return {};
      }
      // An OPM may leave META_START out: its metadata follow the header.
      out_.segments.emplace_back();
      place_ = Place::Metadata;
    }
    if (place_ == Place::Metadata) {
      if (out_.kind != Kind::Opm || is_metadata_key(Kind::Opm, field.key)) {
        out_.segments.back().metadata.push_back(std::move(field));
        return {};
      }
      place_ = Place::Data;
      // Comments that came after the metadata belong to the data.
      auto &metadata = out_.segments.back().metadata;
      std::size_t keep = metadata.size();
      while (keep > 0 && metadata[keep - 1].key == "COMMENT")
        --keep;
      comments_.assign(metadata.begin() + static_cast<std::ptrdiff_t>(keep), metadata.end());
      metadata.resize(keep);
    }
    if (out_.segments.empty())
      return refuse(field.key + " stands before META_START");
    if (out_.kind == Kind::Tdm)
      return take_observation(std::move(field));
    if (out_.kind != Kind::Opm)
      return refuse(field.key + " stands among the data lines, where none was expected");
    std::string name(opm_record(field.key));
    if (name.empty())
      return refuse(fmt::format("\"{}\" is no keyword of an OPM's data", field.key.substr(0, 60)));
    if (!record_ || record_->name != name || field.key == "MAN_EPOCH_IGNITION")
      begin_record(std::move(name));
    record_->fields.push_back(std::move(field));
    return {};
  }

  Result<void> take_observation(Field field) {
    const auto parts = words(field.text);
    if (parts.size() < 2)
      return refuse(fmt::format("{} = {}: an epoch and a value were expected", field.key,
                                field.text.substr(0, 60)));
    begin_record("observation");
    record_->fields.push_back({"EPOCH", std::string(parts[0]), "", line_});
    const std::size_t value = static_cast<std::size_t>(parts[1].data() - field.text.data());
    record_->fields.push_back({field.key, field.text.substr(value), field.unit, line_});
    end_record();
    return {};
  }

  Result<void> take_data_line(std::string_view line) {
    const auto parts = words(line);
    Segment &segment = out_.segments.back();
    std::vector<std::string> columns = state_columns();
    if (out_.kind == Kind::Aem) {
      const Field *type = find(segment.metadata, "ATTITUDE_TYPE");
      const AttitudeForm *form = type == nullptr ? nullptr : attitude_form(type->text);
      if (form == nullptr)
        return refuse(type == nullptr
                          ? std::string("a data line, but no ATTITUDE_TYPE in the metadata")
                          : fmt::format("a data line, but ATTITUDE_TYPE is \"{}\", which is not "
                                        "known; QUATERNION or SPIN was expected",
                                        printable(type->text)));
      columns = attitude_columns(*form, segment);
    } else if (parts.size() == 7) {
      columns.resize(6);
    }
    if (parts.size() != columns.size() + 1)
      return refuse(fmt::format(
          "a data line has {}, expected an epoch and {}", counted(parts.size(), "entry", "entries"),
          out_.kind == Kind::Oem ? "6 or 9 numbers" : counted(columns.size(), "number")));
    begin_record(out_.kind == Kind::Aem ? "attitudeState" : "stateVector");
    record_->fields.push_back({"EPOCH", std::string(parts[0]), "", line_});
    for (std::size_t k = 0; k < columns.size(); ++k)
      record_->fields.push_back({columns[k], std::string(parts[k + 1]), "", line_});
    end_record();
    return {};
  }

  Result<void> take_covariance_key(const std::string &key, std::string_view value) {
    if (key == "EPOCH")
      begin_record("covarianceMatrix");
    else if (key != "COV_REF_FRAME")
      return refuse(fmt::format("\"{}\" was found in a block of covariances; EPOCH, COV_REF_FRAME "
                                "and rows of numbers were expected",
                                key.substr(0, 60)));
    else if (!record_)
      return refuse("COV_REF_FRAME stands before the EPOCH of a covariance matrix");
    record_->fields.push_back(field_of(key, value, line_));
    return {};
  }

  Result<void> take_covariance_row(std::string_view line) {
    if (!record_)
      return refuse("a row of a covariance matrix stands before its EPOCH");
    const auto parts = words(line);
    const auto &keys = covariance_keys();
    auto have = static_cast<std::size_t>(
        std::count_if(record_->fields.begin(), record_->fields.end(), [&](const Field &field) {
          return std::find(keys.begin(), keys.end(), field.key) != keys.end();
        }));
    std::size_t row = 0;
    while ((row + 1) * (row + 2) / 2 <= have)
      ++row;
    if (have == keys.size())
      return refuse("a covariance matrix has more than 6 rows; EPOCH of the next one or "
                    "COVARIANCE_STOP was expected");
    if (parts.size() != row + 1)
      return refuse(fmt::format("row {} of a covariance matrix has {}, expected {}", row + 1,
                                counted(parts.size(), "number"), row + 1));
    for (const std::string_view part : parts)
      record_->fields.push_back({keys[have++], std::string(part), "", line_});
    return {};
  }

  void begin_record(std::string name) {
    end_record();
    record_ = Record{std::move(name), std::exchange(comments_, {}), line_};
  }
  void end_record() {
    if (record_)
      out_.segments.back().data.push_back(std::move(*record_));
    record_.reset();
  }
  void put_comments_alone() {
    if (!comments_.empty() && !out_.segments.empty())
      out_.segments.back().data.push_back({"comment", std::exchange(comments_, {}), line_});
  }

  Message out_;
  Place place_ = Place::Header;
  bool has_kind_ = false;
  std::size_t line_ = 0;
  std::optional<Record> record_;
  std::vector<Field> comments_; ///< of the record to come
};

} // namespace

Result<Message> read_kvn(std::string_view text, const std::string &file) {
  return KvnReader(file).read(text);
}

} // namespace umov::ccsds
