#include "scenario_jobs.h"

#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <umov/core/parallel.h>

namespace umov::cli {

LightCurveRequest light_curve_request(const Scenario &scenario, const ScenarioObject &named,
                                      const LoadedObject &object, const Common &common) {
  LightCurveRequest request;
  request.object = named.name.empty() ? object.orbit->name() : named.name;
  request.orbit = *object.orbit;
  request.site = *scenario.observer;
  request.start = scenario.time->start;
  request.stop = scenario.time->stop;
  request.step_s = scenario.time->step_s;
  request.only = scenario.time->only;
  request.attitude = object.attitude;
  request.joints = named.parts;
  request.frame = scenario.frame;
  request.earthshine = scenario.earthshine;
  request.has_moonlight = scenario.has_moonlight;
  request.has_refracted_shadow = scenario.has_refracted_shadow;
  request.has_solar_disk = scenario.has_solar_disk;
  request.integration.accuracy = scenario.accuracy;
  request.integration.seed = scenario.seed;
  request.integration.bounces = scenario.bounces;
  // A sampled path costs more than a point: rows that are mostly indirect say what they reached.
  if (scenario.bounces > 1)
    request.integration.max_points = 1u << 19;
  request.threads = static_cast<unsigned>(common.threads);
  return request;
}

Result<std::size_t> band_index(const std::string &name, const std::vector<Band> &bands) {
  if (name.empty())
    return bands.size() / 2;
  std::string known;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    if (bands[b].name == name)
      return b;
    known += (b > 0 ? ", " : "") + bands[b].name;
  }
  return fail(ErrorCode::Usage,
              fmt::format("--band {}: there is none of that name; there are {}", name, known));
}

ManifestInput manifest_of_command(const Common &common,
                                  std::chrono::system_clock::time_point started) {
  using namespace std::chrono;
  ManifestInput out;
  out.threads = resolve_threads(static_cast<unsigned>(common.threads));
  out.command_line = command_line();
  out.started_utc =
      fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(system_clock::to_time_t(started)));
  out.elapsed_s = duration<double>(system_clock::now() - started).count();
  return out;
}

} // namespace umov::cli
