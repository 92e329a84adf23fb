#include "bench/machine.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <thread>
#include <umov/bench/bench.h>
#include <umov/core/version.h>
#include <umov/light/instruction_set.h>

namespace umov::bench {
namespace {

std::string first_line_with(const char *file, const std::string &key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with(key))
      return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

} // namespace

Machine machine() {
  return {first_line_with("/proc/cpuinfo", "model name"), engine_instruction_set(),
          std::thread::hardware_concurrency()};
}

std::string load_average() {
  double load[1] = {0};
  return getloadavg(load, 1) == 1 ? fmt::format("{:.2f}", load[0]) : "unknown";
}

void add_machine(Table &table, const std::string &load_before) {
  const Machine here = machine();
  table.note("umov_version", version);
  table.note("machine", here.processor);
  table.note("cores", std::to_string(here.cores));
  table.note("load_average", load_before + " before, " + load_average() + " after");
  table.note("compiler", __VERSION__);
}

} // namespace umov::bench
