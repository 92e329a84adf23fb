#include <umov/scale/rows_file.h>

#include "scale/rows_form.h"

#include <map>
#include <umov/core/mapped_file.h>
#include <umov/core/text.h>

namespace umov::scale {
namespace {

using nlohmann::json;

template <class T> std::string_view bytes_of(const std::vector<T> &values) {
  return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T)};
}

/// Texts as numbers into those that differ, in order of first use.
struct Dictionary {
  std::vector<std::uint32_t> codes;
  std::vector<std::uint64_t> ends; ///< of each text in `bytes`
  std::string bytes;

  explicit Dictionary(const std::vector<std::string> &texts) {
    std::map<std::string_view, std::uint32_t> known;
    std::vector<std::string_view> words; // by number
    codes.reserve(texts.size());
    std::uint32_t last = 0;
    for (const std::string &text : texts) {
      // Bands take turns and objects follow each other: there is seldom anything to look for.
      if (const std::uint32_t next = last + 1 < words.size() ? last + 1 : 0;
          next < words.size() && words[next] == text) {
        last = next;
      } else if (last >= words.size() || words[last] != text) {
        const auto [at, is_new] = known.emplace(text, static_cast<std::uint32_t>(known.size()));
        if (is_new) {
          bytes += text;
          ends.push_back(bytes.size());
          words.push_back(text);
        }
        last = at->second;
      }
      codes.push_back(last);
    }
  }
};

json described(const Column &column) {
  return {{"name", column.name},
          {"unit", column.unit},
          {"description", column.description},
          {"type", cell_types[column.cells.index()]},
          {"precision",
           {column.precision.error, column.precision.decimals, column.precision.significant}}};
}

} // namespace

struct RowsWriter::State {
  FileInProgress file;
  json tables = json::array();
  RowsHead head;
  std::size_t at = 0;
  std::vector<std::size_t> tallies = {};

  Result<void> write(std::string_view bytes) {
    UMOV_TRY(file.write(bytes));
    at += bytes.size();
    return {};
  }
  /// Bytes at the next place that is aligned; where that was.
  Result<std::size_t> place(std::string_view bytes) {
    UMOV_TRY(write(std::string((rows_alignment - at % rows_alignment) % rows_alignment, '\0')));
    const std::size_t begin = at;
    UMOV_TRY(write(bytes));
    return begin;
  }
  Result<json> column(const Cells &cells) {
    if (const auto *numbers = std::get_if<std::vector<double>>(&cells)) {
      UMOV_ASSIGN(begin, place(bytes_of(*numbers)));
      return json{{"at", begin}};
    }
    if (const auto *counts = std::get_if<std::vector<std::int64_t>>(&cells)) {
      UMOV_ASSIGN(begin, place(bytes_of(*counts)));
      return json{{"at", begin}};
    }
    if (const auto *flags = std::get_if<std::vector<bool>>(&cells)) {
      UMOV_ASSIGN(begin, place(bytes_of(std::vector<char>(flags->begin(), flags->end()))));
      return json{{"at", begin}};
    }
    const Dictionary texts(std::get<std::vector<std::string>>(cells));
    UMOV_ASSIGN(begin, place(bytes_of(texts.codes)));
    UMOV_ASSIGN(ends, place(bytes_of(texts.ends)));
    UMOV_ASSIGN(words, place(texts.bytes));
    return json{{"at", begin}, {"ends", ends}, {"texts", texts.ends.size()}, {"words", words}};
  }
};

RowsWriter::RowsWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
RowsWriter::RowsWriter(RowsWriter &&) noexcept = default;
RowsWriter &RowsWriter::operator=(RowsWriter &&) noexcept = default;
RowsWriter::~RowsWriter() = default;

Result<RowsWriter> RowsWriter::open(const std::filesystem::path &path,
                                    std::vector<std::string> tables, RowsHead head) {
  UMOV_ASSIGN(file, FileInProgress::open(path));
  auto state = std::make_unique<State>(State{std::move(file), json::array(), std::move(head), 0});
  for (std::string &name : tables)
    state->tables.push_back({{"name", std::move(name)},
                             {"rows", 0},
                             {"notes", json::array()},
                             {"columns", json::array()},
                             {"blocks", json::array()}});
  UMOV_TRY(state->write(rows_magic));
  return RowsWriter(std::move(state));
}

Result<void> RowsWriter::add(std::size_t table, Table &&rows) {
  json &about = state_->tables.at(table);
  if (about["columns"].empty()) {
    for (const auto &[key, value] : rows.notes())
      about["notes"].push_back({key, value});
    for (const Column &column : rows.columns())
      about["columns"].push_back(described(column));
  }
  json columns = json::array();
  for (const Column &column : rows.columns()) {
    UMOV_ASSIGN(placed, state_->column(column.cells));
    columns.push_back(std::move(placed));
  }
  about["blocks"].push_back({{"rows", rows.rows()}, {"columns", std::move(columns)}});
  about["rows"] = about["rows"].get<std::size_t>() + rows.rows();
  return {};
}

void RowsWriter::tally(const std::vector<std::size_t> &counts) { state_->tallies = counts; }

Result<std::string> RowsWriter::finish() {
  const RowsHead &head = state_->head;
  json about{{"key", head.key},
             {"index", head.index},
             {"first", head.range.first},
             {"count", head.range.count},
             {"tables", state_->tables}};
  if (!state_->tallies.empty())
    about["tallies"] = state_->tallies;
  const std::string text = about.dump();
  UMOV_ASSIGN(begin, state_->place(text));
  UMOV_TRY(state_->write(bytes_of(std::vector<std::uint64_t>{begin, text.size()})));
  UMOV_TRY(state_->write(rows_magic));
  UMOV_ASSIGN(written, MappedFile::open(state_->file.temporary()));
  return sha256_hex(written.bytes());
}

Result<void> RowsWriter::commit_as(const std::filesystem::path &path) {
  return state_->file.commit_as(path);
}
std::size_t RowsWriter::rows() const { return state_->tables.at(0)["rows"].get<std::size_t>(); }
std::size_t RowsWriter::bytes() const { return state_->at; }

} // namespace umov::scale
