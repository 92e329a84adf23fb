#pragma once
// Private: the materials for which chains are drawn, on one mesh.

#include "light/between/chain_surfaces.h"

#include <memory>
#include <optional>
#include <umov/scene/scene.h>

namespace umov {

/// One set of materials: what each slot is of, without regard to its mesh. The scene must live.
struct ChainMember {
  const Scene *sides = nullptr;
  std::shared_ptr<const ChainSurfaces> surfaces; ///< of the scene
};

/// One set of materials or several, the members, whose chains are the same: at each surface they go
/// on in a way that one of the members has, each such way as often, however many have it. Slots
/// that are alike in all members are of one kind. What is drawn does not depend on the order in
/// which the members come.
class ChainCover {
public:
  /// Slots must be the same. Throws Failure (Interrupted) once `cancel`, which may be null, became
  /// true.
  ChainCover(std::vector<ChainMember> members, const std::atomic<bool> *cancel);

  [[nodiscard]] std::size_t members() const { return members_.size(); }
  [[nodiscard]] const Scene &sides(std::size_t member) const { return *members_[member].sides; }
  [[nodiscard]] const ChainSurfaces &surfaces(std::size_t member) const {
    return *members_[member].surfaces;
  }
  [[nodiscard]] std::uint32_t kind_of(std::uint32_t slot) const { return kind_[slot]; }
  /// A slot of each kind.
  [[nodiscard]] const std::vector<std::uint32_t> &slots() const { return slot_; }
  /// How the members draw, each way once.
  [[nodiscard]] const std::vector<Sampler> &samplers(std::uint32_t slot) const {
    return samplers_[kind_[slot]];
  }
  [[nodiscard]] Direction draw(std::uint32_t slot, Vec3<Body> normal, Vec3<Body> from,
                               const std::array<double, 4> &u) const;
  /// Chains draw some light between two kinds, of some member.
  [[nodiscard]] bool is_any(std::uint32_t a, std::uint32_t b) const {
    return is_any_[a * slot_.size() + b] != 0;
  }
  /// ChainSurfaces::strength of a member.
  [[nodiscard]] double strength(std::size_t member, std::uint32_t kind, double cosine) const {
    return surfaces(member).strength(of_members_[kind][member], cosine);
  }

  /// Which member is of the same materials at the same wavelengths.
  [[nodiscard]] std::optional<std::size_t> member_like(const Scene &scene) const;
  /// Slots that chains do not tell apart are alike in other materials, too, and what chains left to
  /// paths stays there; nowhere do these send light where that of no member goes on.
  [[nodiscard]] bool has_kinds_of(const Scene &scene, const ChainSurfaces &surfaces) const;
  /// In no direction, and in no band, do other materials scatter more of a slot's light than `most`
  /// times what some member does in the mean of its bands. Asked of some directions.
  [[nodiscard]] bool is_within(const Scene &scene, std::uint32_t slot, double most) const;

private:
  std::vector<ChainMember> members_;
  std::vector<std::uint32_t> kind_, slot_;
  std::vector<std::vector<Sampler>> samplers_;         ///< per kind
  std::vector<std::vector<std::uint32_t>> of_members_; ///< per kind: that of each member
  std::vector<char> is_any_;                           ///< [kind * kinds + kind]
};

} // namespace umov
