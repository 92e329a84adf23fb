#include "tables.h"

#include <algorithm>
#include <filesystem>
#include <fmt/ranges.h>
#include <umov/io/table_sink.h>

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

Result<void> put_table(const std::string &path, const Table &table, const Common &common) {
  if (path.empty() || path == "-")
    return put(path, common.json ? to_json(table) : to_text(table));
  return write_table(path, table);
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

} // namespace umov::cli
