#include "paper/plane_fit.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace umov {

double PlaneFit::distance(const QPoint &p) const {
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k)
    out += normal[k] * (p[k] - centre[k]);
  return out;
}

PlaneFit fit_plane(std::span<const QPoint> points) {
  PlaneFit out;
  if (points.empty())
    return out;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const QPoint &p : points)
    mean += Eigen::Vector3d(p[0], p[1], p[2]);
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const QPoint &p : points) {
    const Eigen::Vector3d d = Eigen::Vector3d(p[0], p[1], p[2]) - mean;
    spread += d * d.transpose();
  }
  spread /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread); // smallest first
  Eigen::Vector3d normal = axes.eigenvectors().col(0);
  if (normal[1] < 0)
    normal = -normal;
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out.centre[at] = mean[k];
    out.normal[at] = normal[k];
    out.rms[at] = std::sqrt(std::max(0., axes.eigenvalues()[2 - k]));
  }
  out.offset = normal.dot(mean);
  return out;
}

std::vector<double> relative_singular_values(const std::vector<std::vector<double>> &rows) {
  if (rows.empty())
    return {};
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows.size()),
                    static_cast<Eigen::Index>(rows.front().size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index k = 0; k < m.cols(); ++k)
      m(i, k) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(m);
  std::vector<double> out;
  for (const double s : svd.singularValues())
    out.push_back(s / svd.singularValues()[0]);
  return out;
}

double nearest_neighbour_confusion(std::span<const QPoint> a, std::span<const QPoint> b) {
  const auto nearest = [](const QPoint &p, std::span<const QPoint> cloud) {
    double out = std::numeric_limits<double>::infinity();
    for (const QPoint &q : cloud) {
      if (&q == &p)
        continue;
      const double x = q[0] - p[0], y = q[1] - p[1], z = q[2] - p[2];
      out = std::min(out, x * x + y * y + z * z);
    }
    return out;
  };
  std::size_t confused = 0;
  for (const QPoint &p : a)
    confused += nearest(p, b) < nearest(p, a) ? 1u : 0u;
  for (const QPoint &p : b)
    confused += nearest(p, a) < nearest(p, b) ? 1u : 0u;
  const std::size_t all = a.size() + b.size();
  return all > 0 ? static_cast<double>(confused) / static_cast<double>(all) : 0;
}

} // namespace umov
