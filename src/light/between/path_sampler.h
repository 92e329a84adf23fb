#pragma once
// Paths of light between the surfaces of one pose.

#include "light/between/area_choice.h"
#include "light/between/bounce_scene.h"
#include "light/between/chain_surfaces.h"
#include "light/between/directions.h"
#include "light/between/lattice.h"
#include "light/between/sun_images.h"

#include <array>
#include <umov/light/integrator.h>
#include <umov/light/thermal.h>
#include <umov/shape/occluder.h>

namespace umov {

/// What the paths of a pose have learnt, for the next one.
struct PathLearning {
  LearntAreas seen, lit;
  void add(const PathLearning &other, double share) {
    seen.add(other.seen, share);
    lit.add(other.lit, share);
  }
};

/// Draws paths from both ends; `options` and `pose` must live.
class PathSampler {
public:
  using Light = Stokes<ScatteringPlane>;
  static constexpr std::size_t surfaces_max = 64;

  /// With `emission` the light is what the surfaces send out by themselves, not the Sun's. Without
  /// ends it can only `look`. With `chains`, which must live, paths carry only what those leave out
  /// (ChainSurfaces::part).
  PathSampler(const BounceScene &of, const Occluder &occluder, const Pose &pose,
              const IntegrationOptions &options, const ThermalEmission *emission = nullptr,
              const ChainSurfaces *chains = nullptr, bool has_ends = true);

  [[nodiscard]] bool has_any() const {
    return !seen_.is_empty() && (emission_ != nullptr || !lit_.is_empty());
  }
  /// Adds what one pair of paths carries: one from the observer, one from the Sun, who has none of
  /// emitted light. `sum`: per band.
  void add(const std::array<double, dimensions> &x, std::uint64_t stream, std::vector<Light> &sum);
  /// Adds the radiance that one path finds at a point that the observer sees; the Sun's side has no
  /// part in it.
  void look(const SurfacePoint &at, std::uint64_t stream, std::vector<Light> &sum);
  /// From now on paths begin where others, of this pose or a like one, found light.
  void start_from(const PathLearning &other) {
    seen_.start_from(other.seen);
    lit_.start_from(other.lit);
  }
  [[nodiscard]] PathLearning learnt() const { return {seen_.learnt(), lit_.learnt()}; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

private:
  /// What counts of the surface that the Sun shines on: all, with the Sun as a disk; all but a
  /// mirror; the Sun's image in a mirror alone.
  enum class SunEnd { Disk, WithoutMirror, Mirror };

  [[nodiscard]] AreaChoice facing(Vec3<Body> direction) const;
  [[nodiscard]] Vertex vertex_at(const AreaChoice &choice, double x, double u, double v,
                                 Vec3<Body> towards) const;
  bool is_free(Vec3<Body> from, Vec3<Body> direction);
  /// The next surface, if there is one that can be seen from outside.
  bool next(const Vertex &from, Vec3<Body> direction, Vertex &to, double &distance);
  /// f (n.in) applied to light that comes from direction `in` and leaves to `out`. The light's axes
  /// are those of this plane, before and after.
  [[nodiscard]] Light scattered(const Vertex &at, std::size_t band, Vec3<Body> in, Vec3<Body> out,
                                double disk, bool is_by_mirror, const Light &light,
                                bool is_lobe_alone = false) const;
  /// Light that travels along `beam` to x[count-1] with its axis +Q, then on to x[0] and to the
  /// observer, in the pose's axes.
  [[nodiscard]] Light carried(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                              std::size_t band, Light light, Vec3<Body> axis, Vec3<Body> beam,
                              bool is_lobe_alone = false) const;
  /// Light that x[last] emits.
  [[nodiscard]] Light emitted(const Vertex *x, const Vec3<Body> *step, std::size_t last,
                              std::size_t band) const;
  double add_emitted(const Vertex *x, const Vec3<Body> *step, std::size_t last, double weight,
                     std::vector<Light> &sum) const;
  /// Light of the Sun that goes x[count-1] ... x[0] and then to the observer, in the pose's axes.
  /// `step[i]`: direction from x[i] to x[i+1].
  [[nodiscard]] Light along(const Vertex *x, const Vec3<Body> *step, std::size_t count,
                            std::size_t band, SunEnd end, bool is_lobe_alone) const;
  /// How much likelier a path without mirrors is drawn from the Sun's side than from this one.
  [[nodiscard]] double sun_over_observer(const Vertex *x, const Vec3<Body> *step,
                                         std::size_t count) const;
  /// How much likelier its last step is drawn towards an image of the Sun; `seen_from`: what the
  /// last surface but one sees of them.
  [[nodiscard]] double image_over_observer(const Vertex *x, const Vec3<Body> *step,
                                           std::size_t count,
                                           const SunImages::Choice &seen_from) const;
  /// The images that a path may be led to from a surface: none from narrow ones.
  void look_at_images(const Vertex &from, SunImages::Choice &out) const;
  /// The path from path_[0] to path_[k] and on to an image of the Sun.
  double add_by_image(std::size_t k, double weight, std::uint64_t stream, std::vector<Light> &sum);
  /// Nobody else draws the light that enters at `last` and leaves at `first`.
  [[nodiscard]] bool is_asked(const Vertex &first, const Vertex &last) const {
    return part_of_chains(first, last) != ChainPart::Whole;
  }
  [[nodiscard]] ChainPart part_of_chains(const Vertex &first, const Vertex &last) const;
  /// Adds a path to all bands; what it adds to I of the first.
  double add_path(const Vertex *x, const Vec3<Body> *step, std::size_t count, double weight,
                  SunEnd end, std::vector<Light> &sum) const;
  /// Paths that begin at a point that the observer may see, and look at the Sun from each surface
  /// they meet; what they added to I of the first band.
  double from_observer(const Vertex &first, const std::array<double, dimensions> &x,
                       std::uint64_t stream, std::vector<Light> &sum);
  /// Their way from there on; `is_alone`: they are not drawn from the Sun's side as well.
  double go_on(const Vertex &first, double weight, bool is_alone,
               const std::array<double, dimensions> &x, std::uint64_t stream,
               std::vector<Light> &sum);
  /// The same begun where the Sun may shine, with a look at the observer.
  double from_sun(const Vertex &first, const std::array<double, dimensions> &x,
                  std::uint64_t stream, std::vector<Light> &sum);

  const BounceScene &of_;
  const Scene &scene_;
  const Occluder &occluder_;
  const Pose &pose_;
  const IntegrationOptions &options_;
  const ChainSurfaces *chains_;
  std::size_t bands_;
  AreaChoice seen_, lit_;
  const ThermalEmission *emission_;
  SunImages images_;
  SunImages::Choice from_here_,
      from_first_;   ///< images seen by the last surface but one, from either end
  Vec3<Body> plane_; ///< normal of the pose's scattering plane
  std::uint64_t rays_ = 0;
  // The path at hand. Room for it on the stack would be set to zero for each: a seventh of the
  // time.
  std::array<Vertex, surfaces_max> path_;
  std::array<Vec3<Body>, surfaces_max> step_;
};

} // namespace umov
