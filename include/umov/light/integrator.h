#pragma once
// The reference path: the light of one pose, by ray-tested points, with its numerical error.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <umov/light/stokes_table.h>
#include <umov/optics/stokes.h>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// How light of more than one surface is drawn.
enum class BetweenMethod : std::uint8_t {
  Auto,  ///< by whoever asks for the light: chains for many poses far apart, else paths
  Paths, ///< for each pose, shared by poses that follow each other closely
  Chains ///< drawn once for the body and asked by each pose; paths for what they cannot tell
};

/// How well a pose is to be known.
struct IntegrationOptions {
  double accuracy = 0.005; ///< wanted relative 95 % half-width of I
  std::uint64_t seed = 0;  ///< of the point sets; the result depends on it within the error only
  double density = 1;      ///< multiplies the number of points everywhere (64: a denser run)
  /// Light of the source per unit irradiance, in the scattering plane: sunlight, or a laser's.
  Stokes<ScatteringPlane> source{1, 0, 0, 0};
  std::size_t max_points = 1u << 22; ///< per pose; past that the error is reported as it is
  /// Per band [m2/sr]: below it I need not be known any better than at it; empty: 0.
  std::vector<double> floor_i = {};
  /// Surfaces that the light may touch: 1 is direct light, more adds sampled paths between parts.
  /// Up to 64. Convex meshes have direct light alone.
  std::size_t bounces = 1;
  BetweenMethod between = BetweenMethod::Paths; ///< Auto is Paths
  /// How many poses will be asked for, whoever asks for how many at once; 0: many, or of models to
  /// be compared. Chains that take seconds to draw are not drawn for few (`draws_reserve`).
  std::size_t poses_in_all = 0;
};

/// Whether the reserve of a million chains for poses that few others meet, which takes as long as
/// paths of a few dozen of them, is drawn for so many poses (0: many).
bool draws_reserve(std::size_t poses_in_all);

/// Whether chains draw any of the light of more than one surface: not where all that is seen from
/// outside and reflects are mirrors, lobes as narrow, or measured surfaces, which paths draw.
bool chains_draw_any(const Scene &scene);

/// Light of one pose in all bands.
struct PoseResult {
  std::vector<BandResult> bands;
  bool is_dark = true;        ///< nothing is both lit and seen: I = 0, q and u undefined
  std::vector<double> slot_i; ///< [slot * band_count + band]: direct I by mesh group and side
  std::uint64_t rays = 0;     ///< 0 for a convex mesh
  std::vector<Stokes<ScatteringPlane>> indirect; ///< per band, part of `bands`; with bounces > 1
  double glint_share = 0; ///< share of I in band 0 from flats within their lobe's half width
};

/// Light by sampled paths: that of more than one surface, or what is emitted.
struct IndirectLight {
  std::vector<BandResult> bands;
  std::uint64_t rays = 0;
};

/// A point of a triangle, by the shares of its second and third corner.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  double second = 0, third = 0;
};

class ThermalEmission;
class Integrator;

/// What chains (BetweenMethod::Chains) have to do with those of other materials on the same mesh.
struct ChainSharing {
  /// They are drawn for the light of these scenes, too, so that integrators of them take them. A
  /// scene on another mesh is passed over; one without a mesh is on the same.
  std::vector<Scene> also = {};
  /// Whose chains are taken, without any new rays: where it drew them for this scene, or tell this
  /// one's light as far as can be seen (docs/theory/bounces.md), as with other n, k or reflectance.
  /// Else there are own ones. Null: own ones.
  std::shared_ptr<const Integrator> elder = nullptr;
};

/// The same for integrators of a scene, without the meshes of others, which need not be held.
ChainSharing without_meshes(ChainSharing sharing, const Scene &scene);

/// Compiled scene. `evaluate` is pure and thread safe: the same poses give the same bits whatever
/// the number of threads and whatever was computed before.
class Integrator {
public:
  /// Compiles a scene. Throws as Engine.
  explicit Integrator(const Scene &scene, const std::atomic<bool> *cancel = nullptr,
                      ChainSharing sharing = {});
  ~Integrator();
  Integrator(Integrator &&) noexcept;
  Integrator &operator=(Integrator &&) noexcept;

  /// One pose.
  [[nodiscard]] PoseResult evaluate(const Pose &pose, const IntegrationOptions &options) const;
  /// All poses, on up to `threads` threads. With bounces > 1, poses that follow each other closely
  /// share their paths: a series costs less than its poses one by one, which agree within their
  /// half-widths. Empty if `cancel` became true.
  [[nodiscard]] std::vector<PoseResult> evaluate(const std::vector<Pose> &poses,
                                                 const IntegrationOptions &options,
                                                 unsigned threads,
                                                 const std::atomic<bool> *cancel = nullptr) const;
  /// The part of more than one surface alone, for direct light that comes from elsewhere:
  /// direct_i[pose * bands + band] is what the accuracy refers to besides. Empty as above.
  [[nodiscard]] std::vector<IndirectLight>
  indirect(std::span<const Pose> poses, std::span<const double> direct_i,
           const IntegrationOptions &options, unsigned threads,
           const std::atomic<bool> *cancel = nullptr) const;
  /// What the body emits by itself: Stokes [W sr-1 nm-1] in the scattering plane of the pose, from
  /// up to options.bounces surfaces (1: straight from where it arises, more: seen in neighbours
  /// too), each to options.accuracy. Empty as above.
  [[nodiscard]] std::vector<IndirectLight> thermal(std::span<const Pose> poses,
                                                   const ThermalEmission &emission,
                                                   const IntegrationOptions &options,
                                                   unsigned threads,
                                                   const std::atomic<bool> *cancel = nullptr) const;
  /// Radiance [1/sr] per unit irradiance that points send to the observer, who sees them, after
  /// more than one surface, in the scattering plane: the mean of `paths` sampled paths each, [point
  /// * bands + band]. `first`: number of the first point, so that no two draw alike. Of no use once
  /// `cancel` became true; throws Failure (Interrupted) where that comes before the first point.
  [[nodiscard]] std::vector<Stokes<ScatteringPlane>>
  indirect_radiance(const Pose &pose, std::span<const SurfacePoint> points,
                    const IntegrationOptions &options, std::size_t paths, std::uint64_t first,
                    const std::atomic<bool> *cancel = nullptr) const;
  /// Chains of so many bounces and this seed are the elder's (ChainSharing). Throws Failure
  /// (Interrupted) once `cancel`, which may be null, became true.
  [[nodiscard]] bool takes_chains(std::size_t bounces, std::uint64_t seed,
                                  const std::atomic<bool> *cancel = nullptr) const;
  /// Nothing of the body can hide anything else of it.
  [[nodiscard]] bool is_convex() const;

private:
  struct State;
  [[nodiscard]] PoseResult direct(const Pose &pose, const IntegrationOptions &options,
                                  const std::atomic<bool> *cancel) const;
  std::unique_ptr<State> state_;
};

} // namespace umov
