#pragma once
// Private: clock and machine of a measurement.

#include <chrono>
#include <string>
#include <umov/io/table.h>

namespace umov::bench {

inline constexpr int repetitions = 5; ///< the best counts: the others were disturbed

inline double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// How many processes wait for a core, over the last minute.
std::string load_average();
/// What numbers of speed mean nothing without.
void add_machine(Table &table, const std::string &load_before);

} // namespace umov::bench
