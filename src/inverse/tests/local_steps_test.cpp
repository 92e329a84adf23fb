#include "inverse/local_steps.h"

#include "inverse/particle_steps.h"
#include "inverse/tests/box_light.h"

#include <umov/core/parallel.h>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

constexpr double deg = pi / 180;
const Vec3<Body> z_axis{0, 0, 1};

/// Attitudes of all turns about Z, `apart` of each other.
Chords ring(std::size_t count) {
  Chords out;
  for (std::size_t k = 0; k < count; ++k)
    out.add(turned({}, z_axis * (2 * pi * static_cast<double>(k) / static_cast<double>(count))));
  return out;
}

/// How far Z is from where the ring has it: the distance from the ring.
double tilt_of(Quaternion q) { return std::acos(1 - 2 * (q.x * q.x + q.y * q.y)); }

TEST(LocalSteps, GoAlongARingAndNotBesideIt) {
  const LocalSteps steps(ring(720), 0.01 * deg);
  const auto root = steps.root_at({}, 1);
  // Twelve nearest of a ring of half a degree, the place itself left out: six to each side, whose
  // mean square is (1 + 4 + 9 + 16 + 25 + 36)/6 of a quarter of a square degree.
  EXPECT_NEAR(root[5], std::sqrt(91.0 / 6 / 4) * deg, 1e-3 * deg);
  EXPECT_NEAR(root[0], 0.01 * deg, 1e-3 * deg);
  EXPECT_NEAR(root[2], 0.01 * deg, 1e-3 * deg);
  const auto at_last = LocalSteps::step(root, {0, 0, 1});
  EXPECT_NEAR(at_last.z, root[5], 1e-12);
}

/// The density of a step is that of the normal that it is drawn from: ln of (2 pi)^1.5 less.
TEST(LocalSteps, TellTheDensityOfAStep) {
  const LocalSteps::Root root{2, 0.5, 1, -0.25, 0.75, 0.5};
  const Vec3<Body> z{0.3, -1.2, 0.7};
  EXPECT_NEAR(LocalSteps::log_density(root, LocalSteps::step(root, z)),
              -(0.09 + 1.44 + 0.49) / 2 - std::log(2 * 1 * 0.5), 1e-12);
}

/// Where all attitudes are alike, steps that are tried by the shape of a ring, and taken with the
/// ratio of how often they are tried there and back, leave as many near the ring as there were: the
/// part of all directions of an axis that lie within an angle, (1 - cos)/2.
TEST(LocalSteps, LeaveAllAttitudesAlike) {
  const LocalSteps steps(ring(120), deg);
  std::vector<Turning> places;
  for (const Quaternion &q : attitude_grid(20'000))
    places.push_back({q, {}});
  std::size_t taken = 0;
  for (std::uint32_t step = 0; step < 12; ++step) {
    std::vector<Tried> tried(places.size());
    parallel_for(places.size(), 0, [&](std::size_t k) {
      tried[k] = local_step(steps, 0.5, places[k], k, {7, 100 + step, 0});
    });
    for (std::size_t k = 0; k < places.size(); ++k)
      if (std::log(uniform4(7, 200 + step, k)[0]) < tried[k].back) {
        places[k] = tried[k].to;
        ++taken;
      }
  }
  EXPECT_GT(taken, places.size()); // they moved
  for (const double within : {10 * deg, 30 * deg, 90 * deg}) {
    double near = 0;
    for (const Turning &one : places)
      near += tilt_of(one.attitude) < within ? 1 : 0;
    const double share = (1 - std::cos(within)) / 2, count = static_cast<double>(places.size());
    EXPECT_NEAR(near / count, share, 4 * std::sqrt(share * (1 - share) / count)) << within / deg;
  }
}

} // namespace
} // namespace umov::inverse
