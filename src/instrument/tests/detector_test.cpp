#include "instrument/tests/anchor.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/instrument/detector.h>

namespace umov {
namespace {

Detector camera(DetectorModel model) {
  Detector out;
  out.model = model;
  out.read_e = 2.3;
  out.gain_e_adu = 2.6;
  out.bits = 16;
  return out;
}

TEST(Detector, ExcessOfARegister) { // nine digits
  Detector d = camera(DetectorModel::Emccd);
  for (const int gain : {10, 100, 1000}) {
    d.em_gain = gain;
    EXPECT_NEAR(excess_variance(d), of("excess_" + std::to_string(gain)), 1e-8);
  }
  EXPECT_EQ(excess_variance(camera(DetectorModel::Cmos)), 1);
}

TEST(Detector, CcdEquation) { // nine digits
  EXPECT_NEAR(aperture_variance(camera(DetectorModel::Ccd), {1e4, 20, .5, 50, 500}), of("ccd"),
              1e-4);
  Detector d = camera(DetectorModel::Emccd);
  d.em_gain = 300, d.read_e = 60, d.gain_e_adu = 10;
  EXPECT_NEAR(aperture_variance(d, {1e4, 20, .5, 50, 500}), of("emccd"), 1e-4);
}

/// 40 electrons on nine pixels: what is read quietly beats what is multiplied, and both a CCD.
TEST(Detector, FaintStarsInThreeCameras) { // nine digits
  struct Case {
    const char *name;
    DetectorModel model;
    double read, step, gain;
  };
  for (const Case &one : {Case{"cmos", DetectorModel::Cmos, 1.4, .45, 1},
                          {"emccd", DetectorModel::Emccd, 60, 10, 300},
                          {"ccd", DetectorModel::Ccd, 7, 1, 1}}) {
    Detector d = camera(one.model);
    d.read_e = one.read, d.gain_e_adu = one.step, d.em_gain = one.gain;
    const double variance = aperture_variance(d, {40, .1, .01, 9, 0});
    EXPECT_NEAR(40 / std::sqrt(variance), of(std::string("faint_") + one.name), 1e-8);
  }
}

TEST(Detector, BendsAndIsStraightenedAgain) {
  Detector d = camera(DetectorModel::Ccd);
  d.nonlinearity = .02;
  d.well_e = 10500;
  EXPECT_NEAR(bent(d, 9000), of("bent"), 1e-5);
  for (const double x : {1., 100., 9000., 10500.})
    EXPECT_NEAR(straightened(d, bent(d, x)) / x, 1, 1e-12);
}

TEST(Detector, DeadTime) {
  Detector d = camera(DetectorModel::Counter);
  d.dead_time_s = 50e-9;
  EXPECT_NEAR(counted_rate(d, 1e6), of("dead_time"), 1e-3);
  EXPECT_NEAR(counter_fano(d, 1e6), 1 / (1.05 * 1.05), 1e-12);
}

/// Mean and variance of 1e5 readings in electrons: within four standard errors of what they should
/// be; that of the variance from the fourth moment of a Poisson number under normal noise.
void expect_statistics(const Detector &d, double mean, double exposure_s) {
  constexpr int trials = 100'000;
  double sum = 0, squares = 0;
  for (int k = 0; k < trials; ++k) {
    Draws draws({17, 0, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(mean), 0});
    const double x = electrons_of(d, read_pixel(d, mean, exposure_s, draws)) - mean;
    sum += x;
    squares += x * x;
  }
  const double expected = excess_variance(d) * mean + fixed_variance(d);
  const double m = sum / trials, v = squares / trials - m * m;
  EXPECT_NEAR(m, 0, 4 * std::sqrt(expected / trials)) << name_of(d.model) << " " << mean;
  const double kurtosis =
      2 + 6 * std::pow(excess_variance(d), 2) * mean / (expected * expected) * excess_variance(d);
  EXPECT_NEAR(v / expected, 1, 4 * std::sqrt(kurtosis / trials)) << name_of(d.model) << " " << mean;
}

TEST(Detector, MeanAndVarianceOfEveryModel) {
  for (const DetectorModel model : {DetectorModel::Ccd, DetectorModel::Cmos, DetectorModel::Emccd})
    for (const double mean : {1., 10., 1e3, 1e5}) {
      Detector d = camera(model);
      d.bits = 32;
      if (model == DetectorModel::Emccd) {
        d.em_gain = 300;
        d.read_e = 60;
        d.gain_e_adu = 10;
      }
      expect_statistics(d, mean, 1);
    }
}

TEST(Detector, CountersLoseWhatComesWhileTheyAreDead) {
  for (const double photons : {1., 10., 1e3, 1e5}) {
    Detector d;
    d.model = DetectorModel::Counter;
    d.dead_time_s = 50e-9;
    const double exposure_s = photons * 1e-6; // a million a second: n tau = .05
    constexpr int trials = 100'000;
    double sum = 0, squares = 0;
    for (int k = 0; k < trials; ++k) {
      Draws draws({3, 0, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(photons), 0});
      const double n = draw_aperture(d, photons, 1, exposure_s, draws) - photons / 1.05;
      sum += n;
      squares += n * n;
    }
    // Nine digits: dead_time, the Fano factor beside it.
    const double expected = photons / 1.05 / (1.05 * 1.05);
    const double mean = sum / trials, variance = squares / trials - mean * mean;
    EXPECT_NEAR(mean, 0, 4 * std::sqrt(expected / trials)) << photons;
    EXPECT_NEAR(variance / expected, 1, 4 * std::sqrt((2 + 1 / expected) / trials)) << photons;
  }
}

TEST(Detector, RoundingHasNoBias) { // of a camera without noise of its own
  Detector d = camera(DetectorModel::Cmos);
  d.read_e = 1.5;
  double sum = 0;
  constexpr int trials = 200'000;
  for (int k = 0; k < trials; ++k) {
    Draws draws({5, 0, static_cast<std::uint32_t>(k), 1, 0});
    sum += read_pixel(d, 20, 1, draws).adu - d.bias_adu - 20 / d.gain_e_adu;
  }
  EXPECT_LT(std::abs(sum / trials), .02); // ADU
}

TEST(Detector, AFullWellSaysSo) {
  Detector d = camera(DetectorModel::Cmos);
  d.well_e = 1000;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    Draws draws({7, 0, k, 0, 0});
    EXPECT_TRUE(read_pixel(d, 1300, 1, draws).is_saturated);
    Draws again({7, 1, k, 0, 0});
    EXPECT_FALSE(read_pixel(d, 500, 1, again).is_saturated);
  }
  d.well_e = 0;
  d.bits = 8;
  Draws draws({9, 0, 0, 0, 0});
  const PixelReading reading = read_pixel(d, 1e5, 1, draws);
  EXPECT_TRUE(reading.is_saturated);
  EXPECT_EQ(reading.adu, 255);
}

TEST(Draws, BelongToTheirKey) {
  Draws a({1, 2, 3, 4, 5}), b({1, 2, 3, 4, 5}), c({1, 2, 4, 4, 5});
  const auto first = a();
  EXPECT_EQ(first, b());
  EXPECT_NE(first, c());
}

} // namespace
} // namespace umov
