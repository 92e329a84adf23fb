#include "inverse/attitude_set.h"

#include "inverse/posterior.h"
#include "inverse/tests/box_light.h"

namespace umov::inverse {
namespace {

constexpr double deg = pi / 180;

/// A draw of a normal of one size about each axis; -2 ln is that of its density.
PoseSample draw(Quaternion middle, double sd, std::uint64_t index) {
  const Eigen::VectorXd z = normal_vector(11, 5, index, 3);
  PoseSample out;
  out.turning.attitude = turned(middle, Vec3<Body>{z[0], z[1], z[2]} * sd);
  out.minus_2_log = z.squaredNorm();
  return out;
}

std::vector<PoseSample> draws(Quaternion middle, double sd, std::size_t count, std::uint64_t first,
                              double share) {
  std::vector<PoseSample> out;
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back(draw(middle, sd, first + k));
    out.back().weight = share / static_cast<double>(count);
  }
  return out;
}

double share_held(const AttitudeSet &set, const std::vector<PoseSample> &fresh) {
  double held = 0;
  for (const PoseSample &s : fresh)
    held += is_in(set.balls, s.turning.attitude) ? 1 : 0;
  return held / static_cast<double>(fresh.size());
}

/// A mode that takes a peak for three times narrower than it is, as where a valley bends: balls no
/// wider than the mode left half of what was drawn anew outside.
TEST(AttitudeSet, HoldsWhatItWasNotMadeOfAsOftenAsItSays) {
  const Quaternion middle = turned({}, {0.4, -0.9, 0.3});
  PoseMode narrow;
  narrow.turning.attitude = middle;
  narrow.covariance = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  narrow.covariance[0] = narrow.covariance[4] = narrow.covariance[8] = std::pow(0.6 * deg, 2);
  const std::vector<PoseMode> modes{narrow};
  const auto set = highest_density(draws(middle, 2 * deg, 300, 0, 1), modes);
  EXPECT_GT(set.growth, 1.5);
  // 2000 of which 95 % are held scatter by .5 %, 300 by which it was chosen by 1.3 %.
  EXPECT_NEAR(share_held(set, draws(middle, 2 * deg, 2000, 10'000, 1)), 0.95, 0.04);
}

/// One of two runs has lost a peak: both are in the set, and what the lost one says of the other
/// widens no ball without end.
TEST(AttitudeSet, HoldsWhatOneOfTwoRunsHasLost) {
  const Quaternion one = turned({}, {0.4, -0.9, 0.3}), other = turned({}, {-1.4, 0.9, 1.3});
  auto both = draws(one, 2 * deg, 200, 0, 0.5);
  std::vector<std::size_t> runs(200, 0);
  for (const auto &more :
       {draws(one, 2 * deg, 120, 1000, 0.3), draws(other, 2 * deg, 80, 2000, 0.2)})
    both.insert(both.end(), more.begin(), more.end());
  runs.resize(both.size(), 1);
  const auto set = highest_density(both, {}, runs);
  EXPECT_EQ(set.growth, most_growth);
  EXPECT_GT(share_held(set, draws(other, 2 * deg, 1000, 10'000, 1)), 0.9);
  // One run has nobody to be asked by.
  EXPECT_EQ(highest_density(both, {}, std::vector<std::size_t>(both.size(), 0)).growth, 1);
}

/// Particles that never came to a narrow peak get it from draws around that peak, as heavy as these
/// say.
TEST(AttitudeSet, PeaksThatParticlesLostAreAdded) {
  const Quaternion wide = turned({}, {0.4, -0.9, 0.3}), narrow = turned({}, {-1.4, 0.9, 1.3});
  Samples particles, peaks;
  particles.draws = draws(wide, 5 * deg, 400, 0, 1);
  for (std::size_t k = 0; k < 400; ++k)
    particles.runs.push_back(k / 200);
  peaks.draws = draws(narrow, 0.1 * deg, 100, 1000, 1);
  peaks.log_evidence = particles.log_evidence + std::log(3.0); // three quarters of all
  add_lost(peaks, particles);
  double weight = 0;
  for (const PoseSample &s : particles.draws)
    weight += angle_between(s.turning.attitude, narrow) < deg ? s.weight : 0;
  // One in twenty is less likely than the particles' set and stays away.
  EXPECT_NEAR(weight, 0.75, 0.03);
  EXPECT_NEAR(particles.log_evidence, std::log(4.0), 0.1);
  EXPECT_TRUE(is_in(highest_density(particles.draws, {}, particles.runs).balls, narrow));
}

} // namespace
} // namespace umov::inverse
