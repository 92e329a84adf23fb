#pragma once
// Private: the reference path as models use it.

#include <memory>
#include <mutex>
#include <umov/light/integrator.h>
#include <umov/light/light_model.h>

namespace umov {

/// What all rays of a model share: its options as the reference takes them.
IntegrationOptions integration_of(const LightOptions &options, std::vector<double> floor_i);

/// Index into `names` of the surface of each slot of a scene.
std::vector<std::uint32_t> material_of_slots(const Scene &scene,
                                             const std::vector<std::string> &names);

/// The scene of one pose of a table of angles: the mesh of an object whose parts turn is another
/// one at every pose.
Scene turned(const Scene &scene, const std::vector<Joint> &joints,
             std::span<const double> angles_rad, std::size_t pose);

/// Poses by the reference path, some of a batch or all of it. `scene` and `joints` must live.
class RayTracer {
public:
  RayTracer(const Scene &scene, const std::vector<Joint> &joints, IntegrationOptions options,
            const std::vector<std::string> &materials, ChainSharing chains = {});
  /// Fills the rows `which` of a table of all poses; false if it was cancelled.
  [[nodiscard]] bool light(std::span<const Pose> poses, std::span<const double> angles_rad,
                           std::span<const std::size_t> which, StokesTable &out,
                           const LightTask &task) const;
  /// Adds the light of more than one surface to direct light in `out`; false if it was cancelled.
  [[nodiscard]] bool add_indirect(std::span<const Pose> poses, std::span<const double> angles_rad,
                                  StokesTable &out, const LightTask &task) const;
  /// Throws as Engine.
  [[nodiscard]] bool is_convex(const std::atomic<bool> *cancel) const {
    return joints_.empty() && integrator(cancel).is_convex();
  }

  /// Null where parts turn. Throws as Engine.
  [[nodiscard]] std::shared_ptr<const Integrator>
  chain_drawer(const std::atomic<bool> *cancel) const {
    if (!joints_.empty())
      return nullptr;
    (void)integrator(cancel); // made by whoever asks first
    return integrator_;
  }

private:
  /// Of a body whose parts do not turn; made when a pose first needs it: ray tree and elements cost
  /// more than all poses of a job that masks light. Throws as Engine; the next one makes it then.
  [[nodiscard]] const Integrator &integrator(const std::atomic<bool> *cancel) const;
  void put(const PoseResult &result, std::size_t row, StokesTable &out) const;

  const Scene &scene_;
  const std::vector<Joint> &joints_;
  IntegrationOptions options_;
  std::vector<std::uint32_t> material_of_;
  std::size_t materials_;
  ChainSharing chains_;
  mutable std::once_flag is_made_;
  mutable std::shared_ptr<const Integrator> integrator_;
};

} // namespace umov
