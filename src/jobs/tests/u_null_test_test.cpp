#include "jobs/u_null_test.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>

namespace umov::jobs {
namespace {

constexpr std::size_t exposures = 400, analysers = 4;

/// Light without any U that grows by a part of itself from each exposure to the next.
EndMember changing_light(double change) {
  EndMember out;
  for (std::size_t e = 0; e < exposures; ++e) {
    out.i.push_back(std::exp(change * (static_cast<double>(e) - exposures / 2.)));
    out.q.push_back(0.1 * out.i.back());
    out.u.push_back(0);
  }
  return out;
}

/// Four analysers one after the other, through an instrument that adds `u0` of I, while the
/// scattering plane turns by 100 deg.
ObservedCurve in_sequence(const EndMember &light, double u0, std::uint64_t seed) {
  constexpr double electrons = 2e5;
  std::mt19937_64 random(seed);
  ObservedCurve out;
  out.bands = {"a"};
  for (std::size_t e = 0; e < exposures; ++e) {
    ObservedEpoch epoch;
    epoch.scattering_axis_rad = static_cast<double>(e) / exposures * 100 * pi / 180;
    out.epochs.push_back(epoch);
    const double c = std::cos(2 * epoch.scattering_axis_rad);
    const double s = std::sin(2 * epoch.scattering_axis_rad);
    const double analyser = static_cast<double>(e % analysers) * pi / 2;
    ObservedCount one;
    one.epoch = e;
    one.set = e / analysers;
    // It comes nearer meanwhile, which no reduction knows of.
    const double seen = electrons / 2 * std::exp(0.003 * static_cast<double>(e));
    out.epochs.back().flux_per_intensity = seen;
    one.by_i = seen;
    one.by_q = seen * (std::cos(analyser) * c + std::sin(analyser) * s);
    one.by_u = seen * (std::sin(analyser) * c - std::cos(analyser) * s);
    const double q = light.q[e] + u0 * s * light.i[e], u = u0 * c * light.i[e];
    const double mean = one.by_i * light.i[e] + one.by_q * q + one.by_u * u;
    one.net = static_cast<double>(std::poisson_distribution<int>(mean)(random));
    out.counts.push_back(one);
  }
  for (std::size_t first = 0; first < exposures; first += analysers) {
    const double net[] = {out.counts[first].net, out.counts[first + 1].net,
                          out.counts[first + 2].net, out.counts[first + 3].net};
    const double sum = (net[0] + net[1] + net[2] + net[3]) / 2;
    const double q = (net[0] - net[2]) / sum, u = (net[1] - net[3]) / sum;
    ObservedSample sample;
    sample.epoch = first + 1;
    sample.set = first / analysers;
    const double twice = 2 * out.epochs[sample.epoch].scattering_axis_rad;
    sample.i = sum / electrons;
    sample.i_sd = sample.i / std::sqrt(2 * sum);
    sample.q = q * std::cos(twice) + u * std::sin(twice);
    sample.u = u * std::cos(twice) - q * std::sin(twice);
    sample.cov_qq = sample.cov_uu = 1 / sum;
    out.samples.push_back(sample);
  }
  return out;
}

TEST(UNullTest, AChangeBetweenAnalysersIsNoPolarizationOfTheInstrument) {
  constexpr int nights = 100;
  int flagged = 0, flagged_as_sets = 0;
  const EndMember light = changing_light(0.005);
  for (int night = 0; night < nights; ++night) {
    const ObservedCurve curve = in_sequence(light, 0, static_cast<std::uint64_t>(night));
    flagged += null_test_of(curve, light).is_flagged() ? 1 : 0;
    flagged_as_sets += null_test(curve, std::vector<double>(curve.samples.size(), 0)).is_flagged();
  }
  EXPECT_LE(flagged, 5); // 1 in 100 by construction, four sigma
  EXPECT_EQ(flagged_as_sets, nights);
}

TEST(UNullTest, PolarizationOfTheInstrumentIsSeenThroughAChange) {
  constexpr int nights = 50;
  int seen = 0;
  double mean = 0;
  const EndMember light = changing_light(0.003);
  for (int night = 0; night < nights; ++night) {
    const NullTest found =
        null_test_of(in_sequence(light, 0.005, static_cast<std::uint64_t>(night)), light);
    seen += found.is_flagged() ? 1 : 0;
    mean += found.u0 / nights;
  }
  EXPECT_GE(seen, 45);              // .005 is seven of its errors
  EXPECT_NEAR(mean, 0.005, 0.0006); // four of the mean's own
}

} // namespace
} // namespace umov::jobs
