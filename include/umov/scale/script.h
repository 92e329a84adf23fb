#pragma once
// Array jobs of batch systems, as scripts to read and change.

#include <umov/scale/plan.h>

namespace umov::scale {

/// What the script asks the batch system for.
struct ScriptSettings {
  std::string program;   ///< umov
  std::size_t tasks = 1; ///< of the array: each takes its share of the shards
  std::size_t threads = 1;
  std::size_t memory_mb = 2000; ///< of each task
  double wall_s = 3600;         ///< of each task
  std::string partition;        ///< "": the default one
};

/// For sbatch.
std::string slurm_script(const JobFolder &folder, const ScriptSettings &settings);
/// For condor_submit.
std::string condor_script(const JobFolder &folder, const ScriptSettings &settings);

} // namespace umov::scale
