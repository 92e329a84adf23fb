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

} // namespace umov::cli
