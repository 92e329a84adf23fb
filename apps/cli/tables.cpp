#include "tables.h"

#include <algorithm>
#include <filesystem>
#include <fmt/ranges.h>
#include <umov/io/table_sink.h>
#include <unistd.h>

namespace umov::cli {
namespace {

std::string wrong_suffix(const std::string &path) {
  return fmt::format("-o {}: a name that ends in {} was expected", path,
                     fmt::join(table_suffixes(), ", "));
}

} // namespace

const std::vector<std::string> &table_suffixes() {
  static const std::vector<std::string> suffixes{".csv", ".ecsv", ".fits", ".json"};
  return suffixes;
}

void add_table_output(CLI::App &verb, std::string &path) {
  verb.add_option(
      "-o,--output", path,
      fmt::format("Table, instead of stdout: {} by its suffix", fmt::join(table_suffixes(), ", ")));
}

void add_columns(CLI::App &verb, std::vector<std::string> &columns) {
  verb.add_option("-c,--columns", columns,
                  "Columns, separated by commas, or all; on a terminal a few without it")
      ->delimiter(',');
}

Result<Table> chosen_columns(const Table &table, const std::vector<std::string> &columns,
                             const std::vector<std::string> &few, const std::string &path,
                             const Common &common) {
  const bool is_shown = (path.empty() || path == "-") && !common.json;
  if (columns.size() == 1 && columns.front() == "all")
    return table;
  if (!columns.empty())
    return with_columns(table, columns);
  if (!is_shown || ::isatty(STDOUT_FILENO) == 0)
    return table;
  if (few.empty())
    return without_empty_columns(table);
  UMOV_ASSIGN(short_one, with_columns(table, few));
  note(common, fmt::format("{} of {} columns; -c all shows them all, -c NAME,NAME those",
                           few.size(), table.columns().size()));
  return without_empty_columns(short_one);
}

Result<void> put_table(const std::string &path, const Table &table, const Common &common) {
  if (path.empty() || path == "-")
    return put(path, common.json ? to_json(table) : to_text(table));
  return write_table(path, table);
}

Result<void> check_page(const char *option, const std::string &path) {
  if (path.empty() || path.ends_with(".html"))
    return {};
  return fail(ErrorCode::Usage,
              fmt::format("{} {}: a name that ends in .html was expected", option, path));
}

Result<void> check_output(const std::string &path) {
  if (path.empty() || path == "-")
    return {};
  namespace fs = std::filesystem;
  const fs::path target(path);
  const std::string suffix = target.extension().string();
  if (std::ranges::find(table_suffixes(), suffix) == table_suffixes().end())
    return fail(ErrorCode::Usage, wrong_suffix(path));
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (std::error_code code; !fs::is_directory(folder, code))
    return fail(ErrorCode::Device, "no such folder. Make the folder first or choose another one.",
                {folder.string()});
  if (std::error_code code; fs::is_directory(target, code))
    return fail(ErrorCode::Device, "this is a folder; the name of a file was expected", {path});
  return {};
}

Result<void> check_apart(const std::vector<std::string> &inputs,
                         const std::vector<std::string> &outputs) {
  namespace fs = std::filesystem;
  const auto place = [](const std::string &path) {
    std::error_code code;
    const fs::path out = fs::weakly_canonical(fs::absolute(path), code);
    return code ? fs::path(path) : out;
  };
  std::vector<fs::path> taken;
  for (const std::string &input : inputs)
    if (!input.empty())
      taken.push_back(place(input));
  const auto read = static_cast<std::ptrdiff_t>(taken.size());
  for (const std::string &output : outputs) {
    if (output.empty() || output == "-")
      continue;
    const auto first = std::ranges::find(taken, place(output)) - taken.begin();
    if (first < static_cast<std::ptrdiff_t>(taken.size()))
      return fail(ErrorCode::Usage, fmt::format("{} is {} already: another name was expected",
                                                output, first < read ? "read" : "written"));
    taken.push_back(place(output));
  }
  return {};
}

Result<void> check_folder_name(const std::string &path) {
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (std::ranges::find(table_suffixes(), suffix) == table_suffixes().end())
    return {};
  return fail(
      ErrorCode::Usage,
      fmt::format("-o {}: the name of a folder was expected, in which several files are put; "
                  "output.formats says in which forms",
                  path));
}

} // namespace umov::cli
