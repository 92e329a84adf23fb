#include "light/fast/refine_points.h"

#include <algorithm>

namespace umov {
namespace {

/// Points of a class of which the masks hold 32 `words`.
std::size_t coarse_count(const GroupPlan::Group &group) {
  return std::clamp<std::size_t>(std::size_t{4} * 32 * group.words, 256, 2048);
}
std::size_t fine_count(const GroupPlan::Group &group) { return 8 * coarse_count(group); }

} // namespace

RefinePoints::RefinePoints(const Scene &scene, const Elements &elements,
                           const FacetClasses &classes, const GroupPlan &plan,
                           const Occluder &occluder)
    : source_{&scene, &elements, &classes, &plan, &occluder},
      points_(std::make_unique<Points[]>(plan.groups.size() * backend::lanes)) {}

std::span<const Occluder::Point> RefinePoints::of(std::uint32_t group, std::uint32_t lane,
                                                  std::size_t wanted) const {
  const GroupPlan::Group &of = source_.plan->groups[group];
  const bool is_fine = wanted > coarse_count(of);
  Points &both = points_[group * backend::lanes + lane];
  Grade &grade = is_fine ? both.fine : both.coarse;
  std::call_once(grade.is_made, [&] {
    grade.origin =
        spread_points(*source_.scene, *source_.elements, *source_.classes, of.member[lane],
                      is_fine ? fine_count(of) : coarse_count(of), *source_.occluder)
            .origin;
  });
  return grade.origin;
}

void RefineTracer::trace(Vec3<Body> direction) {
  directions_.assign(left_.size(),
                     {static_cast<float>(direction.x), static_cast<float>(direction.y),
                      static_cast<float>(direction.z)});
  free_.resize(left_.size());
  occluder_.is_free(left_, directions_, free_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < left_.size(); ++i)
    if (free_[i] != 0)
      left_[kept++] = left_[i];
  left_.resize(kept);
}

TracedShare RefineTracer::trace(std::span<const Occluder::Point> points, std::size_t wanted,
                                const Pose &pose) {
  const std::size_t count = std::clamp<std::size_t>(wanted, 1, points.size());
  left_.clear();
  for (std::size_t i = 0; i < count; ++i)
    left_.push_back(points[(2 * i + 1) * points.size() / (2 * count)]);
  trace(pose.sun);
  trace(pose.observer);
  return {static_cast<double>(left_.size()) / static_cast<double>(count), count};
}

} // namespace umov
