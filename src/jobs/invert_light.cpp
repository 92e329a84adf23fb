#include "jobs/invert_light.h"

namespace umov::jobs {

Result<Prepared> prepare(const Scenario &scenario, const InvertRequest &request,
                         const JobOptions &options, Diagnostics &diagnostics) {
  std::vector<InputFile> inputs;
  UMOV_ASSIGN(files, read_observations(request.observations, inputs, diagnostics));
  UMOV_ASSIGN(observed,
              observed_light_curve(scenario, files, request.allow_old_elements, diagnostics));
  SignatureRequest lit;
  lit.method = request.method;
  Diagnostics twice; // the object was read for its orbit: its warnings are known
  UMOV_ASSIGN(light, PoseLight::make(scenario, lit, options, twice));
  for (InputFile &input : inputs)
    observed.inputs.push_back(std::move(input));
  return Prepared{std::move(observed), std::move(light)};
}

PoseLighting lighting_of(const PoseLight &light, unsigned threads, const Monitor &monitor) {
  return [&light, threads, &monitor](std::span<const Pose> poses, StokesTable &out) {
    LightTask task;
    task.threads = threads;
    task.cancel = monitor.cancel;
    return !monitor.is_cancelled() && light.evaluate(poses, out, task);
  };
}

SearchOptions search_options(const Scenario &scenario, const InvertRequest &request,
                             const JobOptions &options, const Monitor &monitor) {
  SearchOptions out;
  out.errors = request.errors;
  out.grid = request.grid;
  out.seed = scenario.seed;
  out.threads = options.threads;
  out.progress = [&monitor](const char *what, std::size_t done, std::size_t total) {
    monitor.advance(what, done, total);
  };
  return out;
}

} // namespace umov::jobs
