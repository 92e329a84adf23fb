// The loop that python/tests/test_overhead.py holds the package against: catalogue_loop FILE FIRST
// COUNT. For every line that it reads it propagates all objects of FILE to COUNT minutes from FIRST
// on, on one thread, and prints the seconds by the clock and of the processor.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <umov/jobs/ephemeris.h>

namespace {

umov::Result<void> run(const std::string &file, const std::string &first, int count) {
  umov::jobs::JobOptions options;
  options.threads = 1;
  umov::jobs::StatesRequest request{file, {}, false};
  UMOV_ASSIGN(start, umov::utc_from_iso(first));
  for (int i = 0; i < count; ++i)
    request.times.push_back(umov::plus_seconds(start, 60.0 * i));
  for (std::string line; std::getline(std::cin, line);) {
    umov::Diagnostics warnings;
    const std::clock_t begin_cpu = std::clock();
    const auto begin = std::chrono::steady_clock::now();
    // A caller keeps the results of each call.
    [[maybe_unused]] const auto states =
        umov::jobs::propagate_catalogue(request, options, {}, warnings).value();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    const double processor = static_cast<double>(std::clock() - begin_cpu) / CLOCKS_PER_SEC;
    std::printf("%.9f %.9f\n", spent.count(), processor);
    std::fflush(stdout);
  }
  return {};
}

} // namespace

int main(int argc, char **argv) {
  if (argc != 4)
    return 2;
  const auto done = run(argv[1], argv[2], std::atoi(argv[3]));
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : 1;
}
