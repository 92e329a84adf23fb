// Glints of turning mirrors against the exact condition.

#include <umov/light/glints.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>
#include <umov/core/rotation.h>

namespace umov {
namespace {

Vec3<Body> random_unit(std::mt19937_64 &random) {
  std::normal_distribution<double> normal;
  return normalized(Vec3<Body>{normal(random), normal(random), normal(random)});
}

/// A flat that spins about an axis fixed among the stars, seen from the body: the half vector goes
/// around the axis the other way.
struct Spinner {
  Vec3<Body> axis, sun, observer;
  double rate;

  [[nodiscard]] Vec3<Body> turned(Vec3<Body> v, double t) const {
    const double a = -rate * t, c = std::cos(a), s = std::sin(a);
    return v * c + cross(axis, v) * s + axis * ((1 - c) * dot(axis, v));
  }
  [[nodiscard]] Result<GlintView> view(double t) const {
    return GlintView{turned(sun, t), turned(observer, t)};
  }
};

TEST(Glints, AThousandSpinningMirrorsGlintWhenTheyMust) {
  // The angle between normal and half vector is least when both have the same azimuth about the
  // axis, once a turn, and is then the difference of their angles from the axis.
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> even(0, 1);
  const double half_width = 0.02, half_disk = 0.00233; // 1.1 deg of lobe, half the Sun's radius
  int seen = 0;
  for (int k = 0; k < 1000; ++k) {
    Spinner spinner{random_unit(random), random_unit(random), random_unit(random),
                    std::exp(std::log(1e-3) + even(random) * std::log(6e3))}; // 1e-3 .. 6 rad/s
    GlintFlat flat{random_unit(random), half_width, 1, 0};
    if (k % 2 == 0) { // every second one does glint
      const Vec3<Body> half = normalized(spinner.sun + spinner.observer);
      flat.normal = spinner.turned(half, 100 * even(random));
      if (k % 4 == 0) // at a distance
        flat.normal = normalized(flat.normal + spinner.axis * 0.015);
    }
    const double span = 30 + 100 * even(random);
    const auto found = find_glints(
        {flat}, [&](double t) { return spinner.view(t); }, 0, span, spinner.rate, half_disk);
    ASSERT_TRUE(found);
    const Vec3<Body> half = normalized(spinner.sun + spinner.observer);
    const double from_axis =
        angle_between(spinner.axis, half) - angle_between(spinner.axis, flat.normal);
    const Vec3<Body> x = normalized(half - spinner.axis * dot(spinner.axis, half)),
                     y = cross(spinner.axis, x);
    // The half vector's azimuth is -rate t; the normal's is fixed.
    const double azimuth = std::atan2(dot(flat.normal, y), dot(flat.normal, x));
    const double period = 2 * pi / spinner.rate;
    double first = std::fmod(-azimuth / spinner.rate, period);
    if (first < 0)
      first += period;
    std::vector<double> expected;
    if (std::abs(from_axis) < half_width + half_disk)
      for (double t = first; t <= span; t += period)
        expected.push_back(t);
    // A stretch that the span cuts has its nearest point at the span's end.
    std::vector<double> inner;
    for (const Glint &glint : *found)
      if (glint.seconds > 1e-3 && glint.seconds < span - 1e-3)
        inner.push_back(glint.seconds);
    std::erase_if(expected, [&](double t) { return t < 1e-3 || t > span - 1e-3; });
    ASSERT_EQ(inner.size(), expected.size()) << k << " rate " << spinner.rate;
    for (std::size_t j = 0; j < inner.size(); ++j) {
      EXPECT_NEAR(inner[j], expected[j], 1e-3) << k;
      ++seen;
    }
    for (const Glint &glint : *found)
      EXPECT_LT(glint.miss_rad, half_width + half_disk);
  }
  EXPECT_GT(seen, 2000);
}

TEST(Glints, WidthIsTheTimeWithinTheLobe) {
  // The normal crosses the half vector at right angles to the axis: width = 2 limit / rate.
  const Spinner spinner{{0, 0, 1}, {1, 0, 0}, {1, 0, 0}, 0.1};
  const GlintFlat flat{normalized(Vec3<Body>{std::cos(1.0), -std::sin(1.0), 0}), 0.02, 1, 0};
  const auto found = find_glints(
      {flat}, [&](double t) { return spinner.view(t); }, 0, 60, 0.1, 0.002);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_NEAR((*found)[0].seconds, 10, 1e-4);
  EXPECT_NEAR((*found)[0].width_s, 0.44, 1e-4);
  EXPECT_LT((*found)[0].miss_rad, 1e-6);
}

TEST(Glints, StopsWhereThePathDoes) {
  const auto found = find_glints(
      {GlintFlat{{0, 0, 1}, 0.02, 1, 0}},
      [](double t) -> Result<GlintView> {
        if (t > 5)
          return fail(ErrorCode::Physics, "no more");
        return GlintView{{1, 0, 0}, {0, 1, 0}};
      },
      0, 10, 1, 0);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "no more");
}

} // namespace
} // namespace umov
