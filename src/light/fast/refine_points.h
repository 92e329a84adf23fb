#pragma once
// Private: classes whose masks are uncertain, tested by rays in the very directions of a pose.

#include "backend/scene_data.h"
#include "light/fast/mask_points.h"

#include <memory>
#include <mutex>
#include <umov/scene/pose.h>

namespace umov {

/// Denser points of the classes, in two grades: what the masks hold is too few to trace anew. Made
/// when first asked for, since most classes are never uncertain; thread safe. What it was made from
/// must live.
class RefinePoints {
public:
  RefinePoints() = default;
  RefinePoints(const Scene &scene, const Elements &elements, const FacetClasses &classes,
               const GroupPlan &plan, const Occluder &occluder);
  /// At least `wanted` points of a class, or as many as there ever are.
  [[nodiscard]] std::span<const Occluder::Point> of(std::uint32_t group, std::uint32_t lane,
                                                    std::size_t wanted) const;

private:
  struct Grade {
    std::once_flag is_made;
    std::vector<Occluder::Point> origin;
  };
  struct Points {
    Grade coarse, fine;
  };
  struct Source {
    const Scene *scene;
    const Elements *elements;
    const FacetClasses *classes;
    const GroupPlan *plan;
    const Occluder *occluder;
  };
  Source source_{};
  std::unique_ptr<Points[]> points_; ///< [group * lanes + lane]
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
