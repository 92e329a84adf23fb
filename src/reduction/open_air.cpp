#include <umov/reduction/open_air.h>

#include "algebra/dense.h"

#include <algorithm>
#include <cmath>

namespace umov {
namespace {

using Matrix = algebra::MatrixXd;
using Vector = algebra::VectorXd;
/// As the class keeps it.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double light_of(const StokesRow &row, const std::array<double, 4> &stokes) {
  return respond(row, Stokes<InstrumentAxes>{stokes[0], stokes[1], stokes[2], stokes[3]});
}

/// Exposures of pupils, and the moments at which clouds were met.
struct Moments {
  std::vector<double> flicker;      ///< of each exposure of a pupil
  std::vector<Eigen::Index> moment; ///< of the same
  std::vector<double> kept;         ///< of the moment before, by each moment
};

/// x_0 = s n_0, x_k = r x_(k-1) + s sqrt(1 - r^2) n_k.
Matrix cloud_root(const std::vector<double> &kept, double sd) {
  const auto n = static_cast<Eigen::Index>(kept.size());
  Matrix out = Matrix::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double r = kept[static_cast<std::size_t>(k)];
    if (k > 0)
      out.row(k) = out.row(k - 1) * r;
    out(k, k) = sd * std::sqrt(1 - r * r);
  }
  return out;
}

Eigen::Index last_of(const auto &all) { return static_cast<Eigen::Index>(all.size()) - 1; }

} // namespace

OpenAir::OpenAir(std::span<const AirPlace> places, bool has_separate_pupils,
                 const CloudPrior &cloud) {
  Moments all;
  double last_s = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const AirPlace &one = places[k];
    const bool is_new_exposure = k == 0 || one.exposure != places[k - 1].exposure;
    if (is_new_exposure && (k == 0 || one.time_s - places[k - 1].time_s > 1e-9)) {
      const bool is_kept = k > 0 && cloud.time_s > 0;
      all.kept.push_back(is_kept ? std::exp((last_s - one.time_s) / cloud.time_s) : 0);
      last_s = one.time_s;
    }
    if (is_new_exposure || has_separate_pupils) {
      all.flicker.push_back(one.flicker);
      all.moment.push_back(last_of(all.kept));
    }
    pupil_.push_back(all.flicker.size() - 1);
  }
  const auto pupils = static_cast<Eigen::Index>(all.flicker.size());
  const Eigen::Index moments = cloud.sd > 0 ? last_of(all.kept) + 1 : 0;
  Rows root = Rows::Zero(pupils, moments + pupils);
  if (moments > 0) {
    const Matrix of_cloud = cloud_root(all.kept, cloud.sd);
    for (Eigen::Index p = 0; p < pupils; ++p)
      root.row(p).head(moments) = of_cloud.row(all.moment[static_cast<std::size_t>(p)]);
  }
  for (Eigen::Index p = 0; p < pupils; ++p)
    root(p, moments + p) = all.flicker[static_cast<std::size_t>(p)];
  causes_ = static_cast<std::size_t>(root.cols());
  root_.assign(root.data(), root.data() + root.size());
}

std::vector<double> OpenAir::transparencies(std::span<const ChannelDatum> data,
                                            const std::array<double, 4> &stokes) const {
  const auto causes = static_cast<Eigen::Index>(causes_);
  const Matrix root = Eigen::Map<const Rows>(
      root_.data(), static_cast<Eigen::Index>(root_.size()) / std::max<Eigen::Index>(1, causes),
      causes);
  Vector logs = Vector::Zero(root.rows());
  constexpr int rounds = 8; // Newton's: each doubles the digits
  for (int round = 0; round < rounds; ++round) {
    // Normal equations over the numbers behind the logarithms, about those found so far.
    Vector off = Vector::Zero(root.rows()), weight = off;
    for (std::size_t k = 0; k < data.size(); ++k) {
      const ChannelDatum &one = data[k];
      const auto pupil = static_cast<Eigen::Index>(pupil_[k]);
      const double m = light_of(one.row, stokes) * std::exp(logs(pupil));
      const double v = one.excess2 * std::max(1e-3, m + one.sky) + one.fixed_variance;
      off(pupil) += m * (one.counts - one.sky - m + m * logs(pupil)) / v;
      weight(pupil) += m * m / v;
    }
    Matrix normal = algebra::gram(weight.cwiseSqrt().asDiagonal() * root);
    normal.diagonal().array() += 1;
    const Vector next = algebra::times(
        root, algebra::solve_symmetric(normal, algebra::transposed_times(root, off)));
    constexpr double darkest = -3, brightest = 1; // of what is still seen
    logs = next.cwiseMax(darkest).cwiseMin(brightest);
  }
  std::vector<double> out;
  for (const std::size_t pupil : pupil_)
    out.push_back(std::exp(logs(static_cast<Eigen::Index>(pupil))));
  return out;
}

void OpenAir::add_errors(std::vector<CommonError> &out,
                         std::span<const ModelledDatum> model) const {
  for (std::size_t c = 0; c < causes_; ++c) {
    CommonError one{{}, 1};
    bool acts = false;
    for (std::size_t k = 0; k < model.size(); ++k) {
      const double change = root_[pupil_[k] * causes_ + c];
      acts = acts || change != 0;
      one.effect.push_back(light_of(model[k].datum.row, model[k].stokes) * change);
    }
    if (acts)
      out.push_back(std::move(one));
  }
}

} // namespace umov
