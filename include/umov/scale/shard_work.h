#pragma once
// One shard after the other: the work of a process that made the job ready once.

#include <atomic>
#include <optional>
#include <string>
#include <umov/scale/job_folder.h>

namespace umov::scale {

/// What is told of a shard: at most a kilobyte, never its rows.
struct ShardRecord {
  /// How it ended.
  enum class Status {
    Done,
    There, ///< somebody else had done it
    Failed,
    Exhausted, ///< out of memory: the process ends, another one may try
    Refused    ///< the process cannot do any shard of the job
  };
  Status status = Status::Done;
  std::size_t index = 0;
  int code = 0; ///< of a failure, as an exit code
  std::string message, file, sha256;
  std::size_t rows = 0, bytes = 0;
  double seconds = 0, cpu_s = 0;
};

/// A line of JSON, and back; Internal for anything else.
std::string to_json(const ShardRecord &record);
Result<ShardRecord> record_from_json(const std::string &line);

/// Checks that the job is the one of the folder: BadInput naming the first difference.
Result<void> check_same_job(const JobFolder &folder, const jobs::RangedJob &job);

/// Does one shard; what goes wrong is in the record.
ShardRecord do_shard(const JobFolder &folder, jobs::RangedJob &job, std::size_t index,
                     const jobs::Monitor &monitor);

/// Holds this process to so many megabytes of its own; 0: nine tenths of what is here. A shard that
/// wants more is Exhausted, and neither the others nor the machine suffer.
void hold_to_memory(std::size_t megabytes);

/// Begins to listen to the standard input; true once it has ended, with the parent or at its will.
const std::atomic<bool> &parent_has_left();

/// Takes indices line by line from the standard input until its end, and prints a record for each:
/// the parent's death ends the process, whatever it is at, and so does a shard that is Exhausted.
Result<void> serve_shards(const JobFolder &folder, jobs::RangedJob &job);
/// What is printed instead where no shard can be done.
void refuse_shards(const Error &why);

} // namespace umov::scale
