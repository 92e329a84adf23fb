#pragma once
#include "console.h"
#include <umov/io/table.h>

namespace umov::cli {

/// Writes a table: by the suffix of `path` (.csv, .ecsv, .json); to stdout as text, or JSON with
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
