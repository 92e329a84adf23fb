#pragma once
// Light between surfaces at points that an observer sees: what pictures add to direct light.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <umov/light/integrator.h>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// How the light of one picture is drawn.
struct BetweenLightOptions {
  std::size_t bounces = 2; ///< surfaces that the light may touch; 1: there is none of it
  std::size_t paths = 16;  ///< per point
  std::uint64_t seed = 0;
  const std::atomic<bool> *cancel = nullptr; ///< what is returned once it is true is of no use
};

/// A scene, its parts as the mesh has them, ready to be asked. Thread safe.
class BetweenLight {
public:
  virtual ~BetweenLight() = default;
  BetweenLight(const BetweenLight &) = delete;
  BetweenLight &operator=(const BetweenLight &) = delete;

  /// Radiance [1/sr] per unit irradiance that points send to the observer, who sees them, after
  /// more than one surface, in the scattering plane: the mean of the paths of each, [point * nodes
  /// of the scene's grid + node]. `first`: number of the first point, so that no two draw alike.
  [[nodiscard]] virtual std::vector<Stokes<ScatteringPlane>>
  radiance(const Pose &pose, std::span<const SurfacePoint> points,
           const BetweenLightOptions &options, std::uint64_t first) const = 0;

protected:
  BetweenLight() = default;
};

/// That of a scene. Throws Failure (Interrupted) once `cancel` became true.
std::unique_ptr<BetweenLight> make_between_light(const Scene &scene,
                                                 const std::atomic<bool> *cancel = nullptr);

} // namespace umov
