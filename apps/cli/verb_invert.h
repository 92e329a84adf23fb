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
  std::vector<std::string>
      own_keys; ///< the same of options that stand for keys: they go over those
  [[nodiscard]] std::vector<std::string> keys() const {
    std::vector<std::string> out = overrides;
    out.insert(out.end(), own_keys.begin(), own_keys.end());
    return out;
  }
  bool is_intensity_only = false;
  Common common;
};
/// What a verb does with its options.
using InvertJob = std::function<Result<jobs::Inversion>(const Scenario &, const InvertVerb &,
                                                        const jobs::Monitor &, Diagnostics &)>;
/// Adds the options of all that observations are given to, and how the model is known.
void add_observations(CLI::App &verb, const std::shared_ptr<InvertVerb> &o);
/// The same, and those of a search.
void add_invert_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o);
/// Adds those of them that say how well the model is known and where the answer goes.
void add_model_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o);
/// Adds those that say how well materials are known.
void add_material_sds(CLI::App &verb, const std::shared_ptr<InvertVerb> &o);
/// The same, and how wrong a model may turn out where attitudes are searched.
void add_material_errors(CLI::App &verb, const std::shared_ptr<InvertVerb> &o);
/// Puts options that are words into the request.
void settle(InvertVerb &o);
/// What run_invert does when the verb is called.
void answer_one(InvertVerb &o, const Exit &exit_with, const InvertJob &job);
/// Runs the job, writes its folder, prints its answer and ends with its exit code.
void run_invert(CLI::App &verb, const std::shared_ptr<InvertVerb> &o, const Exit &exit_with,
                const InvertJob &job);
/// umov invert plan.
void add_invert_plan(CLI::App &invert, const Exit &exit_with);

} // namespace umov::cli
