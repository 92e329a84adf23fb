#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/picture/keyframe.h>
#include <umov/shape/primitives.h>

namespace umov {
namespace {

Scene scene_of(Mesh mesh, const std::vector<std::string> &front,
               const std::vector<std::string> &back) {
  Scene scene;
  scene.mesh = std::move(mesh);
  scene.bands = *bands_from({"paper_rgb"});
  scene.grid = *BandGrid::make(scene.bands);
  for (const std::string &name : front)
    scene.front.push_back(*Surface::compile(*builtin_material(name), scene.bands));
  for (const std::string &name : back)
    scene.back.push_back(*Surface::compile(*builtin_material(name), scene.bands));
  return scene;
}

constexpr double radius = 1.5;

/// Sphere of n = 1 and a body lobe: a Lambert sphere (lobes.md, Body light).
Scene lambert_sphere() {
  return scene_of(make_sphere(radius, 20000), {"paper_spectralon"}, {"paper_spectralon"});
}

// Observer on +x, north on +z, so +y is to the right of the picture (east, -y, is left).
KeyFrameView view_from_x(Vec3<Body> sun) { return {{normalized(sun), {1, 0, 0}}, {0, 0, 1}}; }

Vec3<Body> sun_at_phase(double deg) {
  return {std::cos(deg * (pi / 180)), std::sin(deg * (pi / 180)), 0};
}

KeyFrameOptions small() {
  KeyFrameOptions options;
  options.size = 160;
  options.half_width_m = 2;
  options.threads = 1;
  return options;
}

KeyFrameRaster trace(const Scene &scene, const KeyFrameView &view, const KeyFrameOptions &options) {
  const Occluder occluder(scene.mesh);
  auto raster = trace_key_frame(scene, occluder, view, options);
  EXPECT_TRUE(raster) << raster.error().text();
  return *raster;
}

struct Areas {
  double seen = 0, lit = 0;
};

Areas areas_of(const KeyFrameRaster &raster) {
  const double pixel = std::pow(2 * raster.half_width_m / raster.side, 2);
  Areas out;
  for (const KeyFrameSample &s : raster.points) {
    out.seen += s.material == no_index ? 0 : pixel;
    out.lit += s.is_lit ? pixel : 0;
  }
  return out;
}

TEST(KeyFrame, SilhouetteOfASphereHasAreaPiRSquared) {
  const KeyFrameRaster raster = trace(lambert_sphere(), view_from_x({1, 0, 0}), small());
  const double step = 2 * raster.half_width_m / raster.side;
  // Counting centres errs by less than half a step along the rim.
  EXPECT_NEAR(areas_of(raster).seen, pi * radius * radius, pi * radius * step);
}

TEST(KeyFrame, LitFractionOfASphereIsHalfOfOnePlusCosinePhase) { // plane geometry
  for (const double phase : {0., 60., 90., 120.}) {
    const Areas areas =
        areas_of(trace(lambert_sphere(), view_from_x(sun_at_phase(phase)), small()));
    const double expected = (1 + std::cos(phase * (pi / 180))) / 2;
    // 1 %: the terminator follows facets of 0.04 R.
    EXPECT_NEAR(areas.lit / areas.seen, expected, 0.01) << phase;
  }
}

TEST(KeyFrame, LambertRadianceFollowsTheCosineToTheSun) {
  Scene scene = lambert_sphere();
  scene.normals = NormalMode::Smooth; // exact normals of the sphere at its vertices
  const Vec3<Body> sun = sun_at_phase(60);
  const KeyFrameRaster raster = trace(scene, view_from_x(sun), small());
  const double step = 2 * raster.half_width_m / raster.side;
  // Ratio of two points of the sphere, away from the rim. 2 %: a sample is up to half a step
  // (0.006 m) off, which moves a cosine by 0.004 of about 0.4.
  const auto at = [&](double y, double z) {
    const auto column = static_cast<std::size_t>((y + raster.half_width_m) / step);
    const auto row = static_cast<std::size_t>((raster.half_width_m - z) / step);
    return static_cast<double>(raster.points[row * raster.side + column].radiance);
  };
  const auto cosine = [&](double y, double z) {
    return dot(Vec3<Body>{std::sqrt(radius * radius - y * y - z * z), y, z} / radius, sun);
  };
  const double expected = cosine(0.9, 0.3) / cosine(-0.2, -0.4);
  EXPECT_NEAR(at(0.9, 0.3) / at(-0.2, -0.4), expected, 0.02 * expected);
}

TEST(KeyFrame, SunOnTheRightLightsTheRightSide) {
  const KeyFrameRaster raster = trace(lambert_sphere(), view_from_x({0, 1, 0}), small());
  const std::size_t row = raster.side / 2;
  EXPECT_TRUE(raster.points[row * raster.side + raster.side * 3 / 4].is_lit);
  EXPECT_FALSE(raster.points[row * raster.side + raster.side / 4].is_lit);
  const KeyFrameRaster above = trace(lambert_sphere(), view_from_x({0, 0, 1}), small());
  EXPECT_TRUE(above.points[(raster.side / 4) * raster.side + raster.side / 2].is_lit);
  EXPECT_FALSE(above.points[(raster.side * 3 / 4) * raster.side + raster.side / 2].is_lit);
}

TEST(KeyFrame, PolarizationOfABareMetalIsFresnelEverywhere) {
  // Aluminium at 550 nm, phase 140: M01/M00, six digits each.
  const double expected = anchor("al_550_140_M01") / anchor("al_550_140_M00");
  const Scene scene = scene_of(make_sphere(radius, 5000), {"paper_al"}, {"paper_al"});
  KeyFrameOptions options = small();
  options.size = 40;
  options.band = 1;
  const KeyFrameRaster raster = trace(scene, view_from_x(sun_at_phase(140)), options);
  int checked = 0;
  for (const KeyFrameSample &s : raster.points)
    if (s.radiance > 0) {
      EXPECT_NEAR(static_cast<double>(s.p), expected, 2e-6);
      ++checked;
    }
  EXPECT_GT(checked, 10);
}

TEST(KeyFrame, EachSideOfASheetShowsItsOwnMaterialAndHidesTheSun) {
  Mesh sheet;
  sheet.positions = {{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}}; // normal +x
  sheet.groups = {"a", "b"};
  for (const auto &corners : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}}) {
    Triangle t;
    t.vertex = corners;
    t.front = 0;
    t.back = 1;
    sheet.triangles.push_back(t);
  }
  // Two faces merged into one: its back shows the front of the other face, as in the light.
  const Scene scene = scene_of(sheet, {"paper_au", "paper_spectralon"}, {"paper_asi", "paper_asi"});
  const auto centre = [&](Vec3<Body> observer, Vec3<Body> sun) {
    const KeyFrameRaster r = trace(scene, {{sun, observer}, {0, 0, 1}}, small());
    const KeyFrameSample s = r.points[(r.side / 2) * r.side + r.side / 2];
    return std::make_pair(r.materials[s.material], s.is_lit);
  };
  using Shown = std::pair<std::string, bool>;
  EXPECT_EQ(centre({1, 0, 0}, {1, 0, 0}), Shown("paper_au", true));
  EXPECT_EQ(centre({-1, 0, 0}, {-1, 0, 0}), Shown("paper_spectralon", true));
  EXPECT_EQ(centre({-1, 0, 0}, {1, 0, 0}), Shown("paper_spectralon", false));
}

