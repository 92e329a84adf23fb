#include "tables.h"

#include <filesystem>

namespace umov::cli {

Result<void> put_table(const std::string &path, const Table &table, const Common &common) {
  if (path.empty() || path == "-")
    return put(path, common.json ? to_json(table) : to_text(table));
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (suffix == ".csv")
    return put(path, to_csv(table));
  if (suffix == ".ecsv")
    return put(path, to_ecsv(table));
  if (suffix == ".json")
    return put(path, to_json(table));
  return fail(ErrorCode::Usage,
              "-o " + path + ": a name that ends in .csv, .ecsv or .json was expected");
}

Error put_partial_table(const std::string &path, Table table, const Common &common,
                        const Error &stopped) {
  namespace fs = std::filesystem;
  fs::path target = path;
  std::error_code code;
  const bool is_file = !path.empty() && path != "-";
  if (is_file && fs::exists(target, code))
    target.replace_extension(".partial" + target.extension().string());
  table.note("status", "stopped early: " + stopped.message);
  if (const auto done = put_table(target.string(), table, common); !done)
    return done.error();
  Error out = stopped;
  out.message += is_file ? "; the finished rows are in " + target.string()
                         : std::string("; the finished rows were printed");
  return out;
}

} // namespace umov::cli
