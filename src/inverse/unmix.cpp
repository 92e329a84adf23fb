#include <umov/inverse/unmix.h>

#include "algebra/dense.h"
#include "inverse/whitened.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace umov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using inverse::whitened;
using inverse::Whitened;

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
  const VectorXd x = algebra::least_squares(part, b);
  for (std::size_t k = 0; k < at.size(); ++k)
    out[at[k]] = x[static_cast<Index>(k)];
  return out;
}

VectorXd nnls(const MatrixXd &a, const VectorXd &b) {
  const auto n = static_cast<std::size_t>(a.cols());
  std::vector<bool> is_active(n, false);
  VectorXd x = VectorXd::Zero(a.cols());
  const double tolerance = 1e-10 * algebra::transposed_times(a, b).cwiseAbs().maxCoeff();
  for (std::size_t round = 0; round < 3 * n + 10; ++round) {
    const VectorXd gradient = algebra::transposed_times(a, b - a * x);
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

constexpr double sigmas = 3; // from which on something is seen

/// End members of which what is found gives light that is seen, or as much as of all the others
/// would; all of them if none is.
std::vector<bool> seen(const Whitened &w, const VectorXd &parts) {
  std::vector<bool> out;
  for (Index k = 0; k < parts.size(); ++k)
    out.push_back(w.lengths[k] * std::max(parts[k], parts.sum() - parts[k]) >= sigmas);
  if (std::ranges::find(out, true) == out.end())
    out.assign(out.size(), true);
  return out;
}

/// Which of those that are seen the data hold apart: the number of each one's group.
std::vector<std::size_t> groups_of(const Whitened &w, double scale,
                                   const std::vector<bool> &is_seen) {
  const auto n = static_cast<std::size_t>(w.columns.cols());
  std::vector<std::size_t> group(n);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      if (!is_seen[a] || !is_seen[b])
        continue;
      const VectorXd x = w.columns.col(static_cast<Index>(a)),
                     y = w.columns.col(static_cast<Index>(b));
      const double c = std::abs(x.dot(y)) / std::max(x.norm() * y.norm(), 1e-300);
      const double condition = std::sqrt((1 + c) / std::max(1 - c, 1e-300));
      // What the brighter leaves if the other, of any scale, stands in its place. That the brighter
      // can hide a dim one makes them no one: the dim one's error says it.
      const double apart =
          scale * std::max(x.norm(), y.norm()) * std::sqrt(std::max(0.0, 1 - c * c));
      constexpr double worst = 200;
      if (condition > worst || apart < sigmas)
        std::ranges::replace(group, group[b], group[a]);
    }
  return group;
}

/// The best parts with none below 0, all 0 where no light stands out of the errors, and the rows
/// that they were found from.
struct Solved {
  Whitened rows;
  VectorXd parts;
};

Solved solve(const ObservedCurve &curve, const CurveErrors &errors,
             const std::vector<EndMember> &members) {
  Solved out{whitened(curve, errors, members), {}};
  out.parts = VectorXd::Zero(out.rows.columns.cols());
  if (std::ranges::find(out.rows.shows, true) == out.rows.shows.end())
    return out;
  out.parts = nnls(out.rows.columns, out.rows.right);
  for (int round = 0; round < inverse::refinements && out.parts.sum() > 0; ++round) {
    const EndMember about = inverse::added_up(members, out.parts);
    out.rows = whitened(curve, errors, members, &about);
    out.parts = nnls(out.rows.columns, out.rows.right);
  }
  return out;
}

/// Members that cannot be told apart as one, the mean of theirs.
std::vector<EndMember> joined(const std::vector<EndMember> &members,
                              const std::vector<std::size_t> &group,
                              const std::vector<std::size_t> &first) {
  std::vector<EndMember> out;
  for (const std::size_t leader : first) {
    const auto count = static_cast<double>(std::ranges::count(group, leader));
    VectorXd part = VectorXd::Zero(static_cast<Index>(members.size()));
    for (std::size_t k = 0; k < group.size(); ++k)
      part[static_cast<Index>(k)] = group[k] == leader ? 1 / count : 0;
    out.push_back(inverse::added_up(members, part));
  }
  return out;
}

/// What the parts are uncertain by as nobody knows which of joined members gives the light: of a
/// dim one there is more than of their mean, of a bright one less, and all others change with it.
MatrixXd of_joined(const std::vector<std::size_t> &group, const std::vector<std::size_t> &first,
                   const MatrixXd &columns, const VectorXd &x) {
  MatrixXd out = MatrixXd::Zero(x.size(), x.size());
  for (Index g = 0; g < x.size(); ++g) {
    std::vector<double> length;
    for (std::size_t k = 0; k < group.size(); ++k)
      if (group[k] == first[static_cast<std::size_t>(g)])
        length.push_back(columns.col(static_cast<Index>(k)).norm());
    const auto count = static_cast<double>(length.size());
    const double mean = std::reduce(length.begin(), length.end()) / count;
    for (const double one : length) {
      VectorXd other = x;
      other[g] *= one > 0 ? mean / one : 1;
      const VectorXd off = other / other.sum() - x / x.sum();
      out += algebra::product(MatrixXd(off), MatrixXd(off.transpose())) / count;
    }
  }
  return out;
}

/// NaN where a column is 0: it has no direction.
double condition_of(const MatrixXd &columns) {
  if ((columns.colwise().squaredNorm().array() <= 0).any())
    return std::numeric_limits<double>::quiet_NaN();
  MatrixXd unit = columns;
  unit.colwise().normalize();
  const VectorXd values = algebra::singular_values(unit);
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
  const auto [w, all] = solve(curve, errors, members);
  Unmixing out;
  out.measurements = w.measurements;
  out.left_out = w.left_out;
  out.condition = condition_of(w.columns);
  out.scale = all.sum();
  out.chi2 = (w.right - w.columns * all).squaredNorm();
  const std::vector<bool> is_seen = seen(w, all);
  const auto group = groups_of(w, out.scale, is_seen);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::size_t> first, place; // of the groups that are seen: leaders, place among all
  for (std::size_t leader = 0; leader < group.size(); ++leader) {
    if (group[leader] != leader)
      continue;
    if (is_seen[leader]) {
      first.push_back(leader);
      place.push_back(out.groups.size());
    }
    out.groups.push_back({{}, unknown, unknown, unknown});
    for (std::size_t k = 0; k < group.size(); ++k)
      if (group[k] == leader)
        out.groups.back().names.push_back(members[k].name);
  }
  const auto [rows, x] = solve(curve, errors, joined(members, group, first));
  const double sum = std::max(x.sum(), 1e-300);
  const MatrixXd covariance = algebra::pseudo_inverse(algebra::gram(rows.columns));
  MatrixXd slope = MatrixXd::Zero(x.size(), x.size()); // f = x_g / sum x, to first order
  for (Index g = 0; g < x.size(); ++g) {
    slope.row(g).setConstant(-x[g] / (sum * sum));
    slope(g, g) += 1 / sum;
  }
  const MatrixXd of_changes =
      algebra::product(algebra::product(slope, covariance), slope.transpose());
  const bool has_light = x.sum() > 0;
  const MatrixXd of_fractions =
      has_light ? MatrixXd(of_changes + of_joined(group, first, w.columns, x)) : of_changes;
  for (Index g = 0; g < x.size() && has_light; ++g) {
    UnmixedGroup &one = out.groups[place[static_cast<std::size_t>(g)]];
    one.fraction = x[g] / sum;
    // Of one group all is of it, and no change of that can show.
    one.fraction_err = x.size() < 2 ? 0 : std::sqrt(std::max(0.0, of_fractions(g, g)));
    if (x.size() > 1)
      one.detectable = sigmas * std::sqrt(std::max(0.0, of_changes(g, g)));
    for (Index h = 0; h < x.size(); ++h)
      out.covariance.push_back(of_fractions(g, h));
  }
  out.fitted = inverse::added_up(members, all / std::max(all.sum(), 1e-300));
  return out;
}

} // namespace umov
