#pragma once
// All shards as the table that the plain command would have written.

#include <umov/io/table_sink.h>
#include <umov/scale/job_folder.h>

namespace umov::scale {

/// Rows of one table of the job into `sink`, in the order of the plain command. Every file is
/// checked against its hash first. BadInput naming shards that are missing, damaged, or there twice
/// with unlike bytes.
Result<void> merge(const JobFolder &folder, const std::string &table, TableSink &sink,
                   const jobs::Monitor &monitor);

/// What the plain command ends with when its rows are written: BadInput where some have no answer
/// (JobLock::problems), else nothing.
Result<void> check_answers(const JobFolder &folder, const jobs::Monitor &monitor);

/// What is wrong with the files of a folder.
struct Verdict {
  std::size_t shards = 0, done = 0;
  std::vector<std::size_t> missing;
  std::vector<Shard> damaged, doubled;
  /// Every shard is there once, undamaged.
  [[nodiscard]] bool is_whole() const {
    return missing.empty() && damaged.empty() && doubled.empty();
  }
};
/// Reads all of them.
Result<Verdict> verify(const JobFolder &folder, const jobs::Monitor &monitor);
/// In words.
std::string describe(const Verdict &verdict, const JobFolder &folder);
/// Removes what is damaged, and all of what is there in several versions.
void remove_bad(const JobFolder &folder, const Verdict &verdict);

/// When every shard is there: all of them, in manifest.json, with the hash that its name has.
Result<void> write_manifest(const JobFolder &folder);

} // namespace umov::scale
