#include <umov/reduction/open_air.h>

#include "algebra/dense.h"
#include "reduction/count_covariance.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace umov {
namespace {

using Vector = algebra::VectorXd;

double light_of(const StokesRow &row, const std::array<double, 4> &stokes) {
  return respond(row, Stokes<InstrumentAxes>{stokes[0], stokes[1], stokes[2], stokes[3]});
}

/// What the counts of a pupil say of the logarithm of its transparency: how far it is off its mean,
/// times its weight, and the weight.
struct Seen {
  Vector off, weight;
};

/// Deviations of the pupils' logarithms from their means, the most likely ones by what was seen.
Vector deviations(const AirOfCounts &air, const std::vector<Eigen::Index> &moment,
                  const Seen &seen) {
  // Flicker is each pupil's own: what is seen of the cloud through it is that much less certain.
  const Vector flicker2 = air.flicker.cwiseAbs2();
  const Vector kept = (1. + seen.weight.array() * flicker2.array()).inverse();
  Vector cloud = Vector::Zero(flicker2.size());
  if (!air.cloud.empty()) {
    Vector weights = Vector::Zero(air.cloud.moments());
    algebra::MatrixXd right = algebra::MatrixXd::Zero(weights.size(), 1);
    for (std::size_t p = 0; p < moment.size(); ++p) {
      const auto pupil = static_cast<Eigen::Index>(p);
      weights(moment[p]) += seen.weight(pupil) * kept(pupil);
      right(moment[p], 0) += seen.off(pupil) * kept(pupil);
    }
    const algebra::MatrixXd found = air.cloud.solve(weights, std::move(right));
    for (std::size_t p = 0; p < moment.size(); ++p)
      cloud(static_cast<Eigen::Index>(p)) = found(moment[p], 0);
  }
  return cloud +
         flicker2.cwiseProduct(kept).cwiseProduct(seen.off - seen.weight.cwiseProduct(cloud));
}

} // namespace

OpenAir::OpenAir(std::span<const AirPlace> places, bool has_separate_pupils,
                 const CloudPrior &cloud)
    : places_(places.begin(), places.end()), cloud_(cloud) {
  std::map<std::int64_t, std::size_t> of_exposure;
  for (const AirPlace &one : places) {
    const std::size_t next = flicker_.size();
    pupil_.push_back(
        has_separate_pupils ? next : of_exposure.try_emplace(one.exposure, next).first->second);
    if (pupil_.back() == next)
      flicker_.push_back(one.flicker);
  }
}

AirOfCounts air_of(const OpenAir &air) {
  std::vector<CountMoment> counts;
  for (const AirPlace &one : air.places_)
    counts.push_back({one.time_s, one.exposure});
  AirOfCounts out{{air.pupil_.begin(), air.pupil_.end()}, {}, CloudChain(counts, air.cloud_)};
  out.flicker =
      Eigen::Map<const Vector>(air.flicker_.data(), static_cast<Eigen::Index>(air.flicker_.size()));
  return out;
}

bool OpenAir::is_known() const {
  return !(cloud_.sd > 0) && std::ranges::none_of(flicker_, [](double s) { return s > 0; });
}

double OpenAir::mean_logarithm(std::size_t count) const {
  const double flicker = flicker_[pupil_[count]];
  return -(cloud_.sd * cloud_.sd + flicker * flicker) / 2;
}

std::vector<double> OpenAir::transparencies(std::span<const ChannelDatum> data,
                                            const std::array<double, 4> &stokes) const {
  const AirOfCounts air = air_of(*this);
  const auto pupils = air.flicker.size();
  std::vector<Eigen::Index> moment(static_cast<std::size_t>(pupils), 0);
  Vector mean(pupils);
  for (std::size_t k = 0; k < pupil_.size(); ++k) {
    moment[pupil_[k]] = air.cloud.empty() ? 0 : air.cloud.moment(k);
    mean(air.pupil[k]) = mean_logarithm(k);
  }
  Vector logs = mean;
  constexpr int rounds = 8; // Newton's: each doubles the digits
  for (int round = 0; round < rounds; ++round) {
    Seen seen{Vector::Zero(pupils), Vector::Zero(pupils)};
    for (std::size_t k = 0; k < data.size(); ++k) {
      const ChannelDatum &one = data[k];
      const Eigen::Index pupil = air.pupil[k];
      const double m = light_of(one.row, stokes) * std::exp(logs(pupil));
      const double v = one.excess2 * std::max(1e-3, m + one.sky) + one.fixed_variance;
      seen.off(pupil) += m * (one.counts - one.sky - m + m * (logs(pupil) - mean(pupil))) / v;
      seen.weight(pupil) += m * m / v;
    }
    constexpr double darkest = -3, brightest = 1; // of what is still seen
    const Vector next =
        (mean + deviations(air, moment, seen)).cwiseMax(darkest).cwiseMin(brightest);
    const double change = (next - logs).cwiseAbs().maxCoeff();
    logs = next;
    if (change < 1e-10)
      break;
  }
  std::vector<double> out;
  for (const Eigen::Index pupil : air.pupil)
    out.push_back(std::exp(logs(pupil)));
  return out;
}

} // namespace umov
