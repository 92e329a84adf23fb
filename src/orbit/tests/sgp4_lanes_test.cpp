// SGP4 over lanes against one state at a time, which sgp4_test.cpp holds against the reference; and
// the angles that both are made of against the C library.

#include "fixed_columns.h"
#include "kernel/angles.inl.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/core/quantity.h>
#include <umov/orbit/sgp4.h>

namespace umov {
namespace {

const std::string test_data = UMOV_SOURCE_DIR "/tests/data/";

bool is_same(const TemeState &a, const TemeState &b) {
  return a.position_km == b.position_km && a.velocity_km_s == b.velocity_km_s;
}

/// Ten days to both sides, in an order that mixes the half-day steps of resonant orbits.
std::vector<double> mixed_minutes() {
  std::vector<double> out;
  for (int k = 0; k < 101; ++k)
    out.push_back(14400 * std::sin(0.7 * k) + (k % 7 == 0 ? 0.125 : 0));
  out.push_back(0);
  out.push_back(720);
  out.push_back(-720);
  return out;
}

TEST(Sgp4Lanes, GiveTheBitsOfOneStateAtATime) {
  const auto sets = test::load_by_columns(test_data + "tle/mixed_979_2018-01-20.tle");
  ASSERT_EQ(sets.size(), 979u);
  const auto minutes = mixed_minutes();
  std::vector<TemeState> states(minutes.size());
  std::vector<Sgp4Code> codes(minutes.size());
  int deep = 0;
  for (const ElementSet &set : sets) {
    const Sgp4 model(set);
    deep += model.is_deep_space() ? 1 : 0;
    model.propagate(minutes, states, codes);
    for (std::size_t k = 0; k < minutes.size(); ++k) {
      TemeState one;
      ASSERT_EQ(codes[k], model.propagate(minutes[k], one)) << set.norad_cat_id;
      ASSERT_TRUE(is_same(one, states[k])) << set.norad_cat_id << " at " << minutes[k];
    }
  }
  EXPECT_GT(deep, 80);
}

TEST(Sgp4Lanes, ManyObjectsGiveTheBitsOfOne) {
  const auto sets = test::load_by_columns(test_data + "tle/mixed_979_2018-01-20.tle");
  std::vector<Sgp4> objects;
  std::vector<double> minutes;
  for (const ElementSet &set : sets) {
    objects.emplace_back(set);
    minutes.push_back(3000 * std::sin(static_cast<double>(objects.size())));
  }
  std::vector<TemeState> states(objects.size());
  std::vector<Sgp4Code> codes(objects.size());
  propagate_objects(objects, minutes, states, codes);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    TemeState one;
    ASSERT_EQ(codes[k], objects[k].propagate(minutes[k], one)) << sets[k].norad_cat_id;
    ASSERT_TRUE(is_same(one, states[k])) << sets[k].norad_cat_id;
  }
}

TEST(Sgp4Lanes, FailuresStayInTheirLane) {
  // 28872 decays within the hour (SGP4-VER.TLE); its neighbours in time do not notice.
  for (const ElementSet &set : test::load_by_columns(test_data + "sgp4/SGP4-VER.TLE")) {
    const Sgp4 model(set);
    const std::vector<double> minutes{0, 1e5, 5, std::nan(""), 10, 1e9, 15, -20, 40, 50, 60};
    std::vector<TemeState> states(minutes.size());
    std::vector<Sgp4Code> codes(minutes.size());
    model.propagate(minutes, states, codes);
    for (std::size_t k = 0; k < minutes.size(); ++k) {
      TemeState one;
      EXPECT_EQ(codes[k], model.propagate(minutes[k], one)) << set.norad_cat_id;
      EXPECT_TRUE(is_same(one, states[k])) << set.norad_cat_id << " at " << minutes[k];
      EXPECT_EQ(codes[k] != Sgp4Code::Ok, norm(states[k].position_km) == 0);
    }
  }
}

TEST(KernelAngles, SineAndCosineOfTheCLibrary) {
  double worst = 0;
  for (int k = -500000; k <= 500000; ++k) {
    const double x = 1.7e-3 * k + 1e-7 * k * (k % 3);
    const auto wave = kernel::sine_cosine(x);
    worst =
        std::max({worst, std::abs(wave.sine - std::sin(x)), std::abs(wave.cosine - std::cos(x))});
  }
  EXPECT_LE(worst, 2.3e-16); // one unit in the last place of 1
}

TEST(KernelAngles, ArcTangentOfTheCLibrary) {
  double worst = 0;
  for (int k = 0; k <= 200000; ++k) {
    const double angle = -3.1415926 + 3.1415926e-5 * k, size = std::exp2(k % 80 - 40);
    const double y = size * std::sin(angle), x = size * std::cos(angle);
    worst = std::max(worst, std::abs(kernel::arc_tangent(y, x) - std::atan2(y, x)));
  }
  EXPECT_LE(worst, 4.5e-16); // one unit in the last place of pi
  EXPECT_EQ(kernel::arc_tangent(0.0, 0.0), 0);
}

TEST(KernelAngles, WholeTurnsTakenOff) {
  for (int k = -3000; k <= 3000; ++k) {
    const double x = 0.997 * k;
    EXPECT_NEAR(kernel::within_turn(x), std::remainder(x, 2 * pi), 2e-12) << x;
    EXPECT_NEAR(kernel::rest_of_turn(x), std::fmod(x, 2 * pi), 2e-12) << x;
  }
}

} // namespace
} // namespace umov
