#pragma once
// An object of a scenario, lit from any direction.

#include <memory>
#include <span>
#include <string>
#include <umov/jobs/signature.h>
#include <umov/light/light_model.h>
#include <vector>

namespace umov::jobs {

/// What `signature` asks for its rows: the scenario's object read, compiled and ready for
/// directions, its parts turned as far as directions tell. Thread safe.
class PoseLight {
public:
  /// Usage or BadInput for what does not go together, before anything is read.
  static Result<void> check(const Scenario &scenario, const SignatureRequest &request);
  /// Checks, reads and compiles. Usage for what does not go together; warns of parts that cannot
  /// turn here; Interrupted once `cancel` became true. `poses_in_all`: IntegrationOptions'.
  static Result<PoseLight> make(const Scenario &scenario, const SignatureRequest &request,
                                const JobOptions &options, Diagnostics &diagnostics,
                                const std::atomic<bool> *cancel = nullptr,
                                std::size_t poses_in_all = 0);
  /// The object that `read` lights, lit another way: neither read nor told of once more. `scenario`
  /// must name the same one. Errors as `make`.
  static Result<PoseLight> again(const PoseLight &read, const Scenario &scenario,
                                 const SignatureRequest &request, const JobOptions &options,
                                 const std::atomic<bool> *cancel = nullptr);
  PoseLight(PoseLight &&) noexcept;
  PoseLight &operator=(PoseLight &&) noexcept;
  ~PoseLight();

  /// Stokes of every pose, whose Sun is as large as `sun_radius_rad` says. False if `task.cancel`
  /// became true.
  [[nodiscard]] bool evaluate(std::span<const Pose> poses, StokesTable &out,
                              const LightTask &task) const;
  /// Poses that `signature` lights together. Light between surfaces is shared by the poses of a
  /// block, so that its bytes come again only with blocks of this length from the first pose on.
  [[nodiscard]] std::size_t block() const;
  /// Angular radius of the source for a pose without an orbit [rad]; 0: a point.
  [[nodiscard]] double sun_radius_rad() const;
  /// The model behind it: bands, mesh, facts, masks.
  [[nodiscard]] const LightModel &model() const;
  /// How it is lit: what the request says over what the scenario says.
  [[nodiscard]] const LightOptions &options() const;
  /// Files that were read.
  [[nodiscard]] const std::vector<InputFile> &inputs() const;

private:
  struct State;
  static Result<PoseLight> of(const Scene &scene, std::vector<InputFile> inputs,
                              const Scenario &scenario, const SignatureRequest &request,
                              LightOptions light, Diagnostics &diagnostics,
                              const std::atomic<bool> *cancel);
  explicit PoseLight(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

} // namespace umov::jobs
