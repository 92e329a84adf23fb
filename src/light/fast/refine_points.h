#pragma once
// Private: classes whose masks are uncertain, tested by rays in the very directions of a pose.

#include "backend/scene_data.h"
#include "light/fast/mask_points.h"

#include <umov/light/integrator.h>

namespace umov {

/// Denser points of every class, made once: what the masks hold is too few to trace anew.
class RefinePoints {
public:
  RefinePoints() = default;
  RefinePoints(const Scene &scene, const Elements &elements, const FacetClasses &classes,
               const GroupPlan &plan, const Occluder &occluder, unsigned threads);
  [[nodiscard]] std::span<const Occluder::Point> of(std::uint32_t group, std::uint32_t lane) const;
  [[nodiscard]] std::size_t bytes() const { return origin_.size() * sizeof(Occluder::Point); }

private:
  std::vector<std::size_t> first_; ///< [group * lanes + lane], and the end
  std::vector<Occluder::Point> origin_;
};

/// Part of `points` that is lit and seen in the pose, and how many there are.
struct TracedShare {
  double share = 0;
  std::size_t points = 0;
};

/// Traces rays; one per thread.
class RefineTracer {
public:
  explicit RefineTracer(const Occluder &occluder) : occluder_(occluder) {}
  /// `wanted` of the points, spread over all of them.
  TracedShare trace(std::span<const Occluder::Point> points, std::size_t wanted, const Pose &pose);

private:
  void trace(Vec3<Body> direction);
  const Occluder &occluder_;
  std::vector<Occluder::Point> left_, directions_;
  std::vector<unsigned char> free_;
};

} // namespace umov
