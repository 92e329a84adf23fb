#pragma once
// Private: light of an object whose attitude is known, with a part of it of another material.

#include <umov/inverse/unmix.h>
#include <umov/jobs/invert.h>

namespace umov::jobs {

/// Light of the object in its attitude, with the group of one material.
class GroupLight {
public:
  GroupLight(const Scenario &scenario, const InvertRequest &request,
             const ObservedLightCurve &observed, const JobOptions &options)
      : scenario_(scenario), request_(request), observed_(observed), options_(options) {}

  /// `group` empty: as the scenario has it. `turn`: of the body out of its attitude [rad].
  Result<EndMember> of(const std::string &group, const std::string &material,
                       const Monitor &monitor, Vec3<Body> turn = {});
  /// How the object was lit, of the last call; of the call that left its cards if one did.
  [[nodiscard]] const ManifestInput::Light &used() const { return used_; }

private:
  Result<Scenario> with(const std::string &group, const std::string &material) const;

  const Scenario &scenario_;
  const InvertRequest &request_;
  const ObservedLightCurve &observed_;
  const JobOptions &options_;
  ManifestInput::Light used_;
};

} // namespace umov::jobs
