// Torque-free motion against numerical integration of Euler's equations, the symmetric top's own
// closed form, and what it must keep.

#include <umov/attitude/tumble.h>

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using State = std::array<long double, 7>; // angular velocity, quaternion of the turn

/// Euler's equations and the quaternion's, by Runge-Kutta-Fehlberg 7(8) to 1e-17 in long double:
/// the oracle.
State integrate(const Inertia &i, Vec3<Body> rate, double seconds) {
  namespace ode = boost::numeric::odeint;
  const auto slope = [&](const State &s, State &out, long double) {
    out[0] = (i.yy - i.zz) / i.xx * s[1] * s[2];
    out[1] = (i.zz - i.xx) / i.yy * s[2] * s[0];
    out[2] = (i.xx - i.yy) / i.zz * s[0] * s[1];
    out[3] = -0.5L * (s[4] * s[0] + s[5] * s[1] + s[6] * s[2]);
    out[4] = 0.5L * (s[3] * s[0] + s[5] * s[2] - s[6] * s[1]);
    out[5] = 0.5L * (s[3] * s[1] + s[6] * s[0] - s[4] * s[2]);
    out[6] = 0.5L * (s[3] * s[2] + s[4] * s[1] - s[5] * s[0]);
  };
  State s{rate.x, rate.y, rate.z, 1, 0, 0, 0};
  using Stepper = ode::runge_kutta_fehlberg78<State, long double>;
  ode::integrate_adaptive(ode::make_controlled(1e-17L, 1e-17L, Stepper()), slope, s, 0.0L,
                          static_cast<long double>(seconds), 0.01L);
  return s;
}

Rotation<Body, Body> turn_of(const State &s) {
  const long double n = std::sqrt(s[3] * s[3] + s[4] * s[4] + s[5] * s[5] + s[6] * s[6]);
  return rotation_from<Body, Body>({static_cast<double>(s[3] / n), static_cast<double>(s[4] / n),
                                    static_cast<double>(s[5] / n), static_cast<double>(s[6] / n)});
}

double angle_between_turns(const Rotation<Body, Body> &a, const Rotation<Body, Body> &b) {
  double worst = 0;
  for (int k = 0; k < 3; ++k)
    worst = std::max(worst, norm(a.row(k) - b.row(k)));
  return worst;
}

TEST(Tumble, AgreesWithIntegrationOverAHundredTurns) {
  // About the axis of the largest moment, of the smallest, near the middle one, backwards.
  const struct {
    Inertia inertia;
    Vec3<Body> rate;
  } cases[] = {
      {{1, 2, 2.5, 0, 0, 0}, {0.1, 0.2, 1}},     {{1, 2, 2.5, 0, 0, 0}, {1, 0.3, -0.1}},
      {{1, 2, 2.5, 0, 0, 0}, {-0.4, 0.9, -0.4}}, {{2.5, 1, 2, 0, 0, 0}, {-1, 0.02, 0.03}},
      {{2, 2.5, 1, 0, 0, 0}, {0.3, 0.3, 0.3}},   {{1, 1.001, 1.9, 0, 0, 0}, {0.5, 0.5, -0.5}}};
  for (const auto &one : cases) {
    const auto motion = TorqueFreeMotion::make(one.inertia, one.rate);
    ASSERT_TRUE(motion);
    const double seconds = 100 * 2 * pi / norm(one.rate);
    for (const double t : {0.0, 0.37 * seconds, seconds}) {
      const State truth = integrate(one.inertia, one.rate, t);
      const Vec3<Body> rate = motion->rate_at(t);
      EXPECT_NEAR(rate.x, static_cast<double>(truth[0]), 1e-10);
      EXPECT_NEAR(rate.y, static_cast<double>(truth[1]), 1e-10);
      EXPECT_NEAR(rate.z, static_cast<double>(truth[2]), 1e-10);
      EXPECT_LT(angle_between_turns(motion->turned(t), turn_of(truth)), 1e-9);
    }
  }
}

TEST(Tumble, SymmetricTopInClosedForm) {
  // Precession L/I1 about the angular momentum, spin (I1 - I3)/I1 w3 about the axis (Landau &
  // Lifshitz 1976, section 33).
  for (const double i3 : {0.6, 1.7}) {
    const Inertia inertia{1, 1, i3, 0, 0, 0};
    const Vec3<Body> rate{0.3, -0.4, 0.8};
    const auto motion = TorqueFreeMotion::make(inertia, rate);
    const Vec3<Body> momentum{rate.x, rate.y, i3 * rate.z};
    const double wanted = norm(momentum), own = (1 - i3) * rate.z;
    EXPECT_NEAR(motion->precession_rate_rad_s(), wanted, 1e-12);
    for (const double t : {0.0, 1.0, 33.0, 700.0}) {
      const auto about = [&](Vec3<Body> axis, double angle) {
        const Vec3<Body> n = normalized(axis) * std::sin(angle / 2);
        return rotation_from<Body, Body>({std::cos(angle / 2), n.x, n.y, n.z});
      };
      // Turned about the momentum as it stood at the start, then about its own axis.
      const auto closed = about({0, 0, 1}, own * t) * about(momentum, wanted * t);
      EXPECT_LT(angle_between_turns(motion->turned(t), closed), 1e-11) << i3 << " " << t;
    }
  }
}

