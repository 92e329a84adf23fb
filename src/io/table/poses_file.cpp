#include <umov/io/poses_file.h>

#include <cmath>
#include <fmt/format.h>
#include <umov/io/table.h>

namespace umov {
namespace {

/// A direction of any length but 0, from three columns.
Result<Vec3<Body>> direction_from(const Table &table, const std::string &name, std::size_t row,
                                  const Where &where) {
  const Vec3<Body> v{table.number(name + "_x", row), table.number(name + "_y", row),
                     table.number(name + "_z", row)};
  const auto direction = direction_along(v);
  if (!direction)
    return fail(ErrorCode::BadInput,
                fmt::format("{0}_x, {0}_y, {0}_z are 0; a direction was expected", name), where);
  return *direction;
}

/// The number of a pose: beyond 2^53 a double no longer tells one from the next.
Result<void> check_number(double pose, const Where &where) {
  constexpr double most = 9007199254740992.0;
  if (pose == std::floor(pose) && std::abs(pose) <= most)
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("pose is {:g}; a whole number up to 2^53 was expected", pose), where);
}

} // namespace

Result<PoseTable> read_poses(std::string_view text, const std::string &file) {
  UMOV_ASSIGN(table, read_csv(text, file, {"sun_x", "sun_y", "sun_z", "obs_x", "obs_y", "obs_z"},
                              {"pose"}));
  const bool has_pose = table.find("pose") != nullptr;
  PoseTable out;
  std::vector<Pose> &poses = out.poses;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Where where{file, static_cast<std::size_t>(table.number("line", i))};
    UMOV_ASSIGN(sun, direction_from(table, "sun", i, where));
    UMOV_ASSIGN(observer, direction_from(table, "obs", i, where));
    if (has_pose)
      UMOV_TRY(check_number(table.number("pose", i), where));
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

} // namespace umov
