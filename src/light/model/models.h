#pragma once
// Private: the models that make_light chooses from.

#include "light/model/curved_errors.h"
#include "light/model/ray_tracer.h"

#include <chrono>
#include <umov/light/articulated_engine.h>
#include <umov/light/engine.h>

namespace umov {

/// What the accuracy at each node refers to at least, from the typical light; empty: 0.
std::vector<double> floor_of(const LightOptions &options, const std::vector<double> &typical_i);

/// Each pose by rays, with light between surfaces where it is asked for.
class RaysLight final : public LightModel {
public:
  RaysLight(const Scene &scene, std::vector<Joint> joints, const LightOptions &options,
            const std::vector<double> &typical_i, const std::atomic<bool> *cancel,
            ChainSharing chains = {});
  [[nodiscard]] std::shared_ptr<const Integrator>
  chain_drawer(const std::atomic<bool> *cancel) const override {
    return rays_.chain_drawer(cancel);
  }

private:
  bool light(std::span<const Pose> poses, std::span<const double> angles_rad, StokesTable &out,
             const LightTask &task) const override;
  RayTracer rays_;
};

/// Masks; with LightMethod::Auto mended by rays, class by class and pose by pose.
class MasksLight final : public LightModel {
public:
  /// `unhidden`: the engine without visibility; null where half-widths are not asked for.
  static Result<std::unique_ptr<LightModel>>
  make(const Scene &scene, std::vector<Joint> joints, const LightOptions &options,
       const std::vector<double> &typical_i, const Engine *unhidden,
       std::chrono::steady_clock::time_point begin, const std::atomic<bool> *cancel,
       ChainSharing chains = {});
  [[nodiscard]] std::shared_ptr<const Integrator>
  chain_drawer(const std::atomic<bool> *cancel) const override {
    return between_ ? between_->chain_drawer(cancel) : nullptr;
  }
  [[nodiscard]] Result<void> keep_masks() const override;
  void take_masks_of(const LightModel &elder) const override;
  /// Null for a body whose parts turn.
  [[nodiscard]] const Engine *engine() const { return engine_ ? &*engine_ : nullptr; }
  [[nodiscard]] std::size_t mask_bytes() const override;
  [[nodiscard]] std::string device() const override;
  [[nodiscard]] std::string instruction_set() const override;
  [[nodiscard]] std::string lit_by() const override;

private:
  MasksLight(const Scene &scene, std::vector<Joint> joints, const LightOptions &options,
             const std::vector<double> &typical_i, const Engine *unhidden,
             const std::atomic<bool> *cancel);
  Result<void> prepare(std::chrono::steady_clock::time_point begin, const std::atomic<bool> *cancel,
                       ChainSharing chains);
  bool light(std::span<const Pose> poses, std::span<const double> angles_rad, StokesTable &out,
             const LightTask &task) const override;
  Result<void> take_device();
  [[nodiscard]] std::vector<std::size_t> inaccurate(const StokesTable &table) const;

  LightOptions options_;
  std::vector<double> floor_i_;        ///< what the accuracy refers to at least, per node
  std::optional<CurvedErrors> curved_; ///< where half-widths are asked for
  std::vector<std::uint32_t> material_of_;
  std::optional<Engine> engine_;             ///< of a body whose parts do not turn
  std::optional<ArticulatedEngine> turning_; ///< of one whose parts do
  std::optional<RayTracer> direct_;          ///< for poses that miss the accuracy
  std::optional<RayTracer> between_;         ///< for light of more than one surface
};

} // namespace umov
