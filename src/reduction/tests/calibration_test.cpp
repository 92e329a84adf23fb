#include "reduction/tests/anchor.h"

#include <functional>
#include <gtest/gtest.h>
#include <umov/instrument/draws.h>
#include <umov/reduction/calibration.h>

namespace umov {
namespace {

using Complex = std::complex<double>;
constexpr double degree = pi / 180;
const Complex factor = std::polar(.985, 2 * .8 * degree), offset{.0042, -.0018};
constexpr double sd = 5e-4;

/// An unpolarized star at four angles and HD 204827 (4.893 %, 59.10 deg: Schmidt et al. 1992).
std::vector<StandardMeasurement> night() {
  std::vector<StandardMeasurement> out;
  const Complex star = std::polar(.04893, 2 * 59.10 * degree);
  for (const double axis : {0., 30., 60., 90.})
    out.push_back({offset, 0, axis * degree, sd});
  for (const double axis : {10., 40., 70., 100.})
    out.push_back(
        {factor * star * std::polar(1., -2 * axis * degree) + offset, star, axis * degree, sd});
  return out;
}

TEST(PolarimeterCalibration, IsRecoveredWithItsErrors) { // nine digits
  const auto found = calibrate_polarimeter(night());
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::abs(found->factor - factor), 0, 1e-14);
  EXPECT_NEAR(std::abs(found->offset - offset), 0, 1e-15);
  EXPECT_NEAR(found->factor_sd, of("standards_factor_sd"), 1e-11);
  EXPECT_NEAR(found->offset_sd, of("standards_offset_sd"), 1e-12);
  // Of phi0, half the angle of the factor.
  EXPECT_NEAR(found->factor_sd / std::abs(found->factor) / 2 / degree, of("standards_phi0_sd_deg"),
              1e-9);
  const Complex target{.25, -.11};
  const auto back = apply(*found, factor * target * std::polar(1., -.7) + offset, .35, 1e-8);
  EXPECT_NEAR(std::abs(back.value - target), 0, 1e-14);
}

/// Pulls of efficiency, phi0, q0 and u0 over many nights, each made by `night_of`.
void check_pulls(std::uint32_t stream, double mean_within,
                 const std::function<std::vector<StandardMeasurement>(Draws &)> &night_of) {
  constexpr std::uint32_t nights = 2000;
  double sums[4]{}, squares[4]{}, chi2 = 0;
  for (std::uint32_t t = 0; t < nights; ++t) {
    Draws draws({stream, 0, t, 0, 0});
    const auto found = calibrate_polarimeter(night_of(draws));
    const double pulls[] = {(std::abs(found->factor) - .985) / found->factor_sd,
                            (std::arg(found->factor) / 2 - .8 * degree) /
                                (found->factor_sd / .985 / 2),
                            (found->offset.real() - .0042) / found->offset_sd,
                            (found->offset.imag() + .0018) / found->offset_sd};
    for (std::size_t k = 0; k < 4; ++k)
      sums[k] += pulls[k], squares[k] += pulls[k] * pulls[k];
    chi2 += found->chi2 / found->dof / nights;
  }
  for (std::size_t k = 0; k < 4; ++k) { // 2,000: .022 and .016
    const double mean = sums[k] / nights;
    EXPECT_NEAR(mean, 0, mean_within) << k;
    EXPECT_NEAR(std::sqrt(squares[k] / nights - mean * mean), 1, .05) << k;
  }
  EXPECT_NEAR(chi2, 1, 4 * std::sqrt(2. / 12 / nights));
}

TEST(PolarimeterCalibration, PullsOfManyNights) {
  check_pulls(41, .05, [](Draws &draws) {
    auto data = night();
    for (StandardMeasurement &one : data)
      one.measured += sd * Complex(draws.normal(), draws.normal());
    return data;
  });
}

/// HD 204827 is known to .029 % and .17 deg (Schmidt et al. 1992): however often it is measured,
/// the instrument is not known better.
std::vector<StandardMeasurement> uncertain_night() {
  auto out = night();
  for (StandardMeasurement &one : out)
    if (std::abs(one.truth) > 0) {
      one.star = 1;
      one.degree_sd = .00029;
      one.angle_sd = .17 * degree;
    }
  return out;
}

TEST(PolarimeterCalibration, KnowsHowWellAStarIsKnown) { // nine digits
  const auto found = calibrate_polarimeter(uncertain_night());
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::abs(found->factor - factor), 0, 1e-14);
  EXPECT_NEAR(std::abs(found->offset - offset), 0, 1e-15);
  EXPECT_NEAR(found->factor_sd, of("uncertain_factor_sd"), 1e-11);
  EXPECT_NEAR(found->offset_sd, of("uncertain_offset_sd"), 1e-12);
  auto often = uncertain_night();
  for (int k = 0; k < 99; ++k)
    for (const StandardMeasurement &one : uncertain_night())
      often.push_back(one);
  const double star = .985 * .00029 / .04893; // along the star's own direction
  EXPECT_GT(calibrate_polarimeter(often)->factor_sd, star);
}

