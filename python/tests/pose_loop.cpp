// The loop that python/tests/test_overhead.py holds the package against: pose_loop SCENE COUNT. For
// every line that it reads it lights COUNT random poses, on one thread, and prints the seconds by
// the clock and of the processor.
#include "timed_loop.h"

#include <cstdlib>
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
  time_each_line([&] {
    umov::StokesTable table;
    if (!light.evaluate(poses, table, task))
      std::abort(); // nothing cancels it
    return table;
  });
  return {};
}

} // namespace

int main(int argc, char **argv) {
  return argc == 3 ? exit_code_of(run(argv[1], std::strtoul(argv[2], nullptr, 10))) : 2;
}
