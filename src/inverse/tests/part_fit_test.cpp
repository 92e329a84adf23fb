// Parts of the light that are not quite known: against integrals and searches by brute force, and
// on bodies whose light is written down here.

#include "inverse/tests/box_light.h"

#include <array>
#include <numbers>

namespace umov {
namespace {

/// One band: a lobe whose light goes with a power of the slopes, and the rest.
struct Toy {
  std::vector<double> all, lobe, smooth, rough, q, rest, none;
  explicit Toy(double place = 0) {
    for (int k = 0; k < 30; ++k) {
      const double x = 0.2 * k - 3 - place;
      none.push_back(0);
      lobe.push_back(2 * std::exp(-x * x));
      smooth.push_back(lobe.back() * std::exp(-0.4 * (x * x - 1)));
      rough.push_back(lobe.back() * std::exp(0.4 * (x * x - 1)));
      rest.push_back(1 + 0.1 * x);
      all.push_back(lobe.back() + rest.back());
      q.push_back(0.3 * lobe.back());
    }
  }
  /// With a lobe that is so much off, in standard deviations.
  [[nodiscard]] std::array<std::vector<double>, 2> off(double amount, double slope) const {
    std::array<std::vector<double>, 2> out{all, q};
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double x = 0.2 * static_cast<double>(k) - 3;
      const double times = std::exp(0.1 * amount + slope * 0.4 * (x * x - 1));
      out[0][k] += (times - 1) * lobe[k];
      out[1][k] *= times;
    }
    return out;
  }
  [[nodiscard]] ObservedCurve seen(double amount, double slope) const {
    const auto [i, p] = off(amount, slope);
    ObservedCurve out;
    out.bands = {"a"};
    out.epochs.resize(i.size());
    for (std::size_t k = 0; k < i.size(); ++k) {
      ObservedSample s;
      s.epoch = k;
      s.i = 3 * i[k] * (1 + 0.01 * noise(5, k));
      s.i_sd = 0.03 * i[k];
      s.q = p[k] / i[k] + 0.01 * noise(6, k);
      s.u = 0.01 * noise(7, k);
      s.cov_qq = s.cov_uu = 1e-4;
      out.samples.push_back(s);
    }
    return out;
  }
};

TEST(PartFit, FindsWhatALobeIsOff) {
  const Toy toy;
  const CurveLikelihood likelihood(toy.seen(1.4, -0.7), no_floor());
  const PartLight lobe{toy.lobe, toy.q, toy.none, toy.smooth, toy.rough, 0.1};
  const PartLight parts[] = {lobe};
  const auto found = likelihood.fit_parts({toy.all, toy.q, toy.none, {}, parts});
  ASSERT_EQ(found.off.size(), 2u);
  EXPECT_NEAR(found.off[0], 1.4, 0.3);
  EXPECT_NEAR(found.off[1], -0.7, 0.1);
}

// ln of a Gaussian lobe goes with its place all but linearly; the rest of the light, which moved
// along, is .01 off, a tenth of a standard deviation of the amount.
TEST(PartFit, FindsHowFarALobeIsTurned) {
  constexpr double sd = 0.1, off = 0.13; // of the lobe's place
  const Toy toy, tilted(sd * tilt_step);
  const CurveLikelihood likelihood(Toy(off).seen(0, 0), no_floor());
  PartLight lobe{toy.lobe, toy.q, toy.none, {}, {}, 0.1};
  lobe.tilted[1] = tilted.lobe;
  const PartLight parts[] = {lobe};
  const auto found = likelihood.fit_parts({toy.all, toy.q, toy.none, {}, parts});
  ASSERT_EQ(found.off.size(), 2u); // its amount, and a turn about one axis
  EXPECT_NEAR(found.off[0], 0, 0.4);
  EXPECT_NEAR(found.off[1], off / sd, 0.15);
}

// The lobe and the rest are of one surface: one turn for both, which the rest, .1 of the light a
// unit of place, tells as well.
TEST(PartFit, WhatASurfaceScattersIsTurnedWithItsLobe) {
  constexpr double sd = 0.1, off = 0.13;
  const Toy toy, tilted(sd * tilt_step);
  const CurveLikelihood likelihood(Toy(off).seen(0, 0), no_floor());
  PartLight lobe{toy.lobe, toy.q, toy.none, {}, {}, 0.1}, rest{toy.rest, toy.none, toy.none};
  lobe.tilted[1] = tilted.lobe;
  rest.tilted[1] = tilted.rest;
  lobe.tilted[0] = lobe.tilted[2] = toy.lobe; // nothing changes
  rest.tilted[0] = rest.tilted[2] = toy.rest;
  rest.tilts_with_last = true;
  const PartLight parts[] = {lobe, rest};
  const auto found = likelihood.fit_parts({toy.all, toy.q, toy.none, {}, parts});
  ASSERT_EQ(found.off.size(), 4u); // the lobe's amount, and three turns
  EXPECT_NEAR(found.off[0], 0, 0.3);
  EXPECT_NEAR(found.off[1], 0, 1e-9);
  EXPECT_NEAR(found.off[2], off / sd, 0.1);
  EXPECT_NEAR(found.off[3], 0, 1e-9);
  const Toy moved(off);
  for (std::size_t k = 0; k < found.i.size(); ++k)
    EXPECT_NEAR(found.i[k] / moved.all[k], 1, 0.02); // noise of 1 %, and what bends beside a line
}

// A surface that a small turn puts out, as at the edge of the dark: the other way it does not
// become any light that is asked.
TEST(PartFit, ATurnThatPutsLightOutMakesNoneOfItTheOtherWay) {
  const std::vector<double> all{1, 1, 1, 1}, edge{0.01, 0.01, 0, 0}, none(4, 0);
  ObservedCurve seen;
  seen.bands = {"a"};
  seen.epochs.resize(4);
  for (std::size_t k = 0; k < 4; ++k) {
    ObservedSample s;
    s.epoch = k;
    s.i = k < 2 ? 2 : 1; // a light that the edge would have to give a hundred times over
    s.i_sd = 0.01;
    seen.samples.push_back(s);
  }
  PartLight part{edge, none, none};
  part.tilted[0] = none;
  const PartLight parts[] = {part};
  const auto found = CurveLikelihood(seen, no_floor()).fit_parts({all, none, none, {}, parts});
  ASSERT_EQ(found.off.size(), 1u);
  EXPECT_LT(found.i[0], 1 + 0.01 * std::exp(2 * std::abs(found.off[0])));
}

TEST(PartFit, FindsWhatALobeIsOffBesideNumbersThatAreWrong) {
  const Toy toy;
  ObservedCurve seen = toy.seen(1.4, -0.7);
  for (const std::size_t k : {4u, 13u, 22u})
    seen.samples[k].i *= 1.2; // 20 standard deviations
  CurveErrors errors = no_floor();
  errors.outlier_share = 0.05;
  const CurveLikelihood likelihood(seen, errors);
  const PartLight parts[] = {{toy.lobe, toy.q, toy.none, toy.smooth, toy.rough, 0.1}};
  const auto found = likelihood.fit_parts({toy.all, toy.q, toy.none, {}, parts});
  EXPECT_NEAR(found.off[0], 1.4, 0.3);
  EXPECT_NEAR(found.off[1], -0.7, 0.1);
}

// A number a thousand standard deviations off: both densities of the mixture are 0 in double
// precision, and it counts as wrong (its root is one over the factor).
TEST(PartFit, NumbersFarOutLeaveItFinite) {
  const Toy toy;
  ObservedCurve seen = toy.seen(0, 0);
  seen.samples[7].i *= 1e4;
  CurveErrors errors = no_floor();
  errors.outlier_share = 0.05;
  const CurveLikelihood likelihood(seen, errors);
  const PartLight parts[] = {{toy.lobe, toy.q, toy.none, toy.smooth, toy.rough, 0.1}};
  const auto found = likelihood.fit_parts({toy.all, toy.q, toy.none, {}, parts});
  for (const double off : found.off)
    EXPECT_TRUE(std::isfinite(off));
  EXPECT_TRUE(std::isfinite(found.log_det));
}

/// -2 ln of the integral over both unknowns, by a sum over a grid of models without any.
double integral(const Toy &toy, const CurveLikelihood &likelihood) {
  constexpr double step = 0.05;
  double sum = 0;
  for (double a = -4; a <= 4; a += step)
    for (double s = -3; s <= 3; s += step) {
      const auto [i, q] = toy.off(a, s);
      const double prior = std::exp(-(a * a + s * s) / 2) / (2 * std::numbers::pi);
      sum += prior * std::exp(-likelihood.compare({i, q, toy.none}).minus_2_log / 2);
    }
  return -2 * std::log(sum * step * step);
}

TEST(PartFit, IntegratesOverWhatItDoesNotKnow) {
  const Toy toy;
  const PartLight parts[] = {{toy.lobe, toy.q, toy.none, toy.smooth, toy.rough, 0.1}};
  for (const auto &[amount, slope] : {std::pair(0.0, 0.0), {1.0, 0.5}, {-1.0, 1.0}}) {
    const CurveLikelihood likelihood(toy.seen(amount, slope), no_floor());
    EXPECT_NEAR(likelihood.compare({toy.all, toy.q, toy.none, {}, parts}).minus_2_log,
                integral(toy, likelihood), 0.1) // Laplace's rule is good to first order
        << amount << " " << slope;
  }
}

/// What is asked of derivatives: the curve that they are taken on, and its errors.
struct Derivative {
  ObservedCurve curve;
  CurveErrors errors;
  std::string name;
};

/// A lobe that is off, beside where it is asked for.
std::vector<Derivative> derivatives() {
  std::vector<Derivative> out;
  const ObservedCurve seen = Toy(0.01).seen(1.4, -0.7);
  out.push_back({seen, no_floor(), "as it is"});
  ObservedCurve counted = seen;
  for (const ObservedSample &s : seen.samples)
    for (const double side : {1.0, -1.0}) {
      ObservedCount one;
      one.epoch = s.epoch;
      one.by_i = 5000;
      one.by_q = side * one.by_i;
      one.sky = 50;
      one.fixed_variance = 9;
      one.net = one.by_i * s.i / 3 * (1 + side * s.q);
      counted.counts.push_back(one);
    }
  out.push_back({counted, no_floor(), "counts"});
  return out;
}

TEST(PartFit, DerivativesOfNeighboursAreThoseOfWholeFits) {
  constexpr double h = 2e-3; // of the lobe's place, where it is .7 wide
  const auto at = [](const CurveLikelihood &likelihood, double place,
                     std::span<const double> near = {}) {
    const Toy toy(place);
    const PartLight parts[] = {{toy.lobe, toy.q, toy.none, toy.smooth, toy.rough, 0.1}};
    return likelihood.compare({toy.all, toy.q, toy.none, {}, parts}, near);
  };
  for (const Derivative &one : derivatives()) {
    const CurveLikelihood likelihood(one.curve, one.errors);
    const Comparison here = at(likelihood, 0);
    ASSERT_EQ(here.off.size(), 2u) << one.name;
    const Comparison near = at(likelihood, h, here.off);
    const Comparison before = at(likelihood, -10 * h), after = at(likelihood, 10 * h);
    double off = 0, all = 0;
    for (std::size_t k = 0; k < here.residuals.size(); ++k) {
      const double quick = (near.residuals[k] - here.residuals[k]) / h;
      const double full = (after.residuals[k] - before.residuals[k]) / (20 * h);
      off += (quick - full) * (quick - full);
      all += full * full;
    }
    // Second order: half of h over the scale on which derivatives change, .2 and more.
    EXPECT_LT(std::sqrt(off / all), 0.01) << one.name;
  }
}

TEST(PartFit, NumbersThatMayBeWrongAreFittedWhole) {
  CurveErrors errors = no_floor();
  errors.outlier_share = 0.05;
  const Toy toy;
  const CurveLikelihood likelihood(Toy(0.01).seen(1.4, -0.7), errors);
  const PartLight parts[] = {{toy.lobe, toy.q, toy.none, toy.smooth, toy.rough, 0.1}};
  const ModelLight light{toy.all, toy.q, toy.none, {}, parts};
  const std::vector<double> near{1, -0.5};
  EXPECT_EQ(likelihood.compare(light, near).residuals, likelihood.compare(light).residuals);
}

/// A box of six faces, each of a colour of its own, and one lobe: [all, lobe, smoother, rougher,
/// faces].
class PartedBox {
public:
  std::array<double, 6> colour_off{}; ///< ln
  double lobe_off = 0, slope_off = 0;
  Vec3<Body> tilt_rad{0, 0, 0}; ///< how the lobes' surfaces are turned in the body
  static std::vector<PartKind> kinds(double tilt_sd_rad = 0) {
    std::vector<PartKind> out{{"lobe", 0.1, 0.2, tilt_sd_rad}};
    for (int f = 0; f < 6; ++f)
      out.push_back({"face", 0.1, 0});
    return out;
  }
  /// `blocks`: all of the light alone, or its parts behind it.
  [[nodiscard]] PoseLighting lighting(bool has_parts) const {
    return [*this, has_parts](std::span<const Pose> poses, StokesTable &out) {
      const std::size_t blocks = has_parts ? 10 : 1;
      out.resize(poses.size(), 2 * blocks);
      for (std::size_t k = 0; k < poses.size(); ++k)
        for (std::size_t b = 0; b < 2; ++b) {
          std::array<double, 10> light{};
          put(poses[k], b, light);
          const double lobe = light[1];
          for (std::size_t block = 0; block < blocks; ++block)
            out.put(k, 2 * block + b, {{light[block], block < 2 ? 0.2 * lobe : 0, 0, 0}, {}});
        }
      return true;
    };
  }

private:
  void put(const Pose &p, std::size_t b, std::array<double, 10> &light) const {
    const Vec3<Body> normals[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                  {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    const double colour[6][2] = {{.2, .9}, {.8, .3}, {.5, .5}, {.9, .8}, {.3, .1}, {.6, .9}};
    const Vec3<Body> half = normalized(p.sun + p.observer);
    for (std::size_t f = 0; f < 6; ++f) {
      const double s = std::max(0.0, dot(normals[f], p.sun));
      const double o = std::max(0.0, dot(normals[f], p.observer));
      light[4 + f] = colour[f][b] * std::exp(colour_off[f]) * s * o;
      light[0] += light[4 + f];
      for (std::size_t level = 0; level < 3 && s > 0 && o > 0; ++level) {
        const double steps[] = {0, -0.2, 0.2}; // of ln of the slopes
        const double m = 20 * std::exp(-2 * (slope_off + steps[level]));
        const double cosine = dot(normalized(normals[f] + cross(tilt_rad, normals[f])), half);
        light[1 + level] += (m + 2) / 22 * std::exp(lobe_off) * std::pow(std::max(0.0, cosine), m);
      }
    }
    light[0] += light[1];
  }
};

/// Sets that hold the truth, of a search that takes parts for unknown and of one that does not.
struct Held {
  std::size_t in = 0, in_without = 0;
};

/// Whether those of body number `trial`, which is another one than the model, do.
void ask_sets(const PartedBox &truth, std::uint64_t trial, const std::vector<PartKind> &kinds,
              Held &held) {
  const PartedBox model;
  SearchOptions options = small();
  options.errors.floor = 0.005;
  const Quaternion at = turned(turned({}, {0.9 * static_cast<double>(trial), 0, 0}),
                               {0, 0.5 * static_cast<double>(trial), 0.3});
  ObservedCurve curve = pass(24);
  observe(curve, truth.lighting(false), {at, {}}, 100, trial);
  const CurveModel whole(curve, model.lighting(false), {0, 1});
  const CurveModel parted(curve, model.lighting(true), {0, 1}, kinds);
  const auto answer = search_pose({parted, parted, whole}, options);
  const auto without = search_pose(whole, options);
  ASSERT_TRUE(answer && without);
  held.in += is_in(answer->set95, at) ? 1 : 0;
  held.in_without += is_in(without->set95, at) ? 1 : 0;
}

TEST(PartFit, ASetHoldsTheTruthWhereTheMaterialsAreOthers) {
  Held held;
  constexpr std::uint64_t trials = 12;
  for (std::uint64_t t = 0; t < trials; ++t) {
    PartedBox truth;
    for (std::size_t f = 0; f < 6; ++f)
      truth.colour_off[f] = 0.1 * noise(100 + t, f);
    truth.lobe_off = 0.1 * noise(100 + t, 6);
    truth.slope_off = 0.2 * noise(100 + t, 7);
    ASSERT_NO_FATAL_FAILURE(ask_sets(truth, t, PartedBox::kinds(), held));
  }
  EXPECT_GE(held.in, 10u); // of 95 % one in a hundred times less
  EXPECT_LE(held.in_without, 6u);
}

TEST(PartFit, ASetHoldsTheTruthWhereSurfacesAreTurned) {
  constexpr double sd = 0.06; // rad; lobes are .2 wide
  Held held;
  constexpr std::uint64_t trials = 6;
  for (std::uint64_t t = 0; t < trials; ++t) {
    PartedBox truth;
    truth.tilt_rad = {sd * noise(300 + t, 0), sd * noise(300 + t, 1), sd * noise(300 + t, 2)};
    ASSERT_NO_FATAL_FAILURE(ask_sets(truth, t, PartedBox::kinds(sd), held));
  }
  EXPECT_GE(held.in, 5u); // of 95 % one in thirty times less
  EXPECT_LE(held.in_without, 3u);
}

// Directions of a body that is turned by quaternions, against what the model makes of turned parts.
TEST(CurveModel, TurnedSurfacesShowTheLightOfATurnedBody) {
  constexpr double sd = 0.03;
  const auto light_of = [](const Pose &p) {
    return std::exp(p.sun.x + 2 * p.sun.y - p.observer.z + p.observer.x * p.sun.z);
  };
  const PoseLighting light = [&](std::span<const Pose> poses, StokesTable &out) {
    out.resize(poses.size(), 4); // two bands of all, two of a part
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t b = 0; b < 4; ++b)
        out.put(k, b, {{(b < 2 ? 3 : 1) * light_of(poses[k]), 0, 0, 0}, {}});
    return true;
  };
  const ObservedCurve curve = pass(7);
  const CurveModel model(curve, light, {0, 1}, {{"part", 0.1, 0, sd}});
  const Turning at{turned(turned({}, {0.4, 0, 0}), {0, -1.1, 0.3}), {0.001, 0.002, -0.003}};
  std::size_t compared = 0;
  const Turning some[] = {at};
  ASSERT_TRUE(model.for_each(some, {}, 1, [&](std::size_t, const ModelLight &found) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t e = 0; e < curve.epochs.size(); ++e) {
        const double turn = sd * tilt_step;
        const Vec3<Body> by{axis == 0 ? turn : 0, axis == 1 ? turn : 0, axis == 2 ? turn : 0};
        const Quaternion then = turned(attitude_at(at, curve.epochs[e].seconds), by);
        const Pose expected = pose_at({then, {}}, curve.epochs[e]);
        ASSERT_EQ(found.parts.size(), 1u);
        EXPECT_NEAR(found.parts[0].tilted[axis][2 * e], light_of(expected), 1e-12);
        ++compared;
      }
  }));
  EXPECT_EQ(compared, 21u);
}

