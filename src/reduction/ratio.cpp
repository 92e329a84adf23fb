#include <umov/reduction/ratio.h>

#include <cmath>

namespace umov {
namespace {

double contrast(const BeamPair &b) {
  return (b.ordinary - b.extraordinary) / (b.ordinary + b.extraordinary);
}

} // namespace

double ratio_method(const BeamPair &a, const BeamPair &b) {
  const double r = std::sqrt(a.ordinary / a.extraordinary * b.extraordinary / b.ordinary);
  return (r - 1) / (r + 1);
}

double double_difference(const BeamPair &a, const BeamPair &b) {
  return (contrast(a) - contrast(b)) / 2;
}

EightPositions eight_positions(const std::array<BeamPair, 8> &b) {
  const double q1 = ratio_method(b[0], b[2]), q2 = ratio_method(b[4], b[6]);
  const double u1 = ratio_method(b[1], b[3]), u2 = ratio_method(b[5], b[7]);
  return {(q1 + q2) / 2, (u1 + u2) / 2, (q1 - q2) / 2, (u1 - u2) / 2};
}

} // namespace umov
