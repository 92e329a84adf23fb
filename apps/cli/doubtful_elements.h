#pragma once
// Orbital elements that are taken although something is wrong with them.

#include "console.h"

#include <umov/jobs/requests.h>

namespace umov::cli {

/// What may be wrong.
struct DoubtfulElements {
  bool allow_bad_checksum = false, allow_old_elements = false;
};

/// --allow-bad-checksum and --allow-old-elements.
void add_elements(CLI::App &verb, DoubtfulElements &elements);
/// `options` with them.
jobs::JobOptions with_elements(jobs::JobOptions options, const DoubtfulElements &elements);

} // namespace umov::cli
