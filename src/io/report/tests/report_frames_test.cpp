#include "io/report/tests/synthetic_curve.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <umov/io/report_frames.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

Scene sphere_of(const std::string &material) {
  Scene scene;
  scene.mesh = make_sphere(1.5, 200);
  scene.bands = *bands_from({"paper_rgb"});
  scene.grid = *BandGrid::make(scene.bands);
  scene.front.push_back(*Surface::compile(*builtin_material(material), scene.bands));
  scene.back = scene.front;
  return scene;
}

TEST(ReportFrames, ChosenEpochsHoldTheBrightestAndNoDarkOne) {
  const LightCurve curve = test::synthetic_curve();
  const auto chosen = choose_key_epochs(curve, 4);
  EXPECT_EQ(chosen.size(), 8U); // four in each of two passes
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  std::size_t brightest = 0;
  for (std::size_t i = 0; i < curve.epochs.size(); ++i)
    if (curve.samples[3 * i + 1].intensity > curve.samples[3 * brightest + 1].intensity)
      brightest = i;
  EXPECT_NE(std::find(chosen.begin(), chosen.end(), brightest), chosen.end());
  for (const std::size_t i : chosen)
    EXPECT_FALSE(curve.epochs[i].is_dark);
  EXPECT_TRUE(choose_key_epochs(curve, 0).empty());
}

TEST(ReportFrames, SeriesHasThreePicturesPerEpochAndTheSideOfTheSun) {
  const Scene scene = sphere_of("paper_al");
  const LightCurve curve = test::synthetic_curve(20);
  KeyFrameOptions options;
  options.half_width_m = 2;
  options.size = 24;
  const auto frames = make_key_frames(scene, curve, choose_key_epochs(curve, 2), options);
  ASSERT_TRUE(frames) << frames.error().text();
  ASSERT_FALSE(frames->empty());
  for (const ReportKeyFrame &frame : *frames) {
    ASSERT_EQ(frame.pictures.size(), 3U);
    for (const ReportPicture &picture : frame.pictures)
      EXPECT_EQ(picture.png.substr(1, 3), "PNG");
    EXPECT_LE(std::hypot(frame.sun_right, frame.sun_up), 1 + 1e-12); // part of a unit vector
  }
}

} // namespace
} // namespace umov
