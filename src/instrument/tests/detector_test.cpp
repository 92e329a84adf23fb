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

/// With the excess of 2 of an endless register, as a detector with a finite one can be asked for:
/// the variance is linear in it, and what it multiplies is that of an ideal detector.
double doubled_variance(const Detector &d, const ApertureCounts &counts) {
  const double multiplied = aperture_variance(Detector{}, counts);
  return aperture_variance(d, counts) + (2 - excess_variance(d)) * multiplied;
}

TEST(Detector, CcdEquationBehindAnEndlessRegister) { // nine digits
  Detector d = camera(DetectorModel::Emccd);
  d.em_gain = 300, d.read_e = 60, d.gain_e_adu = 10;
  const double variance = doubled_variance(d, {1e4, 20, .5, 50, 500});
  EXPECT_NEAR(variance, of("emccd_doubled"), 1e-4);
  EXPECT_NEAR(1e4 / std::sqrt(variance), of("emccd_doubled_snr"), 1e-6);
  EXPECT_NEAR(40 / std::sqrt(doubled_variance(d, {40, .1, .01, 9, 0})), of("faint_emccd_doubled"),
              1e-8);
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

/// A fiftieth of a full well turns q = .05 of two beams into .04898.
TEST(Detector, NumbersThatBendDilutePolarization) { // nine digits
  Detector d = camera(DetectorModel::Ccd);
  d.nonlinearity = .02;
  d.well_e = 10500;
  const auto q_of = [](double o, double x) { return (o - x) / (o + x); };
  const double o = bent(d, 10500 * 1.05), x = bent(d, 10500 * .95);
  EXPECT_NEAR(q_of(o, x), of("bent_q"), 1e-10);
  EXPECT_NEAR(q_of(straightened(d, o), straightened(d, x)), .05, 1e-13);
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

TEST(Detector, RollingShuttersExposeWhatRunsLongerOrShorter) {
  Detector d = camera(DetectorModel::Cmos);
  d.line_time_s = 9.24e-6;
  EXPECT_EQ(rolling_change(d, 112.5), 0); // of a global one
  d.has_rolling_shutter = true;
  EXPECT_NEAR(rolling_change(d, 112.5), .0010395,
              1e-10); // .5 deg/s on 16 arcsec: 112.5 rows a second
}

/// Photons one by one, each of which is told if the last before it came longer ago than the dead
/// time: mean and variance of what is told, and of what that is taken for.
TEST(Detector, CountersThatAreProlonged) {
  Detector d;
  d.model = DetectorModel::Counter;
  d.is_paralyzable = true;
  d.dead_time_s = 50e-9;
  EXPECT_NEAR(counted_rate(d, 1e6), of("prolonged"), 1e-3); // nine digits
  for (const double x : {.05, .3}) {
    const double rate = x / d.dead_time_s, exposure_s = 4000 / rate;
    constexpr std::uint32_t trials = 2000;
    double told = 0, squares = 0, drawn = 0, drawn_squares = 0, back = 0, back_squares = 0;
    for (std::uint32_t k = 0; k < trials; ++k) {
      Draws photons({61, 0, k, static_cast<std::uint32_t>(100 * x), 0});
      double n = 0, t = 0;
      while (true) {
        const double gap = photons.gamma(1) / rate; // between two photons
        t += gap;
        if (t > exposure_s)
          break;
        n += gap > d.dead_time_s ? 1 : 0;
      }
      const double photons_back = corrected_count(d, n, exposure_s).electrons;
      Draws draws({62, 0, k, static_cast<std::uint32_t>(100 * x), 0});
      const double ours = draw_aperture(d, 4000, 1, exposure_s, draws);
      told += n / trials, squares += n * n / trials;
      drawn += ours / trials, drawn_squares += ours * ours / trials;
      back += photons_back / trials, back_squares += photons_back * photons_back / trials;
    }
    const double variance = squares - told * told;
    const double se = 4 * std::sqrt(variance / trials), share = 4 * std::sqrt(2. / trials);
    EXPECT_NEAR(told, counted_rate(d, rate) * exposure_s, se);
    EXPECT_NEAR(variance / (told * counter_fano(d, rate)), 1, share);
    EXPECT_NEAR(drawn, told, std::sqrt(2.) * se);
    EXPECT_NEAR((drawn_squares - drawn * drawn) / variance, 1, std::sqrt(2.) * share);
    const CorrectedCount mean = corrected_count(d, told, exposure_s);
    EXPECT_NEAR(back, 4000, se * std::sqrt(mean.excess2) * 1.5 + 1); // and a photon for its bend
    EXPECT_NEAR((back_squares - back * back) / (4000 * mean.excess2), 1, share);
  }
  // At its peak it tells nothing, and beyond the same as before.
  EXPECT_TRUE(corrected_count(d, .36 / d.dead_time_s, 1).is_saturated);
  EXPECT_FALSE(corrected_count(d, .3 / d.dead_time_s, 1).is_saturated);
  EXPECT_TRUE(is_paralysed(d, 3 / d.dead_time_s));
  EXPECT_FALSE(is_paralysed(d, .5 / d.dead_time_s));
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

TEST(Detector, WhatCountsPhotonsRoundsNothing) {
  for (const auto model : {DetectorModel::Ideal, DetectorModel::Counter}) {
    Detector d = camera(model); // with a gain, a bias, bits and a well that are of converters
    d.well_e = 50;
    d.bits = 6;
    constexpr int trials = 20'000;
    double sum = 0, squares = 0;
    for (std::uint32_t k = 0; k < trials; ++k) {
      Draws draws({5, 0, k, 1, 0});
      const PixelReading reading = read_pixel(d, 200, 1, draws);
      EXPECT_FALSE(reading.is_saturated);
      const double n = electrons_of(d, reading);
      EXPECT_EQ(n, reading.adu); // a photon is a number of 1
      sum += n / trials, squares += n * n / trials;
    }
    // Four standard errors; rounding by 2.6 e would add .3 % to the variance, and steps of it.
    EXPECT_NEAR(sum, 200, 4 * std::sqrt(200. / trials));
    EXPECT_NEAR((squares - sum * sum) / 200, 1, 4 * std::sqrt(2. / trials));
    EXPECT_EQ(adu_per_electron(d), 1);
    EXPECT_EQ(fixed_variance(d), 0);
  }
}

TEST(Detector, NumbersOfARegisterAreThoseBehindIt) {
  Detector d = camera(DetectorModel::Emccd);
  d.em_gain = 300, d.gain_e_adu = 10;
  EXPECT_NEAR(adu_per_electron(d), 30, 1e-12);
  d.model = DetectorModel::Ccd; // whose gain of a register says nothing
  EXPECT_NEAR(adu_per_electron(d), .1, 1e-15);
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
