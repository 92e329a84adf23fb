#pragma once
// Private: light of an object whose attitude is known, at given times.

#include <optional>
#include <span>
#include <umov/inverse/unmix.h>
#include <umov/io/run_folder.h>
#include <umov/io/scenario.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <umov/light/light_model.h>

namespace umov::jobs {

/// When and how a scenario's object is lit.
struct KnownLightRequest {
  std::span<const ObservingGeometry> geometry; ///< where it was
  std::span<const std::size_t> column;         ///< bands that are wanted, of the scenario's
  std::optional<LightMethod> method;           ///< in place of the scenario's
  Vec3<Body> turn{};                           ///< of the body out of its attitude [rad]
  ChainFamily chains = {};                     ///< of a model that is made
  /// By which it is lit; null: one is made, and put here.
  std::shared_ptr<const LightModel> *model = nullptr;
};
/// Light of the first object of a scenario in the scenario's attitude, without a name; `used`: how
/// it was lit, of the last call, or of the call that left its cards if one did.
Result<EndMember> known_light(const Scenario &scenario, const KnownLightRequest &request,
                              const JobOptions &options, const Monitor &monitor,
                              ManifestInput::Light &used);

} // namespace umov::jobs
