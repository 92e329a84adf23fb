#pragma once
#include "console.h"
#include <umov/io/table.h>

namespace umov::cli {

/// Writes a table: by the suffix of `path` (.csv, .ecsv, .json); to stdout as text, or JSON with
/// --json. Another suffix is a usage error.
Result<void> put_table(const std::string &path, const Table &table, const Common &common);

} // namespace umov::cli
