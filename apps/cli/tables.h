#pragma once
#include "console.h"
#include <string>
#include <umov/io/table.h>
#include <vector>

namespace umov::cli {

/// Of the files that hold tables.
const std::vector<std::string> &table_suffixes();
/// -o of a verb that prints a table.
void add_table_output(CLI::App &verb, std::string &path);

/// Writes a table: by the suffix of `path`; to stdout as text, or JSON with
/// --json. Another suffix is a usage error.
Result<void> put_table(const std::string &path, const Table &table, const Common &common);

/// Refuses (Usage, Device) before any work what `put_table` would refuse after it.
Result<void> check_output(const std::string &path);

} // namespace umov::cli
