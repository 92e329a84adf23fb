#pragma once
#include <array>
#include <span>
#include <vector>

namespace umov {

/// Points (Q blue, Q green, Q red).
using QPoint = std::array<double, 3>;

/// Best plane through points in the sense of least squares.
struct PlaneFit {
  QPoint centre{}, normal{};   ///< unit; its green part positive
  std::array<double, 3> rms{}; ///< along the principal axes, largest first; the last is off plane
  double offset = 0;           ///< normal . centre: 0 for a plane through the origin
  [[nodiscard]] double thickness() const { return rms[0] > 0 ? rms[2] / rms[0] : 0; }
  [[nodiscard]] double distance(const QPoint &p) const;
};
PlaneFit fit_plane(std::span<const QPoint> points);

/// Singular values of rows of any length (mean not removed), over the largest; largest first.
std::vector<double> relative_singular_values(const std::vector<std::vector<double>> &rows);

/// Share of points of two clouds whose nearest other point is of the other cloud: 0 where they do
/// not overlap, about one half where they are the same.
double nearest_neighbour_confusion(std::span<const QPoint> a, std::span<const QPoint> b);

} // namespace umov
