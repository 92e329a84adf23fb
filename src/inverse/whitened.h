#pragma once
// Private: a curve and light that adds up, as rows of equal weight.

#include <Eigen/Core>
#include <umov/inverse/unmix.h>

namespace umov::inverse {

/// Everything whitened: rows of I, then of Q - q I and U - u I.
struct Whitened {
  Eigen::MatrixXd columns;
  Eigen::VectorXd right;
  std::size_t measurements = 0, left_out = 0;
};

/// I and, where q and u were measured, Q - q I and U - u I: linear in the members.
Whitened whitened(const ObservedCurve &curve, CurveErrors errors,
                  const std::vector<EndMember> &members);

} // namespace umov::inverse
