#pragma once
// --shard and --range: a part of a job.

#include "console.h"

#include <umov/jobs/index_range.h>

namespace umov::cli {

/// What was given of them.
struct PartOptions {
  std::string shard, range;
};

/// Adds both; `unit`: what is counted.
void add_part(CLI::App &verb, PartOptions &part, const std::string &unit);
/// The part; Usage for what is none.
Result<jobs::JobPart> part_of(const PartOptions &part);

} // namespace umov::cli