TEST(KeyFrame, PixelsDoNotDependOnThreadsAndRepeat) {
  const Scene scene = lambert_sphere();
  KeyFrameOptions options = small();
  const KeyFrameView view = view_from_x(sun_at_phase(70));
  const auto pixels = [&](unsigned threads, KeyFrameShading shading) {
    options.threads = threads;
    const KeyFrameRaster raster = trace(scene, view, options);
    return shade(raster, shading, common_exposure({&raster, 1}));
  };
  for (const auto shading :
       {KeyFrameShading::Intensity, KeyFrameShading::Polarization, KeyFrameShading::Material}) {
    const auto one = pixels(1, shading);
    EXPECT_EQ(one.size(), 3U * 160 * 160);
    EXPECT_EQ(one, pixels(1, shading));
    EXPECT_EQ(one, pixels(2, shading));
  }
}

TEST(KeyFrame, RefusesWhatCannotBeDrawn) {
  const Scene scene = scene_of(make_sphere(1, 200), {"paper_al"}, {"paper_al"});
  const Occluder occluder(scene.mesh);
  const KeyFrameView good = view_from_x({1, 0, 0});
  KeyFrameOptions options;
  options.size = 0;
  EXPECT_EQ(trace_key_frame(scene, occluder, good, options).error().code, ErrorCode::BadInput);
  options = {};
  options.band = 3;
  EXPECT_NE(trace_key_frame(scene, occluder, good, options).error().message.find("has 3 bands"),
            std::string::npos);
  options = {};
  const KeyFrameView bad{good.pose, good.pose.observer};
  EXPECT_FALSE(trace_key_frame(scene, occluder, bad, options));
}

TEST(KeyFrame, ExposureOfNothingLitIsOne) { EXPECT_EQ(common_exposure({}), 1); }

} // namespace
} // namespace umov