TEST(Tumble, KeepsEnergyAndMomentumOverTenThousandTurns) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> even(-1, 1);
  for (int k = 0; k < 200; ++k) {
    const double a = 1 + 0.9 * even(random), b = 1 + 0.9 * even(random);
    const double c = std::abs(a - b) + (a + b - std::abs(a - b)) * (0.5 + 0.49 * even(random));
    const Inertia i{a, b, c, 0, 0, 0};
    const Vec3<Body> rate{even(random), even(random), even(random)};
    const auto motion = TorqueFreeMotion::make(i, rate);
    ASSERT_TRUE(motion);
    const auto energy = [&](Vec3<Body> w) {
      return i.xx * w.x * w.x + i.yy * w.y * w.y + i.zz * w.z * w.z;
    };
    const auto momentum = [&](Vec3<Body> w) {
      return Vec3<Body>{i.xx * w.x, i.yy * w.y, i.zz * w.z};
    };
    const Vec3<Body> first = momentum(rate);
    const double end = 1e4 * 2 * pi / norm(rate);
    for (int j = 0; j <= 20; ++j) {
      const double t = end * j / 20;
      const Vec3<Body> w = motion->rate_at(t);
      EXPECT_NEAR(energy(w) / energy(rate), 1, 1e-9);
      // The momentum stands still among the stars: size and direction.
      const Vec3<Body> held = motion->turned(t).inverse() * momentum(w);
      EXPECT_LT(norm(held - first) / norm(first), 1e-9) << k << " " << j;
    }
  }
}

TEST(Tumble, TurnsAtTheRateItSays) {
  // The attitude's derivative is the angular velocity: central differences over 2e-4 s, good
  // to 1e-8; the turns are some 1,000 rad, good to 1e-13.
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> even(-1, 1);
  for (int k = 0; k < 300; ++k) {
    const Inertia i{1,
                    1.3 + 0.2 * even(random),
                    1.8,
                    0.1 * even(random),
                    0.1 * even(random),
                    0.1 * even(random)};
    const auto motion = TorqueFreeMotion::make(i, {even(random), even(random), even(random)});
    const double t = 1000 * even(random), h = 1e-4;
    const auto step = motion->turned(t + h) * motion->turned(t - h).inverse();
    // v_after = v - w x v dt for components in the body; the odd part of the small turn.
    const Vec3<Body> w{(step.row(1).z - step.row(2).y) / (4 * h),
                       (step.row(2).x - step.row(0).z) / (4 * h),
                       (step.row(0).y - step.row(1).x) / (4 * h)};
    EXPECT_LT(norm(w - motion->rate_at(t)), 3e-8) << k;
  }
}

TEST(Tumble, EdgesAreSteadySpins) {
  for (const Inertia &i : {Inertia{1, 1, 1, 0, 0, 0}, Inertia{1, 2, 2.5, 0, 0, 0},
                           Inertia{2, 2, 1, 0, 0, 0}, Inertia{1, 1, 2, 0, 0, 0}})
    for (const Vec3<Body> &rate :
         {Vec3<Body>{0, 0, 0.7}, Vec3<Body>{0, 0.7, 0}, Vec3<Body>{-0.7, 0, 0}}) {
      const auto motion = TorqueFreeMotion::make(i, rate);
      for (const double t : {0.0, 1.0, 1e4}) {
        EXPECT_LT(norm(motion->rate_at(t) - rate), 1e-12);
        const double turns = 0.7 * t / (2 * pi), angle = 2 * pi * (turns - std::round(turns));
        const Vec3<Body> n = normalized(rate) * std::sin(angle / 2);
        const auto spin = rotation_from<Body, Body>({std::cos(angle / 2), n.x, n.y, n.z});
        EXPECT_LT(angle_between_turns(motion->turned(t), spin), 1e-10) << t;
      }
    }
  const auto still = TorqueFreeMotion::make({1, 2, 2.5, 0, 0, 0}, {});
  EXPECT_LT(angle_between_turns(still->turned(100), {}), 1e-15);
  EXPECT_FALSE(TorqueFreeMotion::make({1, 1, 5, 0, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(TorqueFreeMotion::make({1, 1, 1, 0, 0, 0}, {0, NAN, 1}));
}

} // namespace
} // namespace umov
