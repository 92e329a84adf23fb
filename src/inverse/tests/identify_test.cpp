#include "inverse/tests/box_light.h"

#include <array>
#include <umov/inverse/identify.h>

namespace umov {
namespace {

constexpr std::size_t cells = 28; // 6 deg

/// Boxes of other colours and lobes, written down here; number 0 to 9.
PoseLighting object(std::uint64_t number) {
  std::vector<std::array<double, 4>> face;
  for (std::size_t f = 0; f < 6; ++f)
    face.push_back(uniform4(77, static_cast<std::uint32_t>(number), f));
  return [face](std::span<const Pose> poses, StokesTable &out) {
    out.resize(poses.size(), 2);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Pose &p = poses[k];
      const Vec3<Body> half = normalized(p.sun + p.observer);
      for (std::size_t b = 0; b < 2; ++b) {
        BandResult light;
        for (std::size_t f = 0; f < 6; ++f) {
          const std::array<double, 4> &u = face[f];
          const double sign = f % 2 == 0 ? 1 : -1;
          const Vec3<Body> normal = f < 2   ? Vec3<Body>{sign, 0, 0}
                                    : f < 4 ? Vec3<Body>{0, sign, 0}
                                            : Vec3<Body>{0, 0, sign};
          const double s = std::max(0.0, dot(normal, p.sun));
          const double o = std::max(0.0, dot(normal, p.observer));
          const double lobe =
              s > 0 && o > 0 ? u[2] * std::pow(std::max(0.0, dot(normal, half)), 5 + 20 * u[3]) : 0;
          light.stokes.i += (0.3 + u[0]) * (b == 0 ? 1 : 0.3 + u[1]) * s * o + lobe;
          light.stokes.q += 0.25 * u[1] * lobe;
        }
        out.put(k, b, light);
      }
    }
    return true;
  };
}

struct Kept {
  PackedLight packed;
  Signature signature;
};

Kept kept(std::uint64_t number) {
  Kept out;
  StokesTable light;
  EXPECT_TRUE(object(number)(signature_poses(cells, 0, signature_pairs(cells), 0), light));
  out.packed = pack_light(light);
  out.signature = {"box " + std::to_string(number),
                   cells,
                   2,
                   out.packed.ln_least,
                   out.packed.ln_step,
                   0,
                   out.packed.code};
  out.signature.error = interpolation_error(out.signature, object(number), 1);
  return out;
}

/// The objects `count`, ready to be searched.
struct Library {
  explicit Library(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      all.push_back(kept(k));
    for (const Kept &k : all) {
      views.push_back(k.signature);
      views.back().code = k.packed.code;
    }
  }
  std::vector<Kept> all;
  std::vector<Signature> views;
};

IdentityAnswer asked(const Library &library, std::uint64_t number, std::uint64_t trial,
                     std::size_t epochs = 24) {
  ObservedCurve curve = pass(epochs);
  const auto grid = attitude_grid(10'007);
  const auto at = static_cast<std::size_t>(uniform4(5, 6, trial)[0] * 10'007);
  observe(curve, object(number), {grid[at], {}}, 60, trial);
  IdentifyOptions options;
  options.search = small();
  options.search.errors = CurveErrors{};
  options.search.samples = 300;
  options.finalists = 4;
  const auto answer = identify(curve, {0, 1}, library.views, options);
  EXPECT_TRUE(answer) << answer.error().text();
  double sum = answer->none;
  for (const IdentityCandidate &c : answer->candidates)
    sum += c.probability;
  EXPECT_NEAR(sum, 1, 1e-9);
  return *answer;
}

TEST(Identify, AnObjectOfTheLibraryIsNamedWhateverItsAttitude) {
  const Library library(8);
  int right = 0, in_front = 0, wrong_and_sure = 0;
  constexpr std::uint64_t trials = 8;
  for (std::uint64_t t = 0; t < trials; ++t) {
    const IdentityAnswer answer = asked(library, t % 8, t);
    const IdentityCandidate &best = answer.candidates.front();
    right += best.which == t % 8 && best.probability > 0.5 ? 1 : 0;
    in_front += best.which == t % 8 ? 1 : 0;
    wrong_and_sure += best.which != t % 8 && best.probability > 0.95 ? 1 : 0;
  }
  EXPECT_GE(in_front, 7);
  EXPECT_GE(right, 6);
  EXPECT_EQ(wrong_and_sure, 0);
}

TEST(Identify, AnObjectThatIsNotInTheLibraryIsNone) {
  const Library library(5);
  int none = 0;
  constexpr std::uint64_t trials = 6;
  for (std::uint64_t t = 0; t < trials; ++t)
    none += asked(library, 5 + t, 100 + t).none > 0.5 ? 1 : 0;
  EXPECT_GE(none, 4);
}

TEST(Identify, OneEpochNamesNobody) {
  const Library library(8);
  for (std::uint64_t t = 0; t < 3; ++t) {
    const IdentityAnswer answer = asked(library, t, 200 + t, 1);
    EXPECT_LT(answer.candidates.front().probability, 0.95) << t;
  }
}

TEST(Identify, NoBrightnessIsSaid) {
  const Library library(1);
  ObservedCurve curve = pass(3);
  ObservedSample dark;
  dark.i = 0;
  curve.samples = {dark};
  const auto answer = identify(curve, {0, 1}, library.views, {});
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::BadInput);
}

} // namespace
} // namespace umov
