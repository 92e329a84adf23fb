#pragma once
// Private: what the folders of all jobs have in common.

#include <umov/core/diagnostics.h>
#include <umov/io/run_folder.h>
#include <umov/io/scenario.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// `format` is among the scenario's.
bool wants(const Scenario &scenario, const char *format);
/// A table as NAME.ecsv, NAME.csv and NAME.fits, as the scenario asks; names of the files.
Result<std::vector<std::string>> add_table(const Table &table, const std::string &name,
                                           const Scenario &scenario, RunFolder &folder);
/// Warnings as lines of a log.
std::string warning_lines(const Diagnostics &diagnostics);
/// Their words without the places of files.
std::vector<std::string> messages_of(const Diagnostics &diagnostics);
/// These words in a table's header, as the note_warnings of tallies.h has them.
void note_warnings(Table &table, const Diagnostics &diagnostics);
/// Locked scenario, log and manifest, with the files that were read (and copies of them where the
/// scenario keeps them), the seed and the warnings.
Result<void> add_records(const Scenario &scenario, const std::string &options_needed,
                         std::string log, const std::vector<InputFile> &inputs,
                         const Diagnostics &diagnostics, ManifestInput manifest, RunFolder &folder);

} // namespace umov::jobs
