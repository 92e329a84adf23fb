// A light curve from a scenario file: light_curve examples/hst_maui.toml [key=value ...]
#include <cstdio>
#include <umov/umov.h>

umov::Result<void> print_light_curve(const std::string &file,
                                     const std::vector<std::string> &changes) {
  UMOV_ASSIGN(scenario, umov::read_scenario(file, changes));
  UMOV_TRY(umov::check_complete_for_run(scenario));
  umov::Diagnostics warnings;
  UMOV_ASSIGN(object, umov::load_object(scenario, 0, {}, warnings));
  const auto request = umov::jobs::light_curve_request(scenario, scenario.objects[0], object, {});
  const std::atomic<bool> cancel = false;
  UMOV_ASSIGN(outcome, umov::compute_light_curve(request, object.scene, nullptr, cancel));
  const umov::LightCurve &curve = outcome.curve;
  for (std::size_t k = 0; k < curve.samples.size(); ++k)
    std::printf("%s %s %.3f mag, p %.4f\n",
                umov::to_iso(curve.epochs[k / curve.bands.size()].geometry.time).c_str(),
                curve.bands[k % curve.bands.size()].name.c_str(), curve.samples[k].magnitude,
                curve.samples[k].p);
  return {};
}

int main(int argc, char **argv) {
  if (argc < 2)
    return 2;
  const auto done = print_light_curve(argv[1], {argv + 2, argv + argc});
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : static_cast<int>(done.error().code);
}
