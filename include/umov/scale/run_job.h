#pragma once
// The missing shards of a job, by worker processes of this machine.

#include <functional>
#include <umov/scale/job_folder.h>
#include <umov/scale/shard_work.h>

namespace umov::scale {

/// How.
struct RunSettings {
  std::string program;     ///< umov itself, which is started as "umov scale worker FOLDER"
  std::size_t workers = 1; ///< processes
  std::size_t threads = 0; ///< of each; 0: all cores, shared among them
  jobs::JobPart part;      ///< of the shards
  bool joins = false;      ///< beside others that are at work in the folder
  double timeout_s = 0;    ///< of a shard; 0: ten times what is predicted, at least a minute
  /// Of each process; 0: its share of nine tenths of what is here.
  std::size_t memory_mb = 0;
};

/// What came of it.
struct RunTally {
  std::size_t wanted = 0;       ///< shards of the part
  std::size_t there_before = 0; ///< of them
  std::size_t done = 0, failed = 0;
  std::size_t by_others = 0; ///< of those done: others had them when it came to them
  double cpu_s = 0;
  std::vector<FailedShard> failures;
};

/// Does what is missing. A shard that ends its process or runs out of memory is tried three times,
/// one that hangs twice; what is wrong with its input is wrong for good and told; a full disk ends
/// it all (Device), and so do ten attempts one after the other without memory before a shard is
/// done. Interrupted after a stop, when the shards in hand are done or half a minute is
/// over.
Result<RunTally> run_job(const JobFolder &folder, const RunSettings &settings,
                         const jobs::Monitor &monitor);

} // namespace umov::scale
