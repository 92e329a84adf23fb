#include <umov/scale/rows_file.h>

#include "scale/rows_form.h"
#include "scale/whole_number.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <new>
#include <umov/core/mapped_file.h>
#include <umov/core/text.h>

namespace umov::scale {

/// How a file is laid out, as its foot tells it.
namespace rows {

/// Where the cells of a column of a block stand.
struct Place {
  std::size_t at = 0;
  std::size_t ends = 0, texts = 0, words = 0; ///< of text alone
};
struct Block {
  std::size_t rows = 0;
  std::vector<Place> columns;
};
struct AboutTable {
  std::vector<Column> columns; ///< without cells, but of their kind
  std::vector<std::pair<std::string, std::string>> notes;
  std::vector<Block> blocks;
  std::size_t rows = 0;
};

} // namespace rows

namespace {

using nlohmann::json;

using rows::AboutTable;
using rows::Block;
using rows::Place;

Cells no_cells(const std::string &type) {
  if (type == cell_types[0])
    return std::vector<double>{};
  if (type == cell_types[1])
    return std::vector<std::int64_t>{};
  if (type == cell_types[2])
    return std::vector<std::string>{};
  if (type == cell_types[3])
    return std::vector<bool>{};
  throw std::runtime_error("cells of type " + type);
}

template <class T> T read_at(std::string_view bytes, std::size_t at) {
  T out;
  std::memcpy(&out, bytes.data() + at, sizeof(T));
  return out;
}

/// `count` values of `size` bytes at `at` lie within the blocks.
void check_place(std::size_t at, std::size_t count, std::size_t size, std::size_t end) {
  if (at > end || count > (end - at) / size)
    throw std::runtime_error("cells beyond the end");
}

/// Powers of ten of a double, and its digits.
constexpr int most_decimals = 330, most_significant = 17;

AboutTable about_table(const json &from, std::size_t end) {
  AboutTable out;
  for (const json &note : list_at(from, "notes"))
    out.notes.emplace_back(note.at(0).get<std::string>(), note.at(1).get<std::string>());
  for (const json &one : list_at(from, "columns")) {
    const json &precision = one.at("precision");
    out.columns.push_back({one.at("name").get<std::string>(),
                           one.at("unit").get<std::string>(),
                           one.at("description").get<std::string>(),
                           no_cells(one.at("type").get<std::string>()),
                           {precision.at(0).get<std::string>(),
                            digits_of(precision.at(1), -most_decimals, most_decimals),
                            digits_of(precision.at(2), 0, most_significant)}});
  }
  constexpr std::array<std::size_t, 4> sizes{8, 8, 4, 1};
  for (const json &one : list_at(from, "blocks")) {
    Block block{whole_at(one, "rows"), {}};
    if (list_at(one, "columns").size() != out.columns.size())
      throw std::runtime_error("a block with other columns");
    for (std::size_t c = 0; c < out.columns.size(); ++c) {
      const json &column = one.at("columns").at(c);
      const std::size_t kind = out.columns[c].cells.index();
      Place place{whole_at(column, "at"), 0, 0, 0};
      check_place(place.at, block.rows, sizes.at(kind), end);
      if (kind == 2) {
        place.ends = whole_at(column, "ends");
        place.texts = whole_at(column, "texts");
        place.words = whole_at(column, "words");
        check_place(place.ends, place.texts, 8, end);
        check_place(place.words, 0, 1, end);
      }
      block.columns.push_back(place);
    }
    out.rows += block.rows;
    out.blocks.push_back(std::move(block));
  }
  return out;
}

} // namespace

struct RowsFile::State {
  MappedFile mapped;
  std::string_view bytes;
  std::string name;
  std::size_t end = 0; ///< of the blocks
  RowsHead head;
  std::vector<std::string> names;
  std::vector<AboutTable> tables;
  std::vector<std::size_t> tallies;

