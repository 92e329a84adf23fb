// The directions of a signature.

#include <umov/jobs/signature.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/poses_file.h>
#include <umov/light/poses.h>

namespace umov::jobs {

Result<PoseList> random_poses(std::size_t per_phase, const std::vector<double> &phases_deg,
                              std::uint64_t seed) {
  for (const double phase : phases_deg)
    if (!(phase >= 0 && phase <= 180))
      return fail(ErrorCode::Usage, fmt::format("--phase {}: 0 to 180 was expected", phase));
  return PoseList{per_phase * phases_deg.size(),
                  [=](std::size_t i) {
                    return random_pose(seed, i, Angle::degrees(phases_deg[i / per_phase]));
                  },
                  [](std::size_t i) { return static_cast<std::int64_t>(i); },
                  fmt::format("{} random poses each at {} deg, seed {}", per_phase,
                              fmt::join(phases_deg, ","), seed)};
}

Result<PoseList> poses_from_file(const std::string &path) {
  UMOV_ASSIGN(text, read_file(path));
  UMOV_ASSIGN(table, read_poses(text, path));
  const auto all = std::make_shared<const PoseTable>(std::move(table));
  const std::string sha256 = sha256_hex(text);
  return PoseList{all->poses.size(), [all](std::size_t i) { return all->poses[i]; },
                  [all](std::size_t i) { return all->number[i]; }, "poses of " + sha256};
}

} // namespace umov::jobs
