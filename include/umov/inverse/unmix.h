#pragma once
// How much of each material: docs/theory/inverse.md, section 9.

#include <span>
#include <string>
#include <umov/inverse/likelihood.h>
#include <vector>

namespace umov {

/// Light of the whole object if a part of it were of one material: [epoch * bands + band].
struct EndMember {
  std::string name;
  std::vector<double> i, q, u;
};

/// Materials that the data cannot tell apart, as one.
struct UnmixedGroup {
  std::vector<std::string> names;
  /// Of the part's area; NaN: the data hold no light. The error has in it that nobody knows which
  /// of the names gives the light: of a dim one it takes more.
  double fraction = 0, fraction_err = 0;
  /// Smallest change of the fraction that shows at three standard deviations of the noise; NaN:
  /// none does.
  double detectable = 0;
};

/// What a part consists of.
struct Unmixing {
  std::vector<UnmixedGroup> groups; ///< in the order of their first members
  double chi2 = 0, scale = 1;
  std::size_t measurements = 0;
  std::size_t left_out = 0; ///< samples whose q and u stand without an I above 0: they say nothing
  EndMember fitted;         ///< light of the mixture, in the model's units
  std::vector<double> covariance; ///< of the fractions that are known [row * n + column]
  double condition = 1; ///< of the end members, whitened and of unit length, before any was joined;
                        ///< NaN: one gives no light
};

/// Least squares with fractions of 0 or more (Lawson & Hanson 1974, chapter 23). I and, where q and
/// u were measured, Q - q I and U - u I, which are linear in the fractions and free of the error of
/// I. The sky is taken for clear. End members are joined where a pair's condition is above 200 or
/// where three standard deviations do not part them, whatever the scale. Of one that as much of
/// as of all others would not be seen nothing is known: its fraction is NaN, and the others' are of
/// what is left.
Unmixing unmix(const ObservedCurve &curve, const CurveErrors &errors,
               const std::vector<EndMember> &members);

/// x >= 0 that minimises |a x - b|, a column by column.
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>> &columns,
                                               std::span<const double> right);

} // namespace umov