  void parse() {
    const std::size_t tail = bytes.size() - rows_tail;
    const auto begin = read_at<std::uint64_t>(bytes, tail);
    const auto length = read_at<std::uint64_t>(bytes, tail + 8);
    if (begin > tail || length != tail - begin)
      throw std::runtime_error("the end says where nothing stands");
    end = begin;
    const json all = json::parse(bytes.substr(begin, length));
    head = {all.at("key").get<std::string>(),
            whole_at(all, "index"),
            {whole_at(all, "first"), whole_at(all, "count")}};
    const json counts = all.value("tallies", json::array());
    for (const json &count : list_of(counts, "tallies"))
      tallies.push_back(whole_of(count, "tallies"));
    for (const json &table : list_at(all, "tables")) {
      names.push_back(table.at("name").get<std::string>());
      tables.push_back(about_table(table, end));
    }
  }
  /// Cells of one column of a block; false for a text that stands nowhere.
  bool fill(const Place &place, std::size_t rows, Cells &cells) const {
    const auto copy = [&](auto &values) {
      values.resize(rows);
      if (rows > 0)
        std::memcpy(values.data(), bytes.data() + place.at, rows * sizeof(values[0]));
    };
    if (auto *numbers = std::get_if<std::vector<double>>(&cells))
      copy(*numbers);
    else if (auto *counts = std::get_if<std::vector<std::int64_t>>(&cells))
      copy(*counts);
    else if (auto *flags = std::get_if<std::vector<bool>>(&cells))
      for (std::size_t i = 0; i < rows; ++i)
        flags->push_back(bytes[place.at + i] != 0);
    else
      return fill_texts(place, rows, std::get<std::vector<std::string>>(cells));
    return true;
  }
  /// Of those that stand within the file.
  [[nodiscard]] std::size_t longest_text(const Place &place) const {
    std::uint64_t longest = 0, from = 0;
    for (std::size_t text = 0; text < place.texts; ++text) {
      const auto to = read_at<std::uint64_t>(bytes, place.ends + 8 * text);
      if (from <= to && to <= end - place.words)
        longest = std::max(longest, to - from);
      from = to;
    }
    return longest;
  }
  bool fill_texts(const Place &place, std::size_t rows, std::vector<std::string> &out) const {
    const auto end_of = [&](std::size_t text) {
      return read_at<std::uint64_t>(bytes, place.ends + 8 * text);
    };
    for (std::size_t i = 0; i < rows; ++i) {
      const auto code = read_at<std::uint32_t>(bytes, place.at + 4 * i);
      if (code >= place.texts)
        return false;
      const std::uint64_t from = code > 0 ? end_of(code - 1) : 0, to = end_of(code);
      if (from > to || to > end - place.words)
        return false;
      out.emplace_back(bytes.substr(place.words + from, to - from));
    }
    return true;
  }
};

RowsFile::RowsFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
RowsFile::RowsFile(RowsFile &&) noexcept = default;
RowsFile &RowsFile::operator=(RowsFile &&) noexcept = default;
RowsFile::~RowsFile() = default;

Result<RowsFile> RowsFile::read(std::string_view bytes, const std::string &name) {
  const auto damaged = [&name](const std::string &what) {
    return fail(ErrorCode::BadInput,
                "is no whole file of rows: " + what + ". umov scale repair makes it anew.", {name});
  };
  if (bytes.size() < rows_magic.size() + rows_tail || !bytes.starts_with(rows_magic) ||
      !bytes.ends_with(rows_magic))
    return damaged("it does not begin and end as one");
  auto state = std::make_unique<State>();
  state->bytes = bytes;
  state->name = name;
  try {
    state->parse();
  } catch (const std::bad_alloc &) {
    throw; // of what is whole
  } catch (const std::exception &problem) {
    return damaged(problem.what());
  }
  return RowsFile(std::move(state));
}

Result<RowsFile> RowsFile::open(const std::filesystem::path &path) {
  UMOV_ASSIGN(mapped, MappedFile::open(path));
  UMOV_ASSIGN(out, read(mapped.bytes(), path.string()));
  out.state_->mapped = std::move(mapped);
  return std::move(out);
}

const std::vector<std::size_t> &RowsFile::tallies() const { return state_->tallies; }
const RowsHead &RowsFile::head() const { return state_->head; }
const std::vector<std::string> &RowsFile::tables() const { return state_->names; }
std::size_t RowsFile::blocks(std::size_t table) const {
  return state_->tables.at(table).blocks.size();
}
std::size_t RowsFile::rows(std::size_t table) const { return state_->tables.at(table).rows; }

std::vector<std::size_t> RowsFile::widths(std::size_t table) const {
  const AboutTable &about = state_->tables.at(table);
  std::vector<std::size_t> out(about.columns.size());
  for (const Block &block : about.blocks)
    for (std::size_t c = 0; c < out.size(); ++c)
      out[c] = std::max(out[c], state_->longest_text(block.columns[c]));
  return out;
}

Result<Table> RowsFile::block(std::size_t table, std::size_t number) const {
  const AboutTable &about = state_->tables.at(table);
  const Block &block = about.blocks.at(number);
  Table out;
  for (const auto &[key, value] : about.notes)
    out.note(key, value);
  for (std::size_t c = 0; c < about.columns.size(); ++c) {
    const Column &column = about.columns[c];
    Cells cells = column.cells;
    if (!state_->fill(block.columns[c], block.rows, cells))
      return fail(ErrorCode::BadInput,
                  fmt::format("column {} has a text that stands nowhere. umov scale repair makes "
                              "the file anew.",
                              column.name),
                  {state_->name});
    out.add(column.name, column.unit, column.description, std::move(cells));
    out.set_precision(column.name, column.precision);
  }
  return out;
}

std::string RowsFile::sha256() const { return sha256_hex(state_->bytes); }
std::size_t RowsFile::bytes() const { return state_->bytes.size(); }

} // namespace umov::scale
