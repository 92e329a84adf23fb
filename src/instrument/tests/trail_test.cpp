// The trail of an object across a frame against package satsim's (tests/data/detector/README.md).
#include "instrument/tests/anchor.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <umov/instrument/exposure.h>
#include <umov/instrument/pixel_image.h>
#include <umov/instrument/trail_slices.h>

namespace umov {
namespace {

constexpr int side = 48;
constexpr double seconds = .8, fwhm = 3, magnitude = 12, zero_point = 20.57117;
constexpr double speed_x = 31, speed_y = 9; // pixels a second

struct LitPixel {
  int x = 0, y = 0;
  double electrons = 0;
};

std::vector<LitPixel> trail_by_satsim() {
  std::ifstream file(UMOV_SOURCE_DIR "/tests/data/detector/trail_satsim.csv");
  std::vector<LitPixel> out;
  char comma = 0;
  LitPixel p;
  for (std::string line; std::getline(file, line);)
    if (std::istringstream cells(line); cells >> p.x >> comma >> p.y >> comma >> p.electrons)
      out.push_back(p);
  return out;
}

/// The same as frames make it: images at Gauss points on panels of half a width.
PixelFrame trail() {
  const PixelImage image(ImageProfile::Gauss, fwhm);
  PixelFrame out = PixelFrame::blank(side, side);
  const double electrons = seconds * std::pow(10, .4 * (zero_point - magnitude));
  // A frame's edge stands half a pixel before its first pixel's centre.
  const double x0 = .22 * side - .5, y0 = .30 * side - .5;
  for (const ExposureNode &node :
       exposure_nodes(seconds, fwhm / 2 / std::hypot(speed_x, speed_y))) {
    const double t = seconds / 2 + node.offset_s, light = electrons * node.weight;
    image.add(out, x0 + speed_x * t, y0 + speed_y * t, {light, light, light, light});
  }
  return out;
}

/// Light of a trail along a row, of an image of sigma `fine` pixels, in the pixels around it whose
/// corners are two sigmas away: `fine` pixels stand for one.
double light_in_box(int fine, double length, PixelFrame frame, int x0, int y0) {
  const double width = fine * std::sqrt(8 * std::log(2.));
  const PixelImage image(ImageProfile::Gauss, width);
  for (const ExposureNode &node : exposure_nodes(1, width / 2 / length)) {
    const double light = node.weight;
    image.add(frame, x0 + .5 + length * (.5 + node.offset_s), y0 + .5,
              {light, light, light, light});
  }
  const int around = 2 * fine, across = static_cast<int>(std::lround(length)) + around;
  double inside = 0;
  for (int row = y0 + 1 - around; row <= y0 + around; ++row)
    for (int column = x0 + 1 - around; column <= x0 + across; ++column)
      inside += frame.value[frame.index(column, row)];
  return inside;
}

/// A trail of 11 px of an image of sigma 1 px: what two pixels around it hold, in closed form.
TEST(Trail, BoxAroundIt) { // cubics of the image's table
  EXPECT_NEAR(light_in_box(1, 11, PixelFrame::blank(40, 28), 12, 12), of("trail_box"), 1e-4);
}

/// A lens of 16 arcsec a pixel, .5 deg/s, .1 s, in pixels of a quarter of one, whose corners the
/// box of two whole ones around the trail then meets.
TEST(Trail, BoxAroundThatOfALens) {
  constexpr int fine = 4;
  const double length = fine * trail_length_px(.5 * pi / 180, .1, 16);
  EXPECT_NEAR(length, fine * of("trail_lens_px"), 1e-9);
  EXPECT_NEAR(light_in_box(fine, length, PixelFrame::blank(160, 112), 50, 50), of("trail_lens_box"),
              1e-4); // cubics of the image's table
}

TEST(Trail, IsThatOfSatsim) {
  const auto theirs = trail_by_satsim();
  ASSERT_GT(theirs.size(), 200U);
  const PixelFrame ours = trail();
  const double peak = *std::max_element(ours.value.begin(), ours.value.end());
  double sum = 0, expected = 0;
  for (const LitPixel &p : theirs) {
    const double found = ours.value[ours.index(p.x, p.y)];
    // It has the object on a line of pixels of a fifteenth: up to a thirtieth off, which shows at
    // the flanks, .8 of the peak a pixel, by a little more than one per cent at single pixels.
    EXPECT_NEAR(found, p.electrons, .02 * peak) << p.x << " " << p.y;
    sum += found;
    expected += p.electrons;
  }
  EXPECT_NEAR(sum / expected, 1, 2e-3); // of magnitude and zero point
  // Along the middle of the trail, light per pixel of its length.
  double along = 0, theirs_along = 0;
  for (const LitPixel &p : theirs)
    if (p.x >= 16 && p.x <= 28) {
      along += ours.value[ours.index(p.x, p.y)];
      theirs_along += p.electrons;
    }
  EXPECT_NEAR(along / theirs_along, 1, .01);
}

/// A Gaussian star over the middle of a piece as long as it is wide: erf(sqrt(ln 2)) of its light
/// lies between the cuts.
TEST(TrailSlices, PiecesShareAStar) {
  const PixelImage image(ImageProfile::Gauss, 4);
  const FrameAperture aperture{{{10, 20}, {30, 20}, {50, 20}}, 8, 16, 24};
  const TrailSlices slices = cut_trail(aperture, 64, 41, 4);
  EXPECT_EQ(slices.count, 10u);
  // Piece 5 has the columns 30 to 33.
  const std::vector<LatticeValues> shares = shares_in(slices, image, {31.5, 20});
  double all = 0;
  for (std::size_t k = 0; k < slices.count; ++k)
    for (const double share : shares[k])
      all += share;
  const double own = shares[5][0] + shares[5][1] + shares[5][2] + shares[5][3];
  EXPECT_NEAR(own, std::erf(std::sqrt(std::log(2.))), 1e-4);
  EXPECT_NEAR(all, 1, 1e-4); // a circle of two widths
  double pixels = 0;
  for (const double one : slices.pixels)
    pixels += one;
  EXPECT_NEAR(pixels, 40 * 17 + pi * 64, 20); // a stadium, its edge along pixels
  // A star that stands makes one piece.
  EXPECT_EQ(cut_trail({{{10, 20}}, 8, 16, 24}, 64, 41, 4).count, 1u);
}

} // namespace
} // namespace umov
