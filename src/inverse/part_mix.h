#pragma once
// Private: the light of a body whose parts give more or less of it than the model says.

#include <umov/inverse/likelihood.h>
#include <vector>

namespace umov::inverse {

/// Equation 4b of docs/theory/inverse.md at one attitude. Unknowns are in units of their standard
/// deviations: first ln of the amounts of all parts, then ln of the slopes of those that have some.
class PartMix {
public:
  /// Part and whether it is its slope.
  struct Unknown {
    std::size_t part = 0;
    bool is_slope = false;
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
  /// Derivative of the ln of that with the slope's unknown.
  [[nodiscard]] const std::vector<double> &by_slope() const { return by_slope_; }

private:
  void put_slopes();
  ModelLight model_;
  std::size_t cells_;
  std::vector<std::size_t> lit_; ///< cells with light: of a few epochs, few
  std::vector<Unknown> unknowns_;
  /// ln I(y)/I(0) = first y + second y^2, y the slope's unknown: [part * cells + cell].
  std::vector<double> first_, second_;
  std::vector<double> factor_, by_slope_;
  std::vector<double> i_, q_, u_;
};

} // namespace umov::inverse
