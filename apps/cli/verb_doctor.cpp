#include "console.h"
#include "verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/parallel.h>
#include <umov/core/version.h>
#include <umov/io/report.h>
#include <umov/surface/material.h>
#include <umov/time/epoch.h>

namespace umov::cli {
namespace {

struct Finding {
  bool is_fine;
  std::string what, found;
};

std::string instruction_sets() {
  std::string out = "x86-64";
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
    out += ", avx2";
  if (__builtin_cpu_supports("avx512f"))
    out += ", avx512";
#else
  out = "generic";
#endif
  return out + " (this version computes in scalar double)";
}

std::vector<Finding> examine() {
  std::vector<Finding> out;
  out.push_back({true, "version", fmt::format("umov {} ({})", version, source_revision)});
  out.push_back({true, "threads", fmt::format("{}", resolve_threads(0))});
  out.push_back({true, "instruction sets", instruction_sets()});
  out.push_back({true, "device", "cpu (no other backend in this version)"});
  out.push_back({true, "materials", fmt::format("{}", builtin_material_names().size())});
  // Known answers through the whole of time and Earth orientation (IERS: UT1-UTC on 2018-01-21).
  const auto time = utc_from_iso("2018-01-21T00:00:00Z");
  const bool clock =
      time && earth_orientation(*time).is_covered && to_iso(*time) == "2018-01-21T00:00:00.000Z";
  out.push_back({clock, "time tables",
                 clock ? "leap seconds and Earth orientation are there" : "broken: build again"});
  out.push_back({has_report(), "report",
                 has_report() ? "plotting script is built in"
                              : "no plotting script in this build: run tools/setup, build again"});
  return out;
}

int run_doctor(const Common &common) {
  bool fine = true;
  auto json = nlohmann::ordered_json::array();
  for (const Finding &finding : examine()) {
    json.push_back({{"what", finding.what}, {"found", finding.found}, {"ok", finding.is_fine}});
    if (!common.json)
      fmt::print("{:4} {:18} {}\n", finding.is_fine ? "ok" : "BAD", finding.what, finding.found);
    fine = fine && finding.is_fine;
  }
  if (common.json)
    fmt::print("{}\n", json.dump(2));
  return fine ? 0 : static_cast<int>(ErrorCode::Device);
}

} // namespace

void add_doctor(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("doctor", "Say what this build and machine can do");
  auto common = std::make_shared<Common>();
  add_common(*verb, *common, true);
  verb->callback([common, exit_with] { exit_with(run_doctor(*common)); });
}

} // namespace umov::cli
