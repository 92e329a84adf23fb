// Errors of whole instruments: what photons allow, and what flickering air adds.
#include "reduction/tests/anchor.h"

#include <gtest/gtest.h>
#include <umov/instrument/draws.h>
#include <umov/instrument/polarimeter.h>
#include <umov/reduction/ratio.h>

namespace umov {
namespace {

constexpr double electrons = 1e5; ///< detected in all channels of a set of unpolarized light

/// Rows of a set, scaled so that they take `electrons` in all, and the exposure of each.
struct Rows {
  std::vector<StokesRow> rows;
  std::vector<std::size_t> exposure;
  std::size_t parameters = 3;
};

Rows rows_of(const Polarimeter &p, const std::vector<PolarimeterState> &states) {
  Rows out;
  double sum = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const auto channels = polarimeter_channels(p, states[k], 550);
    for (const PolarimeterChannel &channel : *channels) {
      out.rows.push_back(channel.row);
      out.exposure.push_back(k);
      sum += channel.row[0];
    }
  }
  for (StokesRow &row : out.rows)
    row = row * (electrons / sum);
  out.parameters = parameters_of(p.type);
  return out;
}

Rows mosaic() {
  Polarimeter p;
  p.type = PolarimeterType::Mosaic;
  p.angles_deg = {90, 45, 135, 0};
  return rows_of(p, {{}});
}
Rows wheel() {
  Polarimeter p;
  p.type = PolarimeterType::PolarizerWheel;
  return rows_of(p, {{0, 0, 0}, {45, 0, 0}, {90, 0, 0}, {135, 0, 0}});
}
Rows two_beams() {
  Polarimeter p;
  p.type = PolarimeterType::HwpDualBeam;
  return rows_of(p, {{0, 0, 0}, {0, 45, 0}, {0, 22.5, 0}, {0, 67.5, 0}});
}
Rows retarder_scheme() {
  Polarimeter p;
  p.type = PolarimeterType::RotatingRetarder;
  p.retardance_deg = {{}, {131.8}};
  return rows_of(p, {{0, -51.69, 0}, {0, -15.12, 0}, {0, 15.12, 0}, {0, 51.69, 0}});
}

/// Root mean square of q and u (and v) over draws of unpolarized light, each exposure with a
/// log-normal transparency.
double scatter(const Rows &set, double flicker, std::uint32_t trials) {
  double sum = 0;
  for (std::uint32_t t = 0; t < trials; ++t) {
    Draws draws({77, 0, t, 0, 0});
    std::vector<ChannelDatum> data;
    double air = 1;
    for (std::size_t k = 0; k < set.rows.size(); ++k) {
      if (flicker > 0 && (k == 0 || set.exposure[k] != set.exposure[k - 1]))
        air = std::exp(flicker * draws.normal() - flicker * flicker / 2);
      data.push_back({draws.poisson(air * set.rows[k][0]), 0, 0, 1, set.rows[k]});
    }
    const StokesFractions f = fractions_of(*fit_stokes(data, set.parameters));
    for (std::size_t k = 0; k + 1 < set.parameters; ++k)
      sum += f.value[k] * f.value[k] / static_cast<double>(set.parameters - 1);
  }
  return std::sqrt(sum / trials);
}

TEST(PhotonLimit, OfEveryKindOfPolarimeter) {
  constexpr std::uint32_t trials = 20'000; // an sd of 40,000 numbers is known to .4 %
  const double linear = std::sqrt(2 / electrons), full = std::sqrt(3 / electrons);
  EXPECT_NEAR(scatter(mosaic(), 0, trials) / linear, 1, .02);
  EXPECT_NEAR(scatter(wheel(), 0, trials) / linear, 1, .02);
  EXPECT_NEAR(scatter(two_beams(), 0, trials) / linear, 1, .02);
  EXPECT_NEAR(scatter(retarder_scheme(), 0, trials) / full, 1, .02);
}

TEST(Scintillation, IsSharedOrIsNot) {
  constexpr std::uint32_t trials = 20'000;
  constexpr double s = .0139;
  const double photons = std::sqrt(2 / electrons);
  EXPECT_NEAR(scatter(mosaic(), s, trials) / scatter(mosaic(), 0, trials), 1, .01);
  // Exposures that follow each other differ: s/sqrt 2 in q beside the photons' own.
  const double alone = std::sqrt(std::pow(scatter(wheel(), s, trials), 2) - photons * photons);
  EXPECT_NEAR(alone / (s / std::sqrt(2.)), 1, .03);
}

TEST(Scintillation, CancelsInTheRatioOfTwoBeams) {
  constexpr std::uint32_t trials = 20'000;
  const Rows set = two_beams();
  double still = 0, windy = 0;
  for (std::uint32_t t = 0; t < trials; ++t)
    for (const double s : {0., .0139}) {
      Draws draws({78, 0, t, 0, 0});
      std::array<BeamPair, 4> beams;
      for (std::size_t k = 0; k < 4; ++k) {
        const double air = std::exp(s * draws.normal() - s * s / 2);
        beams[k] = {draws.poisson(air * set.rows[2 * k][0]),
                    draws.poisson(air * set.rows[2 * k + 1][0])};
      }
      const double q = ratio_method(beams[0], beams[1]);
      (s > 0 ? windy : still) += q * q / trials;
    }
  EXPECT_NEAR(std::sqrt(windy / still), 1, .01);
  EXPECT_NEAR(std::sqrt(still) / std::sqrt(2 / electrons), 1, .02);
}

TEST(EightPositions, NullsAreAsLargeAsPhotonsMakeThem) {
  constexpr std::uint32_t trials = 5000;
  constexpr double beam = 2e4, truth = .1; // electrons of each beam of unpolarized light
  double sum = 0, mean = 0;
  for (std::uint32_t t = 0; t < trials; ++t) {
    Draws draws({79, 0, t, 0, 0});
    std::array<BeamPair, 8> beams;
    for (std::size_t k = 0; k < 8; ++k) {
      const double seen = truth * std::cos(4 * 22.5 * static_cast<double>(k) * pi / 180);
      const double air = 1 + .02 * draws.normal();
      beams[k] = {draws.poisson(.95 * air * beam * (1 + seen)),
                  draws.poisson(1.05 * air * beam * (1 - seen))};
    }
    const EightPositions found = eight_positions(beams);
    // q of four beams: sd sqrt((1 - q^2)/N) of N = 4 beams; half the difference of two of them.
    const double sd = std::sqrt((1 - truth * truth) / (4 * beam) / 2);
    mean += found.null_q / sd / trials;
    sum += std::pow(found.null_q / sd, 2) / trials;
  }
  EXPECT_NEAR(std::sqrt(sum - mean * mean), 1, .03);
  EXPECT_NEAR(mean, 0, 4 / std::sqrt(trials));
}

} // namespace
} // namespace umov
