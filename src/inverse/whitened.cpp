#include "inverse/whitened.h"

#include "inverse/count_likelihood.h"
#include <umov/inverse/sample_errors.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace umov::inverse {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

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

/// Rows that the zero point of each band moves, and by how much.
class ZeroPoints {
public:
  explicit ZeroPoints(std::size_t bands) : rows_(bands), moved_(bands) {}
  void add(std::size_t band, Index row, double moved) {
    rows_[band].push_back(row);
    moved_[band].push_back(moved);
  }
  void whiten(Whitened &out) const {
    for (std::size_t b = 0; b < rows_.size(); ++b)
      whiten_band(
          out.columns, out.right, rows_[b],
          Eigen::Map<const VectorXd>(moved_[b].data(), static_cast<Index>(moved_[b].size())));
  }

private:
  std::vector<std::vector<Index>> rows_;
  std::vector<std::vector<double>> moved_;
};

/// Before zero points are whitened. `light`: rows that are linear in it.
void put_shown(const std::vector<Index> &light, Whitened &out) {
  constexpr double sigmas = 3;
  out.lengths = out.columns.colwise().norm();
  for (Index member = 0; member < out.columns.cols(); ++member) {
    double along = 0, square = 0;
    for (const Index row : light) {
      along += out.columns(row, member) * out.right[row];
      square += out.columns(row, member) * out.columns(row, member);
    }
    out.shows.push_back(along > sigmas * std::sqrt(square));
  }
}

ModelLight light_of(const EndMember &member) { return {member.i, member.q, member.u}; }

/// Of the members the one of most light: nothing else is known of how much noise there is.
const EndMember &brightest(const std::vector<EndMember> &members) {
  return *std::ranges::max_element(
      members, {}, [](const EndMember &m) { return std::accumulate(m.i.begin(), m.i.end(), 0.0); });
}

/// Rows of electrons.
Whitened of_counts(const ObservedCurve &curve, const CurveErrors &errors,
                   const std::vector<EndMember> &members, const EndMember *about,
                   const EndMember *zeros) {
  const CountLikelihood counts(curve, errors, median_of_i(curve), {});
  // Variances of one light for all that is compared.
  const EndMember *const known = zeros != nullptr ? zeros : about;
  const EndMember &noisy = known != nullptr ? *known : brightest(members);
  std::vector<PartLight> parts;
  parts.reserve(members.size());
  for (const EndMember &m : members)
    parts.push_back({m.i, m.q, m.u, {}});
  ModelLight model = light_of(noisy);
  const double scale = known != nullptr ? 1 : counts.first_scale(model);
  model.parts = parts;
  const WhitenedCounts white = counts.whitened(model, scale);
  const auto n = static_cast<Index>(counts.size());
  Whitened out;
  out.measurements = counts.size();
  out.right = Eigen::Map<const VectorXd>(white.net.data(), n);
  out.columns.resize(n, static_cast<Index>(members.size()));
  for (std::size_t k = 0; k < members.size(); ++k)
    out.columns.col(static_cast<Index>(k)) = Eigen::Map<const VectorXd>(white.parts[k].data(), n);
  std::vector<Index> all(counts.size());
  std::iota(all.begin(), all.end(), Index{0});
  put_shown(all, out);
  ZeroPoints zeros_of_bands(curve.bands.size());
  for (const CountLikelihood::Set &set : counts.sets())
    for (std::size_t k = set.begin; k < set.begin + set.size; ++k) {
      zeros_of_bands.add(set.group, static_cast<Index>(k),
                         errors.zero_point_sd * scale * white.light[k]);
    }
  zeros_of_bands.whiten(out);
  return out;
}

} // namespace

EndMember added_up(const std::vector<EndMember> &members, const VectorXd &parts) {
  const std::size_t size = members.front().i.size();
  EndMember out{"", std::vector<double>(size), std::vector<double>(size),
                std::vector<double>(size)};
  for (std::size_t n = 0; n < members.size(); ++n)
    for (std::size_t k = 0; k < size; ++k) {
      const double part = parts[static_cast<Index>(n)];
      out.i[k] += part * members[n].i[k];
      out.q[k] += part * members[n].q[k];
      out.u[k] += part * members[n].u[k];
    }
  return out;
}

Whitened whitened(const ObservedCurve &curve, CurveErrors errors,
                  const std::vector<EndMember> &members, const EndMember *about,
                  const EndMember *zeros) {
  errors.has_clouds = false; // a free gain per epoch would leave equations that 0 solves
  if (!curve.counts.empty() && errors.has_polarization)
    return of_counts(curve, errors, members, about, zeros);
  const auto n = static_cast<Index>(members.size());
  const double median = median_of_i(curve);
  Whitened out;
  out.columns = MatrixXd::Zero(static_cast<Index>(3 * curve.samples.size()), n);
  out.right = VectorXd::Zero(out.columns.rows());
  ZeroPoints zeros_of_bands(curve.bands.size());
  std::vector<Index> light_rows;
  Index row = 0;
  for (const ObservedSample &s : curve.samples) {
    const std::size_t at = s.epoch * curve.bands.size() + s.band;
    const SampleErrors known = errors_of(s, errors, median);
    const double light = std::max(about != nullptr ? about->i[at] : s.i, 0.0);
    if (!(known.i_variance > 0) || !(s.i > 0 || s.i_sd > 0)) {
      out.left_out += known.l_qq > 0 ? 1u : 0u; // of its q and u I is a factor
      continue;
    }
    const double sd = std::sqrt(known.i_variance);
    for (Index k = 0; k < n; ++k)
      out.columns(row, k) = members[static_cast<std::size_t>(k)].i[at] / sd;
    out.right[row] = s.i / sd;
    light_rows.push_back(row);
    const double moved = zeros != nullptr ? std::max(zeros->i[at], 0.0) : light;
    zeros_of_bands.add(s.band, row, errors.zero_point_sd * moved / sd);
    ++row;
    ++out.measurements;
    if (!(known.l_qq > 0))
      continue;
    if (!(s.i > 0 && light > 0)) {
      ++out.left_out;
      continue;
    }
    const double q = about != nullptr ? about->q[at] / light : s.q;
    const double u = about != nullptr ? about->u[at] / light : s.u;
    for (Index k = 0; k < n; ++k) {
      const EndMember &m = members[static_cast<std::size_t>(k)];
      const double dq = (m.q[at] - q * m.i[at]) / light, du = (m.u[at] - u * m.i[at]) / light;
      out.columns(row, k) = known.l_qq * dq;
      out.columns(row + 1, k) = known.l_uq * dq + known.l_uu * du;
    }
    out.right[row] = known.l_qq * (s.q - q);
    out.right[row + 1] = known.l_uq * (s.q - q) + known.l_uu * (s.u - u);
    row += 2;
    out.measurements += 2;
  }
  out.columns.conservativeResize(row, n);
  out.right.conservativeResize(row);
  put_shown(light_rows, out);
  zeros_of_bands.whiten(out);
  return out;
}

} // namespace umov::inverse
