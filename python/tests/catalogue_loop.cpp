// The loop that python/tests/test_overhead.py holds the package against: catalogue_loop FILE FIRST
// COUNT. For every line that it reads it propagates all objects of FILE to COUNT minutes from FIRST
// on, on one thread, and prints the seconds by the clock and of the processor.
#include "timed_loop.h"

#include <cstdlib>
#include <umov/jobs/ephemeris.h>

namespace {

umov::Result<void> run(const std::string &file, const std::string &first, int count) {
  umov::jobs::JobOptions options;
  options.threads = 1;
  umov::jobs::StatesRequest request{file, {}, false};
  UMOV_ASSIGN(start, umov::utc_from_iso(first));
  for (int i = 0; i < count; ++i)
    request.times.push_back(umov::plus_seconds(start, 60.0 * i));
  time_each_line([&] {
    umov::Diagnostics warnings;
    return umov::jobs::propagate_catalogue(request, options, {}, warnings).value();
  });
  return {};
}

} // namespace

int main(int argc, char **argv) {
  return argc == 4 ? exit_code_of(run(argv[1], argv[2], std::atoi(argv[3]))) : 2;
}
