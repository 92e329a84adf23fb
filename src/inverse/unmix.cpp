#include <umov/inverse/unmix.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace umov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Least squares over some of the columns; the others stay 0.
VectorXd solve_active(const MatrixXd &a, const VectorXd &b, const std::vector<bool> &is_active) {
  std::vector<Index> at;
  for (std::size_t k = 0; k < is_active.size(); ++k)
    if (is_active[k])
      at.push_back(static_cast<Index>(k));
  VectorXd out = VectorXd::Zero(a.cols());
  if (at.empty())
    return out;
  MatrixXd part(a.rows(), static_cast<Index>(at.size()));
  for (std::size_t k = 0; k < at.size(); ++k)
    part.col(static_cast<Index>(k)) = a.col(at[k]);
  const VectorXd x = part.colPivHouseholderQr().solve(b);
  for (std::size_t k = 0; k < at.size(); ++k)
    out[at[k]] = x[static_cast<Index>(k)];
  return out;
}

VectorXd nnls(const MatrixXd &a, const VectorXd &b) {
  const auto n = static_cast<std::size_t>(a.cols());
  std::vector<bool> is_active(n, false);
  VectorXd x = VectorXd::Zero(a.cols());
  const double tolerance = 1e-10 * (a.transpose() * b).cwiseAbs().maxCoeff();
  for (std::size_t round = 0; round < 3 * n + 10; ++round) {
    const VectorXd gradient = a.transpose() * (b - a * x);
    Index best = -1;
    for (Index k = 0; k < a.cols(); ++k)
      if (!is_active[static_cast<std::size_t>(k)] && gradient[k] > tolerance &&
          (best < 0 || gradient[k] > gradient[best]))
        best = k;
    if (best < 0)
      break;
    is_active[static_cast<std::size_t>(best)] = true;
    VectorXd wanted = solve_active(a, b, is_active);
    for (std::size_t inner = 0; inner < n + 1; ++inner) {
      double step = 1;
      for (Index k = 0; k < a.cols(); ++k)
        if (is_active[static_cast<std::size_t>(k)] && wanted[k] <= 0)
          step = std::min(step, x[k] / std::max(x[k] - wanted[k], 1e-300));
      x += step * (wanted - x);
      if (step >= 1)
        break;
      for (Index k = 0; k < a.cols(); ++k)
        if (is_active[static_cast<std::size_t>(k)] && x[k] <= 1e-14 * x.maxCoeff()) {
          is_active[static_cast<std::size_t>(k)] = false;
          x[k] = 0;
        }
      wanted = solve_active(a, b, is_active);
    }
  }
  return x.cwiseMax(0);
}

/// Everything whitened: rows of I, then of Q - q I and U - u I.
struct Whitened {
  MatrixXd columns;
  VectorXd right;
  std::size_t measurements = 0;
};

/// A zero point moves a band's I together: C = D + z^2 v v^T, of which the inverse root is a
/// projection along the whitened v.
void whiten_band(MatrixXd &columns, VectorXd &right, const std::vector<Index> &rows,
                 const VectorXd &v) {
  const double length2 = v.squaredNorm();
  if (!(length2 > 0))
    return;
  const double part = (1 - 1 / std::sqrt(1 + length2)) / length2;
  const auto take = [&](auto &&column) {
    double along = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      along += v[static_cast<Index>(k)] * column[rows[k]];
    for (std::size_t k = 0; k < rows.size(); ++k)
      column[rows[k]] -= part * along * v[static_cast<Index>(k)];
  };
  for (Index c = 0; c < columns.cols(); ++c)
    take(columns.col(c));
  take(right);
}

