#pragma once
// What the verbs below `umov invert` share: their options, and where their answers go.

#include "job_console.h"
#include "verbs.h"

#include <umov/jobs/invert.h>

namespace umov::cli {

/// Options of a verb below `umov invert`.
struct InvertVerb {
  jobs::InvertRequest request;
  std::string scenario, output, visibility = "auto";
  std::vector<std::string> overrides;
  bool is_intensity_only = false;
  Common common;
};
/// What a verb does with its options.
using InvertJob = std::function<Result<jobs::Inversion>(const Scenario &, const InvertVerb &,
                                                        const jobs::Monitor &, Diagnostics &)>;
/// Adds the options that all of them take.
void add_invert_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o);
/// Runs the job, writes its folder, prints its answer and ends with its exit code.
void run_invert(CLI::App &verb, const std::shared_ptr<InvertVerb> &o, const Exit &exit_with,
                const InvertJob &job);

} // namespace umov::cli
