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

/// -c of a verb whose table is wide: columns by name, or all.
void add_columns(CLI::App &verb, std::vector<std::string> &columns);
/// The columns asked for; without -c those of `few` (all if it is empty) where a terminal shows
/// them, empty ones left out, and all elsewhere.
Result<Table> chosen_columns(const Table &table, const std::vector<std::string> &columns,
                             const std::vector<std::string> &few, const std::string &path,
                             const Common &common);

/// Writes a table: by the suffix of `path`; to stdout as text, or JSON with
/// --json. Another suffix is a usage error.
Result<void> put_table(const std::string &path, const Table &table, const Common &common);

/// Refuses (Usage, Device) before any work what `put_table` would refuse after it.
Result<void> check_output(const std::string &path);
/// Usage for a page (x.html) whose name says another form; `option` names it.
Result<void> check_page(const char *option, const std::string &path);
/// Usage where an output is an input, or two outputs are one file; empty names and "-" are none.
Result<void> check_apart(const std::vector<std::string> &inputs,
                         const std::vector<std::string> &outputs);
/// An error that names no file, with the one that the user gave.
template <class T> Result<T> of_file(Result<T> done, const std::string &file) {
  if (!done && done.error().where.file.empty())
    done.error().where.file = file;
  return done;
}
/// The name of an output folder: Usage for that of a table.
Result<void> check_folder_name(const std::string &path);

} // namespace umov::cli
