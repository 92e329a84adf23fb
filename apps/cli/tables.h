#pragma once
#include "console.h"
#include <umov/io/table.h>

namespace umov::cli {

/// Writes a table: by the suffix of `path` (.csv, .ecsv, .json); to stdout as text, or JSON with
/// --json. Another suffix is a usage error.
Result<void> put_table(const std::string &path, const Table &table, const Common &common);

/// The rows of a stopped run: the header says so, and an existing file of that name stays as it is
/// (the rows then go to "NAME.partial.csv"). The error that the verb ends with: `stopped`, and
/// where the rows are.
Error put_partial_table(const std::string &path, Table table, const Common &common,
                        const Error &stopped);

} // namespace umov::cli
