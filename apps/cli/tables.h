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

/// The rows of a stopped run go to "NAME.partial.csv", so that they are never taken for all; the
/// header says so too. No row, no file. The error that the verb ends with: `stopped`, and
/// where the rows are.
Error put_partial_table(const std::string &path, Table table, const Common &common,
                        const Error &stopped);

} // namespace umov::cli