TEST(PolarimeterCalibration, PullsWhereTheStarIsUncertain) {
  check_pulls(43, .09, [](Draws &draws) { // 4 of the mean's own
    auto data = uncertain_night();
    const Complex star =
        std::polar(.04893 + .00029 * draws.normal(), 2 * (59.10 + .17 * draws.normal()) * degree);
    const Complex other = 5e-4 * Complex(draws.normal(), draws.normal()); // not quite unpolarized
    for (StandardMeasurement &one : data) {
      one.measured = sd * Complex(draws.normal(), draws.normal()) + offset +
                     factor * (one.star == 1 ? star : other) * std::polar(1., -2 * one.axis_rad);
      if (one.star == 0)
        one.degree_sd = 5e-4;
    }
    return data;
  });
}

TEST(PolarimeterCalibration, OneAngleIsNotEnough) {
  auto data = night();
  data.erase(data.begin(), data.begin() + 4);
  for (StandardMeasurement &one : data)
    one.axis_rad = 0;
  EXPECT_FALSE(calibrate_polarimeter(data));
  data.clear();
  EXPECT_FALSE(calibrate_polarimeter(data));
}

TEST(ChannelCalibration, EighteenAngles) {
  std::vector<double> angles, counts;
  const StokesRow row = analyser_row(45, 2e4);
  for (int k = 0; k < 18; ++k) {
    angles.push_back(k * 20 * degree);
    counts.push_back(row[0] + row[1] * std::cos(2 * angles.back()) +
                     row[2] * std::sin(2 * angles.back()));
  }
  const auto found = calibrate_channel(angles, counts, 1e4);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(found->row[k], row[k], 1e-8);
  // (S S^T)^-1 of even angles: 1/n, 2/n, 2/n.
  EXPECT_NEAR(found->sd[0], 100 / std::sqrt(18.), 1e-10);
  EXPECT_NEAR(found->sd[1], 100 * std::sqrt(2 / 18.), 1e-10);
  const std::vector<double> two{0, pi};
  EXPECT_FALSE(calibrate_channel(two, two, 1));
}

/// Photons of 18 polarizer angles through the four orientations of a mosaic: every element of the
/// matrix is found within its errors.
TEST(ChannelCalibration, MatrixOfAMosaicWithinItsErrors) {
  constexpr std::uint32_t trials = 2000;
  const double turned_by[] = {90.7, 44.2, 135.4, -.3}, gains[] = {2e4, 1.96e4, 2.04e4, 2.02e4};
  double sums[3]{}, squares[3]{};
  for (std::uint32_t t = 0; t < trials; ++t)
    for (std::uint32_t c = 0; c < 4; ++c) {
      const StokesRow row = analyser_row(turned_by[c], gains[c]);
      Draws draws({42, 0, t, c, 0});
      std::vector<double> angles, counts;
      for (int k = 0; k < 18; ++k) {
        angles.push_back(k * 20 * degree);
        counts.push_back(draws.poisson(row[0] + row[1] * std::cos(2 * angles.back()) +
                                       row[2] * std::sin(2 * angles.back())));
      }
      // Over even angles the variances of the counts act as their mean.
      const auto found = calibrate_channel(angles, counts, row[0]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double pull = (found->row[k] - row[k]) / found->sd[k];
        sums[k] += pull, squares[k] += pull * pull;
        if (t == 0) {
          EXPECT_LT(std::abs(pull), 3) << c << k;
        }
      }
    }
  for (std::size_t k = 0; k < 3; ++k) { // 8,000 of each: .011 and .008
    const double mean = sums[k] / (4 * trials);
    EXPECT_NEAR(mean, 0, .05) << k;
    EXPECT_NEAR(std::sqrt(squares[k] / (4 * trials) - mean * mean), 1, .05) << k;
  }
}

