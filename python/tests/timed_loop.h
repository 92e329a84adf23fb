#pragma once
// What pose_loop and catalogue_loop share: for every line that comes in, the work is done once.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <string>

/// Prints the seconds of each turn by the clock and of the processor. `work` returns what it made,
/// which goes after the clocks were read: a caller keeps the results of each call.
template <class Work> void time_each_line(const Work &work) {
  for (std::string line; std::getline(std::cin, line);) {
    const std::clock_t begin_cpu = std::clock();
    const auto begin = std::chrono::steady_clock::now();
    [[maybe_unused]] const auto made = work();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    const double processor = static_cast<double>(std::clock() - begin_cpu) / CLOCKS_PER_SEC;
    std::printf("%.9f %.9f\n", spent.count(), processor);
    std::fflush(stdout);
  }
}

/// The end of a program whose work is a Result.
template <class Done> int exit_code_of(const Done &done) {
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : 1;
}
