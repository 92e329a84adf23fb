#pragma once
// Private: light of an object whose attitude is known, with a part of it of another material.

#include <umov/inverse/unmix.h>
#include <umov/jobs/invert.h>
#include <umov/light/light_model.h>

namespace umov::jobs {

/// A group of one material; no group: as the scenario has it.
struct GroupMaterial {
  std::string group, material;
  bool operator==(const GroupMaterial &) const = default;
};

/// Light of the object in its attitude, with the group of one material. Chains of light between
/// surfaces, where the scenario asks for them, are drawn once for all materials.
class GroupLight {
public:
  /// `all`: what will be asked for.
  GroupLight(const Scenario &scenario, const InvertRequest &request,
             const ObservedLightCurve &observed, const JobOptions &options,
             std::vector<GroupMaterial> all)
      : scenario_(scenario), request_(request), observed_(observed), options_(options),
        all_(std::move(all)) {}

  /// `turn`: of the body out of its attitude [rad].
  Result<EndMember> of(const GroupMaterial &part, const Monitor &monitor, Vec3<Body> turn = {});
  /// How the object was lit, of the last call; of the call that left its cards if one did.
  [[nodiscard]] const ManifestInput::Light &used() const { return used_; }

  /// What of it serves other observations of the same object.
  struct Kept {
    GroupMaterial part;
    std::shared_ptr<const LightModel> model;
  };
  [[nodiscard]] const Kept &kept() const { return first_; }
  void take(const Kept &earlier) { first_ = earlier; }

private:
  Result<Scenario> with(const GroupMaterial &part) const;
  [[nodiscard]] bool has_chains() const;
  Result<ChainFamily> family(const GroupMaterial &part, const Monitor &monitor) const;

  const Scenario &scenario_;
  const InvertRequest &request_;
  const ObservedLightCurve &observed_;
  const JobOptions &options_;
  std::vector<GroupMaterial> all_;
  Kept first_; ///< whose chains the others take
  ManifestInput::Light used_;
};

} // namespace umov::jobs
