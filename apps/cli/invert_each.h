#pragma once
// --each of umov invert pose and umov identify: every file is a curve by itself.

#include "part_options.h"
#include "verb_invert.h"

#include <umov/jobs/invert_each.h>

namespace umov::cli {

/// What was given of it.
struct EachOptions {
  bool is_asked = false;
  PartOptions part;
};
/// The job of all curves.
using EachJob = std::function<Result<std::unique_ptr<jobs::RangedJob>>(
    const Scenario &, const InvertVerb &, const jobs::JobOptions &, const jobs::Monitor &,
    Diagnostics &)>;

/// Options of umov invert pose and of umov identify, and what --each makes of them.
EachJob pose_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o, EachOptions &each);
EachJob identify_options(CLI::App &verb, const std::shared_ptr<InvertVerb> &o,
                         const std::shared_ptr<jobs::IdentifyRequest> &asked, EachOptions &each);
/// Adds --each, --shard and --range.
void add_each(CLI::App &verb, EachOptions &each);
/// As run_invert; where --each was given, `many` for each of the files.
void run_invert_or_each(CLI::App &verb, const std::shared_ptr<InvertVerb> &o,
                        const std::shared_ptr<EachOptions> &each, const Exit &exit_with,
                        const InvertJob &one, const EachJob &many);

} // namespace umov::cli
