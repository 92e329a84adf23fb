#pragma once
// What a job will cost, before it begins.

#include <functional>
#include <umov/scale/job_folder.h>

namespace umov::scale {

/// What is known of a job and of what will do it.
struct PlanSettings {
  std::size_t cores = 1;     ///< that will be at work
  std::size_t threads = 1;   ///< of each worker
  std::size_t per_shard = 0; ///< 0: as long as shards should be
};

/// What it comes to.
struct Plan {
  std::size_t shards = 0, per_shard = 0, total = 0;
  double core_hours = 0, gigabytes = 0, wall_s = 0, shard_s = 0, setup_cpu_s = 0, once_cpu_s = 0;
};

/// Asks the job for some of its indices, spread over all of them, until their cost has settled: a
/// second or two of one core, up to twenty where indices are dear, and of a job of few dear ones
/// about a quarter, or one. What is learnt meanwhile, masks, is told apart from what every index
/// costs: pieces are asked for twice as long as that is cheaper.
Result<Rate> measure(jobs::RangedJob &job, double setup_cpu_s, const jobs::Monitor &monitor);

/// How long a shard is: a twentieth of the wall time, within 10 and 120 s of a worker; at most a
/// gigabyte; a multiple of the job's grain.
std::size_t shard_length(const jobs::RangedJob &job, const Rate &rate,
                         const PlanSettings &settings);

/// What a locked job costs on so many cores.
Plan plan_of(const JobLock &lock, const PlanSettings &settings);
/// In one line, and as JSON.
std::string describe(const Plan &plan, const std::string &unit);
std::string to_json(const Plan &plan);

} // namespace umov::scale
