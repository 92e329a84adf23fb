// Noise of pixels against package galsim's (tests/data/detector/README.md).
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <umov/instrument/raw_frame.h>

namespace umov {
namespace {

struct Noise {
  double electrons = 0, read_e = 0, gain_e_adu = 0, mean_adu = 0, variance_adu2 = 0;
};

std::vector<Noise> noise_by_galsim() {
  std::ifstream file(UMOV_SOURCE_DIR "/tests/data/detector/ccd_galsim.csv");
  std::vector<Noise> out;
  char comma = 0;
  Noise n;
  for (std::string line; std::getline(file, line);)
    if (std::istringstream cells(line); cells >> n.electrons >> comma >> n.read_e >> comma >>
                                        n.gain_e_adu >> comma >> n.mean_adu >> comma >>
                                        n.variance_adu2)
      out.push_back(n);
  return out;
}

struct Moments {
  double mean = 0, variance = 0;
};
Moments moments_of(const std::vector<double> &numbers) {
  Moments out;
  const auto count = static_cast<double>(numbers.size());
  for (const double x : numbers)
    out.mean += x / count;
  for (const double x : numbers)
    out.variance += (x - out.mean) * (x - out.mean) / count;
  return out;
}

/// Variances of a million pixels are known to .14 %, on both sides; means to a thousandth of a
/// standard deviation.
void expect_same(const Moments &found, const Noise &n, double bias_adu) {
  EXPECT_NEAR(found.variance / n.variance_adu2, 1, .01) << n.electrons;
  EXPECT_NEAR(found.mean - bias_adu, n.mean_adu, .006 * std::sqrt(n.variance_adu2)) << n.electrons;
}

TEST(CcdNoise, IsThatOfGalsim) {
  const auto rows = noise_by_galsim();
  ASSERT_EQ(rows.size(), 6U);
  for (const Noise &n : rows) {
    Detector d;
    d.model = DetectorModel::Ccd;
    d.read_e = n.read_e;
    d.gain_e_adu = n.gain_e_adu;
    d.bits = 17;
    // Sky alone is drawn from a table of its numbers, light pixel by pixel.
    PixelFrame dark = PixelFrame::blank(1000, 1000), lit = dark;
    lit.value.assign(lit.value.size(), n.electrons);
    const double none = 0, sky = n.electrons;
    const RawFrame of_sky = draw_frame(d, dark, {sky, sky, sky, sky}, 1, {41, 0, 0, 0, 0});
    const RawFrame of_light = draw_frame(d, lit, {none, none, none, none}, 1, {42, 0, 0, 0, 0});
    expect_same(moments_of({of_sky.adu.begin(), of_sky.adu.end()}), n, d.bias_adu);
    expect_same(moments_of({of_light.adu.begin(), of_light.adu.end()}), n, d.bias_adu);
  }
}

} // namespace
} // namespace umov
