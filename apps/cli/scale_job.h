#pragma once
// Verbs as jobs in parts.

#include "part_options.h"

#include <umov/jobs/ranged_job.h>

namespace umov::cli {

/// With what a job in parts is made ready.
struct PartsSetting {
  jobs::JobOptions options;
  std::vector<std::size_t> layout; ///< RangedJob::layout, where it is known
  jobs::Monitor monitor = {};
  std::vector<std::string> reductions = {}; ///< umov/scale/reduction.h
};

/// A verb's job, and the name of a file that its rows depend on besides; "" for none.
struct RangedVerb {
  std::unique_ptr<jobs::RangedJob> job;
  std::string file;
};

/// Arguments as the command line has them; Usage for what the verb does not know.
Result<void> parse_verb(CLI::App &verb, const std::vector<std::string> &arguments);
/// Rows go to the shards: Usage for an output or a part of its own.
Result<void> refuse_output(const std::string &output, const PartOptions &part);

Result<RangedVerb> identify_in_parts(const std::vector<std::string> &arguments,
                                     const PartsSetting &setting, Diagnostics &diagnostics);
Result<RangedVerb> invert_in_parts(const std::vector<std::string> &arguments,
                                   const PartsSetting &setting, Diagnostics &diagnostics);
Result<RangedVerb> observe_in_parts(const std::vector<std::string> &arguments,
                                    const PartsSetting &setting, Diagnostics &diagnostics);
Result<RangedVerb> passes_in_parts(const std::vector<std::string> &arguments,
                                   const PartsSetting &setting, Diagnostics &diagnostics);
Result<RangedVerb> run_in_parts(const std::vector<std::string> &arguments,
                                const PartsSetting &setting, Diagnostics &diagnostics);
Result<RangedVerb> signature_in_parts(const std::vector<std::string> &arguments,
                                      const PartsSetting &setting, Diagnostics &diagnostics);

/// The job of a verb by its name; Usage for a verb without an index.
Result<std::unique_ptr<jobs::RangedJob>> verb_in_parts(const std::string &verb,
                                                       const std::vector<std::string> &arguments,
                                                       const PartsSetting &setting,
                                                       Diagnostics &diagnostics);

} // namespace umov::cli
