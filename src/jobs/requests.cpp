#include <umov/jobs/requests.h>

#include <fmt/format.h>

namespace umov::jobs {

LightOptions light_options(const Scenario &scenario, const JobOptions &job) {
  LightOptions out = scenario.light;
  out.seed = scenario.seed;
  out.threads = job.threads;
  out.mask_cache = job.mask_cache;
  out.device = job.device;
  return out;
}

LightCurveRequest light_curve_request(const Scenario &scenario, const ScenarioObject &named,
                                      const LoadedObject &object, const JobOptions &job) {
  LightCurveRequest out;
  out.object = named.name.empty() ? object.orbit->name() : named.name;
  out.track = {*object.orbit,   *scenario.observer, ShadowModel::Ellipsoid,
               object.attitude, named.parts,        scenario.has_solar_disk};
  out.span = scenario.time->span();
  out.only = scenario.time->only;
  out.frame = scenario.frame;
  out.magnitudes = scenario.magnitudes;
  out.earthshine = scenario.earthshine;
  out.has_moonlight = scenario.has_moonlight;
  if (scenario.air)
    out.air = air_over(*scenario.air, *scenario.observer);
  out.has_refracted_shadow = scenario.has_refracted_shadow;
  out.light = light_options(scenario, job);
  out.threads = job.threads;
  return out;
}

void tell_of_device(const std::string &device, Diagnostics &diagnostics) {
  if (device.starts_with("cpu"))
    diagnostics.warn("--device auto took the " + device);
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

} // namespace umov::jobs
