#pragma once
// Private: the materials for which chains are drawn, on one mesh.

#include "light/between/chain_surfaces.h"

#include <memory>
#include <umov/scene/scene.h>

namespace umov {

/// One set of materials or several, the members, whose chains are the same: at each surface they go
/// on as one of the members would have it, each as often. Slots that are alike in all members are
/// of one kind.
class ChainCover {
public:
  /// Meshes, of which only that of the first is used elsewhere, and slots must be the same.
  explicit ChainCover(const std::vector<const Scene *> &scenes);

  [[nodiscard]] std::size_t members() const { return members_.size(); }
  /// Materials of a member, without a mesh.
  [[nodiscard]] const Scene &sides(std::size_t member) const { return members_[member]->sides; }
  [[nodiscard]] const ChainSurfaces &surfaces(std::size_t member) const {
    return members_[member]->surfaces;
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

  /// Whether chains drawn for this cover tell the light of other materials, too: nowhere do these
  /// scatter much more than those of some member do. Below, few chains would carry most of it.
  [[nodiscard]] bool serves(const Scene &scene, const ChainSurfaces &surfaces) const;

private:
  struct Member {
    Scene sides;
    ChainSurfaces surfaces;
    explicit Member(const Scene &of);
  };
  [[nodiscard]] bool has_kinds_of(const Scene &scene, const ChainSurfaces &surfaces) const;

  std::vector<std::unique_ptr<const Member>> members_;
  std::vector<std::uint32_t> kind_, slot_;
  std::vector<std::vector<Sampler>> samplers_;         ///< per kind
  std::vector<std::vector<std::uint32_t>> of_members_; ///< per kind: that of each member
  std::vector<char> is_any_;                           ///< [kind * kinds + kind]
};

} // namespace umov
