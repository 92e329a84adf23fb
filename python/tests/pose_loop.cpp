// The loop that python/tests/test_overhead.py holds the package against: pose_loop SCENE COUNT. For
// every line that it reads it lights COUNT random poses, on one thread, and prints the seconds by
// the clock and of the processor.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <umov/jobs/pose_light.h>

namespace {

umov::Result<void> run(const std::string &scene, std::size_t count) {
  umov::Diagnostics warnings;
  UMOV_ASSIGN(scenario, umov::read_scenario(scene, {}));
  umov::jobs::JobOptions options;
  options.threads = 1;
  UMOV_ASSIGN(light, umov::jobs::PoseLight::make(scenario, {}, options, warnings));
  UMOV_ASSIGN(list, umov::jobs::random_poses(count, {60}, 1));
  std::vector<umov::Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(list.at(i));
    poses.back().sun_radius_rad = light.sun_radius_rad();
  }
  umov::LightTask task;
  task.threads = 1;
  for (std::string line; std::getline(std::cin, line);) {
    const std::clock_t begin_cpu = std::clock();
    const auto begin = std::chrono::steady_clock::now();
    umov::StokesTable table; // a caller keeps the results of each call
    if (!light.evaluate(poses, table, task))
      return umov::fail(umov::ErrorCode::Interrupted, "stopped");
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    const double processor = static_cast<double>(std::clock() - begin_cpu) / CLOCKS_PER_SEC;
    std::printf("%.9f %.9f\n", spent.count(), processor);
    std::fflush(stdout);
  }
  return {};
}

} // namespace

int main(int argc, char **argv) {
  if (argc != 3)
    return 2;
  const auto done = run(argv[1], std::strtoul(argv[2], nullptr, 10));
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : 1;
}
