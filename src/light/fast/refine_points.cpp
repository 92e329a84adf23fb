#include "light/fast/refine_points.h"

#include <algorithm>
#include <umov/core/parallel.h>

namespace umov {
namespace {

/// Points of a class of which the masks hold 32 `words`.
std::size_t count_for(const GroupPlan::Group &group) {
  return std::clamp<std::size_t>(std::size_t{4} * 32 * group.words, 256, 2048);
}

} // namespace

RefinePoints::RefinePoints(const Scene &scene, const Elements &elements,
                           const FacetClasses &classes, const GroupPlan &plan,
                           const Occluder &occluder, unsigned threads) {
  first_.assign(plan.groups.size() * backend::lanes + 1, 0);
  for (std::size_t g = 0; g < plan.groups.size(); ++g)
    for (std::size_t lane = 0; lane < backend::lanes; ++lane)
      first_[g * backend::lanes + lane + 1] =
          first_[g * backend::lanes + lane] +
          (plan.groups[g].member[lane] == no_index ? 0 : count_for(plan.groups[g]));
  origin_.resize(first_.back());
  parallel_for(plan.groups.size(), threads, [&](std::size_t g) {
    for (std::size_t lane = 0; lane < backend::lanes; ++lane) {
      const std::size_t at = first_[g * backend::lanes + lane];
      const std::size_t count = first_[g * backend::lanes + lane + 1] - at;
      if (count == 0)
        continue;
      const ClassPoints points =
          spread_points(scene, elements, classes, plan.groups[g].member[lane], count, occluder);
      std::copy(points.origin.begin(), points.origin.end(),
                origin_.begin() + static_cast<std::ptrdiff_t>(at));
    }
  });
}

std::span<const Occluder::Point> RefinePoints::of(std::uint32_t group, std::uint32_t lane) const {
  const std::size_t i = group * backend::lanes + lane;
  return {origin_.data() + first_[i], first_[i + 1] - first_[i]};
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
