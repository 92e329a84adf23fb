#include "run_console.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/parallel.h>
#include <umov/core/text.h>

namespace umov::cli {
namespace {

/// The folder and what is in it, for programs.
void print_json(const jobs::RunResult &result, const RunFolder &folder) {
  nlohmann::ordered_json objects = nlohmann::ordered_json::array();
  for (const jobs::ObjectRun &one : result.objects)
    objects.push_back(nlohmann::ordered_json::parse(jobs::summary_json(one.outcome)));
  const nlohmann::ordered_json out{{"folder", folder.path().string()},
                                   {"complete", !result.stopped},
                                   {"objects", std::move(objects)}};
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

} // namespace

void tell_of_objects(const std::string &scenario, const std::vector<jobs::ObjectRun> &objects,
                     const Common &common) {
  for (const jobs::ObjectRun &one : objects)
    note(common, fmt::format("{}: fine; {}, {}", scenario,
                             counted(one.object.scene.mesh.triangles.size(), "triangle"),
                             counted(one.object.scene.bands.size(), "band")));
}

void tell_of_search(const Scenario &scenario, const Common &common) {
  const ScenarioTime &span = *scenario.time;
  const double count = static_cast<double>(epoch_count(span.span()).value_or(0));
  constexpr double many = 200'000; // about a second
  if (count >= many)
    note(common, fmt::format("looking for passes among {:.0f} epochs", count));
}

void tell_of_run(const jobs::RunResult &result, const RunFolder &folder,
                 std::chrono::system_clock::time_point started, const Common &common) {
  if (common.json)
    print_json(result, folder);
  else if (!common.quiet) {
    for (const jobs::ObjectRun &one : result.objects)
      fmt::print("{}", jobs::summarize(one.outcome));
    fmt::print("written to {}{}\n", printable(folder.path().string()),
               folder.replaced_utc().empty()
                   ? ""
                   : fmt::format(", in place of the run of {}", printable(folder.replaced_utc())));
  }
  const std::chrono::duration<double> spent = std::chrono::system_clock::now() - started;
  if (common.verbose)
    note(common, fmt::format("{:.1f} s on {} threads", spent.count(),
                             resolve_threads(static_cast<unsigned>(common.threads))));
}

} // namespace umov::cli
