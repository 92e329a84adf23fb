#pragma once
// The one way from poses to geometric sums, which every set of materials and bands is applied to.

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <umov/light/abundances.h>
#include <umov/light/device.h>
#include <umov/light/light_model.h>
#include <umov/scene/pose.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// How the sums of an object are made.
struct SumsOptions {
  /// Typical error of I that its masks are made for, and no pose is mended by rays. Absent: fast
  /// masks (0.2 to 0.5 %), poses that they leave uncertain mended.
  std::optional<double> accuracy = {};
  /// In parts of the object's typical light (`typical_light`): where poses are mended, below it I
  /// need not be known any better than at it. 0: everywhere to its own size.
  double accuracy_floor = 0;
  /// Rays are spent as poses far apart need them, sparingly.
  bool is_for_many_poses = false;
  /// Other materials on the same mesh that the sums must serve exactly too.
  std::vector<Scene> hypotheses = {};
  std::filesystem::path mask_cache = {}; ///< folder of masks of earlier jobs; empty: none are kept
  unsigned threads = 0;                  ///< of the preparation; 0: all cores
  DeviceOptions device = {};             ///< who adds up; Auto: cards if they take the scene
};

/// An object ready to be summed from any direction of sunlight, its parts as the mesh has them.
/// Thread safe.
class LightSums {
public:
  virtual ~LightSums() = default;
  LightSums(const LightSums &) = delete;
  LightSums &operator=(const LightSums &) = delete;

  /// Sums of every pose before any colour. BadInput if a material has none (measured or
  /// anisotropic surfaces: they are lit facet by facet); Interrupted if `cancel` became true, and
  /// the table is then of no use.
  virtual Result<void> evaluate(std::span<const Pose> poses, AbundanceTable &out,
                                unsigned threads = 1,
                                const std::atomic<bool> *cancel = nullptr) const = 0;
  /// What other materials and bands (of a scene with the same mesh groups) make of these sums.
  /// Their roughness and shadowing must be those of the object's own or of its hypotheses; BadInput
  /// says which is not. Body light of others is expressed in the profiles that there are: see
  /// MaterialTables::diffuse_error.
  [[nodiscard]] virtual Result<MaterialTables> tables_for(const Scene &materials) const = 0;
  /// Keeps what was learnt of the masks for later jobs (SumsOptions::mask_cache), in silence.
  virtual void keep_masks() const = 0;
  /// As LightModel::take_masks_of.
  virtual void take_masks_of(const LightModel &elder) const = 0;
  /// Names of cards; "cpu" and why where Auto took the processor, at first or in the end; empty:
  /// the processor.
  [[nodiscard]] virtual std::string device() const = 0;
  /// As LightModel::lit_by.
  [[nodiscard]] virtual std::string lit_by() const = 0;

protected:
  LightSums() = default;
};

/// The sums of a scene. Device where DeviceChoice::Cuda lacks something; Interrupted if `cancel`
/// became true; a card that is lost later throws Failure.
Result<std::unique_ptr<LightSums>> make_sums(const Scene &scene, const SumsOptions &options,
                                             const std::atomic<bool> *cancel = nullptr);

} // namespace umov
