#include "doubtful_elements.h"

namespace umov::cli {

void add_elements(CLI::App &verb, DoubtfulElements &elements) {
  verb.add_flag("--allow-bad-checksum", elements.allow_bad_checksum,
                "Read elements with a wrong checksum");
  verb.add_flag("--allow-old-elements", elements.allow_old_elements,
                "Take elements over 30 days old");
}

jobs::JobOptions with_elements(jobs::JobOptions options, const DoubtfulElements &elements) {
  options.allow_bad_checksum = elements.allow_bad_checksum;
  options.allow_old_elements = elements.allow_old_elements;
  return options;
}

} // namespace umov::cli
