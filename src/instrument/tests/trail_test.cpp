// The trail of an object across a frame against package satsim's (tests/data/detector/README.md).
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <umov/instrument/exposure.h>
#include <umov/instrument/pixel_image.h>

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

} // namespace
} // namespace umov