Whitened whitened(const ObservedCurve &curve, const CurveErrors &errors,
                  const std::vector<EndMember> &members) {
  const auto n = static_cast<Index>(members.size());
  const double median = CurveLikelihood(curve, errors).median_i();
  Whitened out;
  out.columns = MatrixXd::Zero(static_cast<Index>(3 * curve.samples.size()), n);
  out.right = VectorXd::Zero(out.columns.rows());
  std::vector<std::vector<Index>> rows(curve.bands.size());
  std::vector<std::vector<double>> common(curve.bands.size());
  Index row = 0;
  for (const ObservedSample &s : curve.samples) {
    const std::size_t at = s.epoch * curve.bands.size() + s.band;
    if (std::isnan(s.i) || !(s.i > 0 || s.i_sd > 0))
      continue;
    const double light = std::max(s.i, 0.0);
    const double floor = std::max(errors.floor, best_relative);
    const double sd = std::sqrt(s.i_sd * s.i_sd + std::pow(floor * light, 2) +
                                std::pow(errors.floor_median * median, 2));
    for (Index k = 0; k < n; ++k)
      out.columns(row, k) = members[static_cast<std::size_t>(k)].i[at] / sd;
    out.right[row] = s.i / sd;
    rows[s.band].push_back(row);
    common[s.band].push_back(errors.zero_point_sd * light / sd);
    ++row;
    ++out.measurements;
    if (!errors.has_polarization || std::isnan(s.q) || !(light > 0))
      continue;
    const double more = errors.floor * errors.floor / 4, least = best_relative * best_relative;
    const double q_sd = light * std::sqrt(std::max(s.cov_qq + more, least));
    const double u_sd = light * std::sqrt(std::max(s.cov_uu + more, least));
    for (Index k = 0; k < n; ++k) {
      const EndMember &m = members[static_cast<std::size_t>(k)];
      out.columns(row, k) = (m.q[at] - s.q * m.i[at]) / q_sd;
      out.columns(row + 1, k) = (m.u[at] - s.u * m.i[at]) / u_sd;
    }
    row += 2;
    out.measurements += 2;
  }
  out.columns.conservativeResize(row, n);
  out.right.conservativeResize(row);
  for (std::size_t b = 0; b < rows.size(); ++b)
    whiten_band(out.columns, out.right, rows[b],
                Eigen::Map<const VectorXd>(common[b].data(), static_cast<Index>(common[b].size())));
  return out;
}

/// Which end members the data hold apart: the number of each one's group.
std::vector<std::size_t> groups_of(const Whitened &w, double scale) {
  const auto n = static_cast<std::size_t>(w.columns.cols());
  std::vector<std::size_t> group(n);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      const VectorXd x = w.columns.col(static_cast<Index>(a)),
                     y = w.columns.col(static_cast<Index>(b));
      const double c = std::abs(x.dot(y)) / std::max(x.norm() * y.norm(), 1e-300);
      const double condition = std::sqrt((1 + c) / std::max(1 - c, 1e-300));
      const double apart = scale * x.norm() * std::sqrt(std::max(0.0, 1 - c * c));
      constexpr double worst = 200, sigmas = 3;
      if (condition > worst || apart < sigmas)
        std::ranges::replace(group, group[b], group[a]);
    }
  return group;
}

double condition_of(const MatrixXd &columns) {
  MatrixXd unit = columns;
  unit.colwise().normalize();
  const auto values = unit.jacobiSvd().singularValues();
  return values[0] / std::max(values[values.size() - 1], 1e-300);
}

} // namespace

std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>> &columns,
                                               std::span<const double> right) {
  MatrixXd a(static_cast<Index>(right.size()), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    a.col(static_cast<Index>(k)) =
        Eigen::Map<const VectorXd>(columns[k].data(), static_cast<Index>(right.size()));
  const VectorXd x =
      nnls(a, Eigen::Map<const VectorXd>(right.data(), static_cast<Index>(right.size())));
  return {x.data(), x.data() + x.size()};
}

Unmixing unmix(const ObservedCurve &curve, const CurveErrors &errors,
               const std::vector<EndMember> &members) {
  const Whitened w = whitened(curve, errors, members);
  Unmixing out;
  out.measurements = w.measurements;
  out.condition = condition_of(w.columns);
  const VectorXd all = nnls(w.columns, w.right);
  out.scale = all.sum();
  out.chi2 = (w.right - w.columns * all).squaredNorm();
  const auto group = groups_of(w, out.scale);
  // Joined members share one column, the mean of theirs: their parts cannot be told.
  std::vector<std::size_t> first;
  for (std::size_t k = 0; k < group.size(); ++k)
    if (group[k] == k)
      first.push_back(k);
  MatrixXd joined = MatrixXd::Zero(w.columns.rows(), static_cast<Index>(first.size()));
  for (std::size_t g = 0; g < first.size(); ++g) {
    double count = 0;
    UnmixedGroup one;
    for (std::size_t k = 0; k < group.size(); ++k)
      if (group[k] == first[g]) {
        joined.col(static_cast<Index>(g)) += w.columns.col(static_cast<Index>(k));
        one.names.push_back(members[k].name);
        count += 1;
      }
    joined.col(static_cast<Index>(g)) /= count;
    out.groups.push_back(std::move(one));
  }
  const VectorXd x = nnls(joined, w.right);
  const double sum = std::max(x.sum(), 1e-300);
  const MatrixXd covariance =
      (joined.transpose() * joined).completeOrthogonalDecomposition().pseudoInverse();
  for (Index g = 0; g < x.size(); ++g) {
    // f = x_g / sum x, to first order.
    VectorXd slope = VectorXd::Constant(x.size(), -x[g] / (sum * sum));
    slope[g] += 1 / sum;
    UnmixedGroup &one = out.groups[static_cast<std::size_t>(g)];
    one.fraction = x[g] / sum;
    one.fraction_err = std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
    one.detectable = 3 * one.fraction_err;
  }
  return out;
}

} // namespace umov
