// Poses of a signature (CSV).

#include "fuzz/target.h"

#include <cmath>
#include <umov/io/poses_file.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const auto read = read_poses(fuzz::text_of(data, size), "input");
  if (!fuzz::is_read(read))
    return 0;
  fuzz::require(read->number.size() == read->poses.size(), "a number for each pose");
  for (const Pose &pose : read->poses)
    for (const Vec3<Body> &v : {pose.sun, pose.observer})
      fuzz::require(std::abs(norm(v) - 1) < 1e-12, "directions are unit vectors");
  return 0;
}
