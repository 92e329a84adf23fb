#pragma once
// Private: the light of a body whose parts give more or less of it than the model says.

#include <umov/inverse/likelihood.h>
#include <vector>

namespace umov::inverse {

/// Equation 4b of docs/theory/inverse.md at one attitude. Unknowns are in units of their standard
/// deviations: first ln of the amounts of all parts, then ln of the slopes of those that have some,
/// then the turns of the surfaces that have some about the three axes of the body.
class PartMix {
public:
  /// The amount of a part, or what bends the light of some with directions.
  struct Unknown {
    std::size_t part = 0;             ///< of an amount
    std::size_t first = 0, bends = 0; ///< none: it is an amount
  };
  /// What `model` looks at must outlive it.
  explicit PartMix(const ModelLight &model);
  [[nodiscard]] const std::vector<Unknown> &unknowns() const { return unknowns_; }
  /// Light with the parts so far off.
  void set(std::span<const double> off);
  /// That light: [epoch * bands + band].
  [[nodiscard]] const std::vector<double> &i() const { return i_; }
  [[nodiscard]] const std::vector<double> &q() const { return q_; }
  [[nodiscard]] const std::vector<double> &u() const { return u_; }
  /// What each part's light is multiplied by: [part * cells + cell].
  [[nodiscard]] const std::vector<double> &factor() const { return factor_; }
  /// Of each bend the part whose light it bends, and the derivative of the ln of that light:
  /// [bend * cells + cell].
  [[nodiscard]] const std::vector<std::size_t> &bent() const { return bent_; }
  [[nodiscard]] const std::vector<double> &bend() const { return bend_; }

private:
  void name_unknowns();
  std::size_t add_bend(std::size_t part);
  void put_slopes(std::size_t part);
  void put_tilt(std::size_t part, std::size_t axis);
  ModelLight model_;
  std::size_t cells_;
  std::vector<std::size_t> lit_; ///< cells with light: of a few epochs, few
  std::vector<Unknown> unknowns_;
  std::vector<std::size_t> bent_;
  /// ln I(y)/I(0) = first y + second y^2, y an unknown that bends: [bend * cells + cell].
  std::vector<double> first_, second_;
  std::vector<double> factor_, bend_, power_;
  std::vector<double> i_, q_, u_;
};

} // namespace umov::inverse
