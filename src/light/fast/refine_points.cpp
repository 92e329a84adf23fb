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

const Sphere &RefinePoints::bounds(std::uint32_t group, std::uint32_t lane) const {
  Points &own = points_[group * backend::lanes + lane];
  std::call_once(own.has_bounds, [&] {
    std::vector<Vec3<Body>> places;
    for (const Occluder::Point &p : of(group, lane, 1))
      places.push_back(source_.occluder->from_point(p));
    own.bounds = around(places);
  });
  return own.bounds;
}

/// Some of the points of a class, in left_; how many.
std::size_t RefineTracer::take(const backend::SeenFacet &facet, std::size_t wanted) {
  const auto all = points_.of(facet.group, facet.lane, wanted);
  const std::size_t count = std::clamp<std::size_t>(wanted, 1, all.size());
  left_.clear();
  for (std::size_t i = 0; i < count; ++i)
    left_.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
  return count;
}

void RefineTracer::drop_hidden() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < left_.size(); ++i)
    if (free_[i] != 0)
      left_[kept++] = left_[i];
  left_.resize(kept);
}

/// Which of some points are free in a direction, into free_.
void RefineTracer::test(const Occluder &occluder, std::span<const Occluder::Point> points,
                        Vec3<Body> direction) {
  directions_.assign(points.size(),
                     {static_cast<float>(direction.x), static_cast<float>(direction.y),
                      static_cast<float>(direction.z)});
  free_.resize(points.size());
  occluder.is_free(points, directions_, free_);
}

void RefineTracer::keep_free(Vec3<Body> direction) {
  test(occluder_, left_, direction);
  drop_hidden();
}

void RefineTracer::keep_free_of(const OtherPart &other, Vec3<Body> direction) {
  moved_.clear();
  for (const Occluder::Point &p : left_)
    moved_.push_back(other.occluder->to_point(other.there.place(occluder_.from_point(p))));
  test(*other.occluder, moved_, other.there.turn * direction);
  drop_hidden();
}

namespace {

bool comes_before(const OtherPart &other, const Sphere &bounds, Vec3<Body> direction) {
  return std::any_of(other.cover.begin(), other.cover.end(),
                     [&](const Sphere &sphere) { return may_hide(bounds, sphere, direction); });
}

} // namespace

void RefineTracer::keep_free_of_others(const Sphere &bounds, Vec3<Body> direction) {
  for (const OtherPart &other : others_)
    if (!left_.empty() && comes_before(other, bounds, direction))
      keep_free_of(other, direction);
}

bool RefineTracer::has_others_before(const backend::SeenFacet &facet, const Pose &pose) const {
  const Sphere &bounds = points_.bounds(facet.group, facet.lane);
  return std::any_of(others_.begin(), others_.end(), [&](const OtherPart &other) {
    return comes_before(other, bounds, pose.sun) || comes_before(other, bounds, pose.observer);
  });
}

TracedShare RefineTracer::trace_others(const backend::SeenFacet &facet, std::size_t wanted,
                                       const Pose &pose) {
  const std::size_t count = take(facet, wanted);
  const Sphere &bounds = points_.bounds(facet.group, facet.lane);
  keep_free_of_others(bounds, pose.sun);
  keep_free_of_others(bounds, pose.observer);
  return {static_cast<double>(left_.size()) / static_cast<double>(count), count};
}

/// Drops of asked_ those that are hidden in a direction which they ask for.
void RefineTracer::ask(std::span<const AskedClass> classes, Vec3<Body> direction,
                       bool DoubtfulPoint::*asks) {
  left_.clear();
  for (const DoubtfulPoint &p : asked_)
    if (p.*asks)
      left_.push_back(classes[p.of].points[p.index]);
  test(occluder_, left_, direction);
  std::size_t kept = 0, k = 0;
  for (const DoubtfulPoint &p : asked_)
    if (!(p.*asks) || free_[k++] != 0)
      asked_[kept++] = p;
  asked_.resize(kept);
}

void RefineTracer::trace_doubtful(std::span<AskedClass> classes,
                                  std::span<const DoubtfulPoint> doubtful, const Pose &pose) {
  asked_.assign(doubtful.begin(), doubtful.end());
  ask(classes, pose.sun, &DoubtfulPoint::asks_sun);
  ask(classes, pose.observer, &DoubtfulPoint::asks_observer);
  for (const DoubtfulPoint &p : asked_)
    ++classes[p.of].free;
}

TracedShare RefineTracer::trace(const backend::SeenFacet &facet, std::size_t wanted,
                                const Pose &pose) {
  const std::size_t count = take(facet, wanted);
  for (const Vec3<Body> &direction : {pose.sun, pose.observer}) {
    if (hides_itself_)
      keep_free(direction);
    if (!others_.empty())
      keep_free_of_others(points_.bounds(facet.group, facet.lane), direction);
  }
  return {static_cast<double>(left_.size()) / static_cast<double>(count), count};
}

} // namespace umov