/// Stars of an instrumental magnitude with zero point, extinction, colour term and k''.
std::vector<PhotometricStandard> stars_through(std::span<const double> mags,
                                               std::span<const double> x, std::span<const double> c,
                                               std::span<const double> left, double second_order) {
  std::vector<PhotometricStandard> out;
  for (std::size_t k = 0; k < mags.size(); ++k)
    out.push_back(
        {mags[k],
         mags[k] - 20.571 + .118 * x[k] - .030 * c[k] - second_order * c[k] * x[k] + left[k], x[k],
         c[k]});
  return out;
}

TEST(PhotometricCalibration, ExtinctionOfSecondOrder) { // nine digits
  const double mags[] = {8.120, 9.455, 8.902, 10.231, 9.017, 9.788, 8.551, 9.203};
  const double x[] = {1.02, 1.21, 1.55, 1.08, 1.90, 1.37, 2.10, 1.15};
  const double c[] = {.05, .62, 1.10, .35, .71, -.02, 1.25, 1.31};
  const double left[] = {.004, -.003, .002, -.005, .001, .001, -.002, .003};
  const auto stars = stars_through(mags, x, c, left, .035);
  const auto found = calibrate_photometry(stars, 4);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found->zero_point, of("second_order_zero"), 1e-7);
  EXPECT_NEAR(found->extinction, of("second_order_extinction"), 1e-9);
  EXPECT_NEAR(found->colour_term, of("second_order_colour"), 1e-9);
  EXPECT_NEAR(found->second_order, of("second_order_second"), 1e-9);
  EXPECT_NEAR(std::sqrt(found->covariance[3][3]), of("second_order_second_sd"), 1e-10);
  // Of an object as red as the Sun at an air mass of 2.
  const PhotometricOffset offset = offset_of(*found, 2, .653);
  EXPECT_NEAR(offset.mag, of("second_order_offset"), 1e-7);
  EXPECT_NEAR(std::sqrt(offset.variance), of("second_order_offset_sd"), 1e-10);
  EXPECT_FALSE(calibrate_photometry(std::span(stars).first(4), 4));
  EXPECT_TRUE(calibrate_photometry(std::span(stars).first(4), 2)); // zero point and extinction
}

TEST(PhotometricCalibration, SixStars) { // nine digits
  const double mags[] = {8.120, 9.455, 8.902, 10.231, 9.017, 9.788};
  const double x[] = {1.02, 1.21, 1.55, 1.08, 1.90, 1.37}, c[] = {.05, .62, 1.10, .35, .71, -.02};
  const double left[] = {.004, -.003, .002, -.005, .001, .001};
  const auto stars = stars_through(mags, x, c, left, 0);
  const auto found = calibrate_photometry(stars);
  EXPECT_NEAR(found->zero_point, of("photometry_zero"), 1e-7);
  EXPECT_NEAR(found->extinction, of("photometry_extinction"), 1e-9);
  EXPECT_NEAR(found->colour_term, of("photometry_colour"), 1e-9);
  const auto &cov = found->covariance;
  EXPECT_NEAR(std::sqrt(cov[0][0]), of("photometry_zero_sd"), 1e-10);
  EXPECT_NEAR(std::sqrt(cov[1][1]), of("photometry_extinction_sd"), 1e-10);
  EXPECT_NEAR(cov[0][1] / std::sqrt(cov[0][0] * cov[1][1]), of("photometry_correlation"), 1e-8);
  EXPECT_NEAR(found->residual_sd, of("photometry_residual"), 1e-10);
  EXPECT_FALSE(calibrate_photometry(std::span(stars).first(3)));
}

} // namespace
} // namespace umov
