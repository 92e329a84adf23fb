#include <cmath>
#include <umov/core/rotation.h>

namespace umov {

Quaternion quaternion_from_rows(const std::array<std::array<double, 3>, 3> &m) {
  const double trace = m[0][0] + m[1][1] + m[2][2];
  // Shepperd 1978: start from the largest of the four, so that no division is by a small number.
  std::array<double, 4> q{};
  const std::array<double, 4> squares{trace, m[0][0], m[1][1], m[2][2]};
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (squares[i] > squares[largest])
      largest = i;
  if (largest == 0) {
    q = {1 + trace, m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]};
  } else {
    const std::size_t i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    q[0] = m[j][k] - m[k][j];
    q[i + 1] = 1 + m[i][i] - m[j][j] - m[k][k];
    q[j + 1] = m[i][j] + m[j][i];
    q[k + 1] = m[i][k] + m[k][i];
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double scale = (q[0] < 0 ? -1 : 1) / length;
  return {q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale};
}

} // namespace umov
