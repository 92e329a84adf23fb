#pragma once
// The fast path for an object whose parts turn.

#include <memory>
#include <span>
#include <umov/light/engine.h>
#include <umov/scene/articulation.h>

namespace umov {

/// Each rigid part has masks of its own, which stay right while it turns; what one part hides of
/// another is traced, for the classes that another part may come before. Some
/// thousand poses per second and core where parts hide each other.
class ArticulatedEngine {
public:
  /// `joints` have passed check_joints for the scene's mesh. Throws as Engine.
  ArticulatedEngine(const Scene &scene, const std::vector<Joint> &joints,
                    const EngineOptions &options, const std::atomic<bool> *cancel = nullptr);
  ~ArticulatedEngine();
  ArticulatedEngine(ArticulatedEngine &&) noexcept;
  ArticulatedEngine &operator=(ArticulatedEngine &&) noexcept;

  /// Stokes of every pose, directions in the body; angles [pose * joints + joint] [rad]. Thread
  /// safe; the same bits for any number of threads and any split of the poses.
  void evaluate(std::span<const Pose> poses, std::span<const double> angles_rad, StokesTable &out,
                unsigned threads = 1) const;
  /// The same with the columns that `task` asks for, as Engine::evaluate. False if cancelled.
  [[nodiscard]] bool evaluate(std::span<const Pose> poses, std::span<const double> angles_rad,
                              StokesTable &out, const LightTask &task,
                              std::span<const std::uint32_t> material_of = {}) const;
  /// Memory of the masks of all parts.
  [[nodiscard]] std::size_t mask_bytes() const;
  /// As Engine::keep_masks, for each part.
  void keep_masks() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace umov
