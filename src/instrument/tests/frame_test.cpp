#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <umov/instrument/frame_observer.h>
#include <umov/instrument/mosaic.h>

namespace umov {
namespace {

double sum_of(const PixelFrame &frame) {
  return std::accumulate(frame.value.begin(), frame.value.end(), 0.);
}

double width_sigma(double fwhm) { return fwhm / std::sqrt(8 * std::log(2.)); }

/// A Gaussian's light on pixel k of a row, its centre at x.
double on_pixel(int k, double x, double sigma) {
  const double root = sigma * std::sqrt(2.);
  return (std::erf((k + .5 - x) / root) - std::erf((k - .5 - x) / root)) / 2;
}

TEST(PixelImage, PixelsHoldTheIntegralOfAGaussian) {
  for (const double fwhm : {1., 1.5, 2., 3., 4., 9.}) {
    const PixelImage image(ImageProfile::Gauss, fwhm);
    const double sigma = width_sigma(fwhm), peak = std::pow(on_pixel(0, 0, sigma), 2);
    // The cubic between phases leaves 9/16 h^4/24 of the fourth derivative, at most .07 (h/sigma)^4
    // of the peak, in each direction; h is an eighth of a pixel up to 2 px, then stays .06 widths.
    const double h = fwhm < 2 ? .125 : fwhm / 16;
    const double tolerance = 2 * .07 * std::pow(h / sigma, 4) * peak;
    for (const auto &[x, y] : {std::pair{20., 20.}, {20.3, 19.9}, {20.49, 20.5}, {19.77, 20.06}}) {
      PixelFrame frame = PixelFrame::blank(41, 43);
      image.add(frame, x, y, {1, 1, 1, 1});
      for (int row = 0; row < 43; ++row)
        for (int column = 0; column < 41; ++column)
          EXPECT_NEAR(frame.value[frame.index(column, row)],
                      on_pixel(column, x, sigma) * on_pixel(row, y, sigma), tolerance)
              << fwhm << " at " << column << " " << row;
    }
  }
}

TEST(PixelImage, LightWithinARadiusIsThatOfTheProfile) {
  const PixelImage image(ImageProfile::Moffat, 12);
  PixelFrame frame = PixelFrame::blank(201, 201);
  image.add(frame, 100, 100, {1, 1, 1, 1});
  EXPECT_NEAR(sum_of(frame), 1, 1e-5); // what lies beyond six widths
  for (const double radius : {1., 1.5, 2.}) {
    double mean = 0; // over phases: one by itself has the stairs of its pixels, .6 per cent at 1
    for (int k = 0; k < 100; ++k) {
      const FramePoint centre{100 + std::fmod(.618 * k, 1), 100 + std::fmod(.755 * k, 1)};
      PixelFrame one = PixelFrame::blank(201, 201);
      image.add(one, centre.x, centre.y, {1, 1, 1, 1});
      mean += share_of(one, 1, {{centre}, 12 * radius, 0, 0}) / 100;
    }
    EXPECT_NEAR(mean, share_inside(ImageProfile::Moffat, radius), 2e-3);
  }
}

TEST(PixelImage, PlacesOfAMosaicTakeTheirOwnLight) {
  const PixelImage image(ImageProfile::Gauss, 3);
  PixelFrame all = PixelFrame::blank(40, 40), some = all;
  image.add(all, 20.2, 19.6, {1, 1, 1, 1});
  image.add(some, 20.2, 19.6, {0, 0, 5, 0}); // odd rows, even columns
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 40; ++column)
      EXPECT_DOUBLE_EQ(some.value[some.index(column, row)],
                       row % 2 == 1 && column % 2 == 0 ? 5 * all.value[all.index(column, row)] : 0);
}

/// O13: the closed form against sums over pixels, down to a width of one.
TEST(PixelImage, AliasOfTheMosaic) {
  for (const double fwhm : {1., 1.5, 2., 3., 4.}) {
    const double sigma = width_sigma(fwhm);
    double worst = 0;
    for (double x = 0; x < 1; x += .1) {
      double even = 0;
      for (int k = -30; k <= 30; k += 2)
        even += on_pixel(k, x, sigma);
      const double n90 = even * even, n0 = (1 - even) * (1 - even);
      worst = std::max(worst, std::abs(mosaic_alias(fwhm, x, x).q - (n0 - n90) / (n0 + n90)));
    }
    EXPECT_LT(worst, 1e-9) << fwhm; // the lattice's fifth harmonic
  }
}

Detector camera() {
  Detector out;
  out.model = DetectorModel::Cmos;
  out.read_e = 2.3;
  out.gain_e_adu = 2.6;
  out.bits = 12;
  out.well_e = 10500;
  return out;
}

/// What one draw of a table and electrons, noise and rounding one by one have in common.
TEST(DrawFrame, BackgroundHasTheMomentsOfPixels) {
  Detector odd = camera();
  odd.nonlinearity = .02;
  odd.gain_e_adu = .7;
  for (const Detector &d : {camera(), odd, Detector{}})
    for (const double mean : {.3, 8., 300.}) {
      constexpr int side = 300, n = side * side;
      const PixelFrame none = PixelFrame::blank(side, side);
      const RawFrame table = draw_frame(d, none, {mean, mean, mean, mean}, 1, {1, 0, 5, 0, 0});
      double t = 0, tt = 0, s = 0, ss = 0;
      for (std::size_t k = 0; k < n; ++k) {
        Draws draws({2, 0, 5, 0, static_cast<std::uint32_t>(k)});
        const double a = table.adu[k], b = read_pixel(d, mean, 1, draws).adu;
        t += a / n, tt += a * a / n, s += b / n, ss += b * b / n;
      }
      const double variance = ss - s * s;
      // Four standard errors of a difference of two; of a variance with its kurtosis, 3 + 1/mean.
      EXPECT_NEAR(t, s, 4 * std::sqrt(2 * variance / n)) << mean;
      EXPECT_NEAR((tt - t * t) / variance, 1, 4 * std::sqrt(2 * (2 + 1 / mean) / n)) << mean;
      EXPECT_TRUE(table.saturated.empty());
    }
}

TEST(DrawFrame, FullPixelsAreTold) {
  PixelFrame light = PixelFrame::blank(8, 8);
  light.value[light.index(3, 4)] = 1e6;
  const RawFrame frame = draw_frame(camera(), light, {5, 5, 5, 5}, 1, {1, 0, 0, 0, 0});
  ASSERT_EQ(frame.saturated.size(), 1u);
  EXPECT_EQ(frame.saturated.front(), 4u * 8 + 3);
}

TEST(SumFrame, NoiseIsThatOfTheCcdEquation) {
  // Merline & Howell 1995 with the camera's figures: aperture_variance, tested by itself.
  const Detector d = camera();
  const PixelImage image(ImageProfile::Gauss, 3);
  PixelFrame light = PixelFrame::blank(64, 64);
  constexpr double star = 5000, sky = 20;
  image.add(light, 31.4, 32.2, {star, star, star, star});
  const FrameAperture aperture{{{31.4, 32.2}}, 6, 12, 18};
  const double inside = light_in(light, aperture);
  double sum = 0, squares = 0;
  ApertureCounts counts{inside, sky, 0, 0, 0};
  constexpr int trials = 20'000;
  for (std::uint32_t k = 0; k < trials; ++k) {
    const auto one = sum_frame(d, draw_frame(d, light, {sky, sky, sky, sky}, 1, {3, 0, k, 0, 0}),
                               aperture, false, {})[0];
    const double net = one.electrons - one.sky;
    sum += net / trials, squares += net * net / trials;
    counts.pixels = one.pixels, counts.sky_pixels = one.ring_pixels;
  }
  const double variance = aperture_variance(d, counts);
  EXPECT_NEAR(sum, inside, 4 * std::sqrt(variance / trials));
  // One per cent is a standard error: variances scatter by sqrt(2/N) of themselves.
  EXPECT_NEAR((squares - sum * sum) / variance, 1, 4 * std::sqrt(2. / trials));
}

/// Light of a Moffat image along a line through it, within y of its middle: across, the profile is
/// Student's distribution of 2 b - 2 degrees of freedom.
double line_within(double y, double fwhm) {
  constexpr double b = 4.765;
  const double scale = 4 * (std::exp2(1 / b) - 1) / (fwhm * fwhm), freedom = 2 * b - 2;
  return 2 * boost::math::cdf(boost::math::students_t(freedom), y * std::sqrt(scale * freedom)) - 1;
}

/// A trail right across the frame. Its wings reach into the ring and are taken for sky there:
/// counts less sky are what the share says, and the share is that of the closed form.
TEST(SumFrame, WingsInTheRingAreAccountedFor) {
  constexpr double fwhm = 3;
  constexpr int columns = 60, rows = 81, middle = 40;
  const PixelImage image(ImageProfile::Moffat, fwhm);
  PixelFrame light = PixelFrame::blank(columns, rows);
  constexpr double per_px = 1e8, step = .25;
  for (double x = -60; x < 120; x += step) {
    const double part = per_px * step;
    image.add(light, x, middle, {part, part, part, part});
  }
  const FrameAperture aperture{{{-60, middle}, {120, middle}}, 2 * fwhm, 4 * fwhm, 6 * fwhm};
  // 13 rows of pixels, out to 6.5 px, and 7 of the ring on either side, from 11.5 to 18.5.
  const double in_ring = line_within(18.5, fwhm) - line_within(11.5, fwhm);
  const double expected = line_within(6.5, fwhm) - in_ring * 13 / 14;
  EXPECT_GT(in_ring, 4e-5); // what was missing
  const double share = share_of(light, per_px * columns, aperture);
  EXPECT_NEAR(share, expected, 2e-5); // beyond six widths the image has 7e-6, on a line a bit more
  RawFrame raw{columns, rows, {}, {}};
  for (const double electrons : light.value)
    raw.adu.push_back(static_cast<std::int32_t>(std::lround(electrons)));
  const FrameSum sum = sum_frame(Detector{}, raw, aperture, false, {})[0];
  EXPECT_NEAR((sum.electrons - sum.sky) / (per_px * columns), share, 1e-7); // whole electrons
}

/// O13: fitted by its image, a star two pixels wide has no false polarization at any phase.
TEST(FitStar, IsNotBiasedByThePhaseOfAMosaic) {
  const Detector d = camera();
  const PixelImage image(ImageProfile::Gauss, 2);
  constexpr double light = 40'000;
  constexpr int trials = 4000;
  double mean = 0, squares = 0, variance = 0, summed = 0;
  for (std::uint32_t k = 0; k < trials; ++k) {
    Draws at({9, 0, k, 0, 0});
    const double x = 15 + at() / 4294967296., y = 15 + at() / 4294967296.;
    PixelFrame frame = PixelFrame::blank(32, 32);
    image.add(frame, x, y, {light, light, light, light});
    const RawFrame raw = draw_frame(d, frame, {3, 3, 3, 3}, 1, {4, 0, k, 0, 0});
    const StarFit fit = fit_star(d, raw, image, {15.5, 15.5}, 8, true);
    ASSERT_TRUE(fit.has_converged);
    const auto &n = fit.electrons; // 90 45 / 135 0
    const double q = (n[3] - n[0]) / (n[3] + n[0]);
    mean += q / trials, squares += q * q / trials;
    variance += (fit.variance[0] + fit.variance[3]) / std::pow(n[0] + n[3], 2) / trials;
    // What sums alone make of it, at its worst.
    const MosaicAlias alias = mosaic_alias(2, x, y);
    summed += alias.q * alias.q / trials;
  }
  const double sd = std::sqrt(squares - mean * mean);
  EXPECT_LT(std::abs(mean), .1 * sd);
  EXPECT_NEAR(sd / std::sqrt(variance), 1, .05); // four standard errors of a standard deviation
  EXPECT_GT(std::sqrt(summed), 2 * sd);          // of the alias that is gone
}

} // namespace
} // namespace umov
