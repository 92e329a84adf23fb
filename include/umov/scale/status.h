#pragma once
// How far a job in parts is.

#include <umov/scale/job_folder.h>

namespace umov::scale {

/// What is done of a job, what failed and who is at it.
struct JobStatus {
  std::size_t shards = 0, done = 0, total = 0;
  std::string unit;      ///< of `total`
  std::size_t bytes = 0; ///< of the shards that are done
  std::vector<FailedShard> failed;
  std::string holders; ///< lease_holders
};

/// That of a folder, as it is now.
Result<JobStatus> status_of(const JobFolder &folder);
/// For a person, a line for each shard that failed; and as JSON.
std::string describe(const JobStatus &status);
std::string to_json(const JobStatus &status);

} // namespace umov::scale
