#pragma once
// Where on the surface paths begin: by area at first, then where they were found to carry light.

#include <cstdint>
#include <span>
#include <vector>

namespace umov {

/// Neighbouring triangles that are learnt about together.
struct AreaGroups {
  std::vector<std::uint32_t> of; ///< per triangle
  std::size_t count = 0;
};

/// What is known of where light is found.
struct LearntAreas {
  std::vector<double> squares; ///< per group: sum of (light times density)^2
  std::vector<double> drawn;   ///< per group
  void add(const LearntAreas &other, double share);
};

/// Draws triangles of one side of a pose (those that face the Sun, or the observer) with a
/// probability per group that is learnt, and even over the area within a group. Every triangle
/// keeps a share by area, so that nothing is overlooked for ever.
class AreaChoice {
public:
  /// `triangles` in order; `area_m2` of all triangles of the mesh.
  AreaChoice(std::vector<std::uint32_t> triangles, std::span<const double> area_m2,
             const AreaGroups &groups);

  [[nodiscard]] bool is_empty() const { return triangle_.empty(); }
  /// The triangle at x in [0, 1) of the distribution. Not for an empty choice.
  [[nodiscard]] std::uint32_t at(double x) const;
  /// [1/m2] on a triangle; 0 where it cannot be drawn.
  [[nodiscard]] double density(std::uint32_t triangle) const {
    return density_[groups_->of[triangle]];
  }
  /// A path begun on a triangle carried `light` (0 counts too), divided by the density.
  void learn(std::uint32_t triangle, double light);
  /// Takes what was learnt before, and begins anew to learn.
  void start_from(const LearntAreas &other);
  /// Since the start.
  [[nodiscard]] const LearntAreas &learnt() const { return learnt_; }

private:
  /// The probabilities follow what was learnt (Neyman 1934: a stratum's share goes with
  /// its size times the rms of the integrand).
  void adapt();
  void tabulate();

  const AreaGroups *groups_;
  std::span<const double> area_m2_;
  std::vector<std::uint32_t> triangle_;
  std::vector<double> end_;          ///< probability up to and with each triangle
  std::vector<std::uint32_t> start_; ///< per even share of the distribution: where to look from
  std::vector<double> area_;         ///< per group, of the triangles that can be drawn
  std::vector<double> density_;      ///< per group
  LearntAreas learnt_, before_;
  double whole_area_ = 0;
};

} // namespace umov
