#pragma once
// Private: classes whose masks are uncertain, tested by rays in the very directions of a pose.

#include "backend/scene_data.h"
#include "light/fast/mask_points.h"
#include "light/fast/point_bits.h"
#include "light/fast/spheres.h"

#include <memory>
#include <mutex>
#include <umov/scene/articulation.h>
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
  /// What holds them, in the body.
  [[nodiscard]] const Sphere &bounds(std::uint32_t group, std::uint32_t lane) const;

private:
  struct Grade {
    std::once_flag is_made;
    std::vector<Occluder::Point> origin;
  };
  struct Points {
    Grade coarse, fine;
    std::once_flag has_bounds;
    Sphere bounds;
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

/// Another rigid part, as it stands now, seen from the part whose points are traced.
struct OtherPart {
  const Occluder *occluder = nullptr;
  PartMotion there;          ///< from this part's axes to the other's
  std::vector<Sphere> cover; ///< of the other, in this part's axes
};

/// Part of a class's points that is lit and seen in the pose, and how many there are.
struct TracedShare {
  double share = 0;
  std::size_t points = 0;
};

/// A class whose own points are asked, of which the masks doubt some.
struct AskedClass {
  std::uint32_t which = 0; ///< for who asks
  std::span<const Occluder::Point> points;
  std::size_t sure = 0, doubted = 0; ///< so many are lit and seen beyond doubt, and in doubt
  std::size_t asked = 0, free = 0;   ///< of those in doubt, and of those asked lit and seen
};

/// Traces rays; one per thread.
class RefineTracer {
public:
  /// Both must live. `hides_itself`: some point of the part may be hidden by the part.
  RefineTracer(const RefinePoints &points, const Occluder &occluder, bool hides_itself = true)
      : points_(points), occluder_(occluder), hides_itself_(hides_itself) {}
  /// What else may hide, from now on; it must live.
  void set_others(std::span<const OtherPart> others) { others_ = others; }
  /// Some other part may come before the facet.
  [[nodiscard]] bool has_others_before(const backend::SeenFacet &facet, const Pose &pose) const;
  /// `wanted` points of a class, spread over all of it.
  TracedShare trace(const backend::SeenFacet &facet, std::size_t wanted, const Pose &pose);
  /// Adds to `free` of each class those of its doubtful points that are free towards both. The rays
  /// of all of them go together: a class by itself has few, and a packet costs as much half empty.
  void trace_doubtful(std::span<AskedClass> classes, std::span<const DoubtfulPoint> doubtful,
                      const Pose &pose);
  [[nodiscard]] bool has_others() const { return !others_.empty(); }
  /// The same, as if nothing but the other parts hid anything.
  TracedShare trace_others(const backend::SeenFacet &facet, std::size_t wanted, const Pose &pose);

private:
  std::size_t take(const backend::SeenFacet &facet, std::size_t wanted);
  void test(const Occluder &occluder, std::span<const Occluder::Point> points,
            Vec3<Body> direction);
  void keep_free(Vec3<Body> direction);
  void ask(std::span<const AskedClass> classes, Vec3<Body> direction, bool DoubtfulPoint::*asks);
  void keep_free_of_others(const Sphere &bounds, Vec3<Body> direction);
  void keep_free_of(const OtherPart &other, Vec3<Body> direction);
  void drop_hidden();
  const RefinePoints &points_;
  const Occluder &occluder_;
  bool hides_itself_;
  std::span<const OtherPart> others_;
  std::vector<Occluder::Point> left_, moved_, directions_;
  std::vector<unsigned char> free_;
  std::vector<DoubtfulPoint> asked_;
};

} // namespace umov
