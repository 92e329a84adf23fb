// The directions of a signature.

#include <umov/jobs/signature.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/light/poses.h>

namespace umov::jobs {
namespace {

/// A direction of any length but 0, from three columns.
Result<Vec3<Body>> direction_from(const Table &table, const std::string &name, std::size_t row,
                                  const Where &where) {
  const Vec3<Body> v{table.number(name + "_x", row), table.number(name + "_y", row),
                     table.number(name + "_z", row)};
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("{0}_x, {0}_y, {0}_z are 0; a direction was expected", name), where);
  int exponent = 0; // squares of very long or short vectors would leave the range of a double
  std::frexp(largest, &exponent);
  return normalized(Vec3<Body>{std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent),
                               std::ldexp(v.z, -exponent)});
}

/// Poses and the numbers that they have in the output.
struct NumberedPoses {
  std::string sha256; ///< of the file
  std::vector<Pose> poses;
  std::vector<std::int64_t> number;
};

Result<NumberedPoses> poses_from_table(const std::string &path) {
  UMOV_ASSIGN(text, read_file(path));
  UMOV_ASSIGN(table, read_csv(text, path, {"sun_x", "sun_y", "sun_z", "obs_x", "obs_y", "obs_z"},
                              {"pose"}));
  const bool has_pose = table.find("pose") != nullptr;
  NumberedPoses out;
  out.sha256 = sha256_hex(text);
  std::vector<Pose> &poses = out.poses;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Where where{path, static_cast<std::size_t>(table.number("line", i))};
    UMOV_ASSIGN(sun, direction_from(table, "sun", i, where));
    UMOV_ASSIGN(observer, direction_from(table, "obs", i, where));
    if (has_pose && i > 0 && table.number("pose", i) == table.number("pose", i - 1)) {
      if (norm(poses.back().sun - sun) + norm(poses.back().observer - observer) > 1e-9)
        return fail(ErrorCode::BadInput,
                    fmt::format("pose {:g} has two different directions; number the poses anew or "
                                "leave the column pose out",
                                table.number("pose", i)),
                    where);
      continue;
    }
    out.number.push_back(has_pose ? static_cast<std::int64_t>(table.number("pose", i))
                                  : static_cast<std::int64_t>(poses.size()));
    poses.push_back({sun, observer});
  }
  return out;
}

} // namespace

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
  UMOV_ASSIGN(table, poses_from_table(path));
  const auto all = std::make_shared<const NumberedPoses>(std::move(table));
  return PoseList{all->poses.size(), [all](std::size_t i) { return all->poses[i]; },
                  [all](std::size_t i) { return all->number[i]; }, "poses of " + all->sha256};
}

} // namespace umov::jobs
