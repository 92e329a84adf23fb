#pragma once
// Private: the distinct surfaces of a scene as ends of chains.

#include "backend/chain_data.h"
#include "light/between/directions.h"

#include <atomic>
#include <umov/scene/scene.h>
#include <unordered_map>
#include <vector>

namespace umov {

/// Who draws the light that enters at one surface and leaves at another.
enum class ChainPart : std::uint8_t {
  Whole,        ///< chains
  WithoutLobes, ///< chains, but for the lobe of one seen by the lobe of the other: both are narrow
  Nothing       ///< paths: a mirror, a measured surface, or a lobe too narrow for either
};

/// Compiled surfaces, each counted once, with how finely they scatter and, where there is one, the
/// form in which the vector unit computes them.
class ChainSurfaces {
public:
  /// `scene` must live. Throws Failure (Interrupted) once `cancel`, which may be null, became true.
  explicit ChainSurfaces(const Scene &scene, const std::atomic<bool> *cancel = nullptr);
  /// Those of another scene, known to be of the same materials slot by slot: nothing is tabulated.
  ChainSurfaces(const ChainSurfaces &known, const Scene &of_known, const Scene &scene);
  [[nodiscard]] std::uint32_t kind_of(const Surface *surface) const { return kind_.at(surface); }
  [[nodiscard]] std::size_t size() const { return surface_.size(); }
  [[nodiscard]] const Surface &surface(std::uint32_t kind) const { return *surface_[kind]; }
  [[nodiscard]] ChainPart part(std::uint32_t a, std::uint32_t b) const;
  /// Some light that enters or leaves there is left to paths.
  [[nodiscard]] bool leaves_any(std::uint32_t kind) const { return leaves_any_[kind] != 0; }
  /// What paths have to draw besides.
  [[nodiscard]] bool needs_paths() const { return needs_paths_; }
  /// Some light can be drawn by chains at all.
  [[nodiscard]] bool has_any() const { return has_any_; }
  /// Per kind and band; `is_fast` of a kind says whether it holds.
  [[nodiscard]] bool is_fast(std::uint32_t kind) const { return is_fast_[kind] != 0; }
  /// Of all that can be an end of a chain.
  [[nodiscard]] bool are_fast() const { return are_fast_; }
  /// It has a lobe that is fairly narrow.
  [[nodiscard]] bool is_narrow(std::uint32_t kind) const;
  /// All that can be an end have, and no other light.
  [[nodiscard]] bool are_narrow() const { return are_narrow_; }
  [[nodiscard]] const std::vector<backend::ChainSurface> &fast() const { return fast_; }
  /// rms over all bands and outer directions of what an end scatters per solid angle, by the cosine
  /// between its normal and the chain.
  [[nodiscard]] double strength(std::uint32_t kind, double cosine) const {
    return at_cosine(strength_[kind], cosine);
  }
  /// The same of one band.
  [[nodiscard]] double strength(std::uint32_t kind, double cosine, std::size_t band) const {
    return at_cosine(strength_of_band_[kind][band], cosine);
  }

private:
  void tabulate_strength(std::size_t bands, const std::atomic<bool> *cancel);
  std::vector<const Surface *> surface_;
  std::unordered_map<const Surface *, std::uint32_t> kind_;
  std::vector<char> is_fast_, leaves_any_;
  std::vector<backend::ChainSurface> fast_;
  using ByCosine = std::vector<double>;
  static double at_cosine(const ByCosine &table, double cosine);
  std::vector<ByCosine> strength_;                      ///< per kind
  std::vector<std::vector<ByCosine>> strength_of_band_; ///< per kind and band
  bool needs_paths_ = false, has_any_ = false, are_fast_ = false, are_narrow_ = false;
};

} // namespace umov
