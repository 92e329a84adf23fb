#pragma once
// Private: a curve and light that adds up, as rows of equal weight.

#include <Eigen/Core>
#include <umov/inverse/unmix.h>

namespace umov::inverse {

/// Everything whitened: rows of I, then of Q - q I and U - u I; or of electrons, where counts were
/// measured and polarization is used.
struct Whitened {
  Eigen::MatrixXd columns;
  Eigen::VectorXd right;
  std::size_t measurements = 0, left_out = 0;
  /// Of each member: its light stands out of the errors of I, or of electrons. How well the zero
  /// points are known is no part of that: whatever they are, light is light.
  std::vector<bool> shows;
  Eigen::VectorXd lengths; ///< of the columns, as they are without zero points
};

/// Counts as they are: the electrons of each channel are linear in the members, whatever the body
/// did between one analyser and the next. Their variances are those of `about`.
///
/// Else I and, where q and u were measured, Q - q I and U - u I: linear in the members. Such rows
/// pull the scale down, since 0 solves those of q and u and noise of I tilts what a zero point
/// moves. With the scaled light of a fit (`about`) they are those of a Gauss-Newton step from
/// there: q and u themselves, which do not depend on the scale, and zero points of the light that
/// was fitted; or of `zeros`, where chi-squares of different light are compared.
Whitened whitened(const ObservedCurve &curve, CurveErrors errors,
                  const std::vector<EndMember> &members, const EndMember *about = nullptr,
                  const EndMember *zeros = nullptr);
/// Members added up, so much of each.
EndMember added_up(const std::vector<EndMember> &members, const Eigen::VectorXd &parts);

/// Rounds of such steps: each takes off nearly all of what the last one left.
inline constexpr int refinements = 4;

} // namespace umov::inverse