TEST(PartFit, TheFloorIsWhatTheModelMisses) {
  const PoseLighting light = PartedBox().lighting(false);
  const Turning truth{turned({}, {0.4, -0.9, 0.3}), {}};
  ObservedCurve curve = pass(40);
  observe(curve, light, truth, 100, 1);
  SearchOptions options = small();
  options.errors.floor = 0.005;
  options.errors.has_polarization = false; // I alone is made wrong
  options.largest_floor = 0.3;
  const CurveModel model(curve, light, {0, 1});
  const auto right = search_pose(model, options);
  ASSERT_TRUE(right) << right.error().text();
  EXPECT_LT(right->errors.floor, 0.01);
  constexpr double off = 0.1;
  for (std::size_t k = 0; k < curve.samples.size(); ++k)
    curve.samples[k].i *= 1 + off * noise(9, k);
  const auto wrong = search_pose(model, options);
  ASSERT_TRUE(wrong) << wrong.error().text();
  EXPECT_NEAR(wrong->model_error, off, 0.025); // 80 numbers tell it to 8 %
  EXPECT_GE(wrong->errors.floor, wrong->model_error);
  EXPECT_NEAR(wrong->misfit / static_cast<double>(wrong->measurements), 1, 0.5);
}

} // namespace
} // namespace umov
