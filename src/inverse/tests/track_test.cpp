#include "inverse/tests/box_light.h"
#include "inverse/turning_fit.h"

#include <Eigen/Dense>
#include <functional>
#include <limits>
#include <umov/inverse/track.h>

namespace umov {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using inverse::degree;

/// Light of three bands that is as linear in small turns as directions are: a part of one component
/// of the Sun or the observer each. No body has it, but a filter does not know.
bool linear_light(std::span<const Pose> poses, StokesTable &out) {
  out.resize(poses.size(), 3);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double parts[] = {poses[k].sun.y, poses[k].sun.z, poses[k].observer.z};
    for (std::size_t b = 0; b < 3; ++b) {
      BandResult light;
      light.stokes.i = 2 + parts[b];
      out.put(k, b, light);
    }
  }
  return true;
}

/// What a turn by small x, y, z changes in those: v' = v - turn x v, Sun along x, observer along y.
MatrixXd slopes() {
  MatrixXd out = MatrixXd::Zero(3, 6);
  out(0, 2) = -1; // Sun's y
  out(1, 1) = 1;  // Sun's z
  out(2, 0) = -1; // observer's z
  return out;
}

ObservedCurve one_epoch(const std::vector<double> &i, double sd) {
  ObservedCurve out;
  out.bands = {"a", "b", "c"};
  out.is_absolute = true;
  ObservedEpoch epoch;
  epoch.to_sun = {1, 0, 0};
  epoch.to_observer = {0, 1, 0};
  out.epochs = {epoch};
  for (std::size_t b = 0; b < i.size(); ++b) {
    ObservedSample s;
    s.band = b;
    s.i = i[b];
    s.i_sd = sd;
    out.samples.push_back(s);
  }
  return out;
}

std::vector<double> flat(const MatrixXd &m) { return {m.data(), m.data() + m.size()}; }

/// Kalman's filter (1960) of six unknowns, written down as it stands in textbooks.
struct Kalman {
  VectorXd x;
  MatrixXd p;
  double log_evidence = 0;
  void predict(double seconds, double noise) {
    MatrixXd f = MatrixXd::Identity(6, 6), q = MatrixXd::Zero(6, 6);
    for (int k = 0; k < 3; ++k) {
      f(k, k + 3) = seconds;
      q(k, k) = noise * noise * seconds * seconds * seconds / 3;
      q(k, k + 3) = q(k + 3, k) = noise * noise * seconds * seconds / 2;
      q(k + 3, k + 3) = noise * noise * seconds;
    }
    x = f * x;
    p = f * p * f.transpose() + q;
  }
  void update(const VectorXd &seen, double sd) {
    const MatrixXd h = slopes();
    const MatrixXd s = h * p * h.transpose() + MatrixXd::Identity(3, 3) * sd * sd;
    const VectorXd off = seen - h * x;
    log_evidence -=
        (off.dot(s.inverse() * off) + std::log(s.determinant()) + 3 * std::log(2 * pi)) / 2;
    const MatrixXd gain = p * h.transpose() * s.inverse();
    x += gain * off;
    p -= gain * h * p;
  }
};

TrackOptions exactly() {
  TrackOptions out;
  out.errors = no_floor();
  out.errors.scale_sd = 1e-7; // gains are known, as Kalman's filter takes them
  out.errors.zero_point_sd = 1e-6;
  out.threads = 1;
  return out;
}

/// What a measurement of I near 2 is off by: none is taken for better than 1e-4 of it.
double told_sd(double sd) { return std::hypot(sd, 2 * best_relative); }

MatrixXd first_covariance() {
  // Turns of 1e-3 rad: squares of them are a thousandth of what is compared.
  MatrixXd out = MatrixXd::Zero(6, 6);
  out.topLeftCorner<3, 3>() << 4, 1, 0, 1, 3, .5, 0, .5, 2;
  out.topLeftCorner<3, 3>() *= 1e-6;
  out.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() * 1e-9;
  return out;
}

TrackMode mode_at(const Vec3<Body> &turn, std::size_t number, double weight,
                  const TrackOptions &options) {
  TrackMode out = track_mode({turned({1, 0, 0, 0}, turn), {}}, flat(first_covariance()), 1, true, 3,
                             {}, options.errors);
  out.number = number;
  out.log_weight = std::log(weight);
  return out;
}

TEST(AttitudeBank, IsKalmansFilterWhereAllIsLinear) {
  const double sd = 5e-4, seconds = 10;
  TrackOptions options = exactly();
  options.rate_noise = 1e-6;
  AttitudeBank bank({mode_at({0, 0, 0}, 1, 1, options)}, linear_light, {"a", "b", "c"}, {},
                    options);
  Kalman kalman{VectorXd::Zero(6), first_covariance()};
  for (std::uint64_t e = 0; e < 20; ++e) {
    VectorXd seen(3);
    for (std::uint64_t b = 0; b < 3; ++b)
      seen[static_cast<int>(b)] =
          1e-3 * std::sin(0.3 * static_cast<double>(e + b)) + sd * noise(1, 3 * e + b);
    const auto step = bank.step(one_epoch({2 + seen[0], 2 + seen[1], 2 + seen[2]}, sd), seconds);
    ASSERT_TRUE(step) << step.error().text();
    kalman.predict(seconds, options.rate_noise);
    kalman.update(seen, told_sd(sd));
    const TrackMode &mode = bank.modes().front();
    const Vec3<Body> turn = turn_between({1, 0, 0, 0}, mode.turning.attitude);
    const Vec3<Body> w = mode.turning.rate_rad_s;
    const double mean[] = {turn.x, turn.y, turn.z, w.x, w.y, w.z};
    const std::size_t n = 6 + mode.nuisances.size();
    for (std::size_t r = 0; r < 6; ++r) {
      const int row = static_cast<int>(r);
      EXPECT_NEAR(mean[r], kalman.x[row], 0.01 * std::sqrt(kalman.p(row, row))) << e << " " << r;
      for (std::size_t c = 0; c < 6; ++c) {
        const int column = static_cast<int>(c);
        EXPECT_NEAR(mode.covariance[r * n + c], kalman.p(row, column),
                    0.01 * std::sqrt(kalman.p(row, row) * kalman.p(column, column)));
      }
    }
  }
}

TEST(AttitudeBank, WeightsAreThoseOfBayesRule) {
  const double sd = 5e-4;
  const TrackOptions options = exactly();
  const Vec3<Body> apart{0.010, -0.008, 0.006}; // five standard deviations: they stay two
  AttitudeBank bank({mode_at({0, 0, 0}, 1, 0.2, options), mode_at(apart, 2, 0.8, options)},
                    linear_light, {"a", "b", "c"}, {}, options);
  std::vector<Kalman> exact(2, {VectorXd::Zero(6), first_covariance()});
  exact[1].x.head(3) << apart.x, apart.y, apart.z;
  VectorXd seen(3); // between the two
  seen << -0.0035, -0.0045, -0.0048;
  const auto step = bank.step(one_epoch({2 + seen[0], 2 + seen[1], 2 + seen[2]}, sd), 0);
  ASSERT_TRUE(step) << step.error().text();
  for (Kalman &one : exact)
    one.update(seen, told_sd(sd));
  ASSERT_EQ(bank.modes().size(), 2u);
  double log_weight[2]{};
  for (const TrackMode &mode : bank.modes())
    log_weight[mode.number - 1] = mode.log_weight;
  // Of turns of .01 rad the squares bend light by 1e-4, a fifth of an error.
  EXPECT_NEAR(log_weight[1] - log_weight[0],
              std::log(4.0) + exact[1].log_evidence - exact[0].log_evidence, 0.2);
  EXPECT_NEAR(std::exp(log_weight[0]) + std::exp(log_weight[1]), 1, 1e-12);
}

/// A box on a pass, followed from a normal guess about the truth.
struct Pursuit {
  std::function<Turning(double)> truth; ///< at seconds
  PoseLighting light = Box();
  double attitude_sd = 2 * degree, rate_sd = 0.02 * degree, snr = 50;
  std::size_t epochs = 40;
  TrackOptions options = [] {
    TrackOptions out;
    out.errors = small().errors;
    out.errors.median_i = 5;
    out.threads = 1;
    return out;
  }();
  std::function<void(ObservedCurve &)> spoil = [](ObservedCurve &) {};
};

/// One curve of the truth: its pose at each epoch by itself.
ObservedCurve seen(const Pursuit &pursuit, std::uint64_t seed) {
  ObservedCurve out = pass(pursuit.epochs);
  for (std::size_t e = 0; e < out.epochs.size(); ++e) {
    ObservedCurve one = out;
    one.epochs = {out.epochs[e]};
    Turning now = pursuit.truth(out.epochs[e].seconds);
    now.attitude = turned(now.attitude, now.rate_rad_s * -out.epochs[e].seconds);
    observe(one, pursuit.light, now, pursuit.snr, seed * 1000 + e);
    for (ObservedSample &s : one.samples) {
      s.epoch = e;
      out.samples.push_back(s);
    }
  }
  pursuit.spoil(out);
  return out;
}

ObservedCurve epoch_of(const ObservedCurve &curve, std::size_t epoch) {
  ObservedCurve out;
  out.bands = curve.bands;
  out.epochs = {curve.epochs[epoch]};
  for (ObservedSample s : curve.samples)
    if (s.epoch == epoch) {
      s.epoch = 0;
      out.samples.push_back(s);
    }
  return out;
}

/// A guess that is off by what its covariance says.
TrackMode guess(const Pursuit &pursuit, std::uint64_t seed) {
  const Turning truth = pursuit.truth(0);
  MatrixXd covariance = MatrixXd::Zero(6, 6);
  double off[6];
  for (std::uint64_t k = 0; k < 6; ++k) {
    const double sd = k < 3 ? pursuit.attitude_sd : pursuit.rate_sd;
    covariance(static_cast<int>(k), static_cast<int>(k)) = sd * sd;
    off[k] = sd * noise(seed, 900'000 + k);
  }
  TrackMode out = track_mode({turned(truth.attitude, {off[0], off[1], off[2]}),
                              truth.rate_rad_s + Vec3<Body>{off[3], off[4], off[5]}},
                             flat(covariance), 7, false, 2, {}, pursuit.options.errors);
  out.number = 1;
  return out;
}

/// How far the truth is from a mode, in its own errors: chi-square of three numbers.
double off_of(const TrackMode &mode, Quaternion truth) {
  const Vec3<Body> turn = turn_between(mode.turning.attitude, truth);
  const auto n = static_cast<int>(6 + mode.nuisances.size());
  const MatrixXd all = Eigen::Map<const MatrixXd>(mode.covariance.data(), n, n);
  const Eigen::Vector3d v(turn.x, turn.y, turn.z);
  return v.dot(all.topLeftCorner<3, 3>().inverse() * v);
}

/// A bank that has followed a pursuit.
AttitudeBank followed(const Pursuit &pursuit, std::uint64_t seed,
                      std::size_t epochs = std::numeric_limits<std::size_t>::max()) {
  const ObservedCurve curve = seen(pursuit, seed);
  AttitudeBank bank({guess(pursuit, seed)}, pursuit.light, curve.bands, {}, pursuit.options);
  double now = 0;
  for (std::size_t e = 0; e < std::min(epochs, curve.epochs.size()); ++e) {
    const auto step = bank.step(epoch_of(curve, e), curve.epochs[e].seconds - now);
    EXPECT_TRUE(step);
    now = curve.epochs[e].seconds;
    if (bank.loss() != TrackLoss::None)
      break;
  }
  return bank;
}

/// Sum of `off_of` of the heaviest over some seeds; each of them not lost.
double sum_off(const Pursuit &pursuit, std::uint64_t seeds) {
  double out = 0;
  const double end = 10.0 * static_cast<double>(pursuit.epochs - 1);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const AttitudeBank bank = followed(pursuit, seed);
    EXPECT_EQ(bank.loss(), TrackLoss::None) << seed;
    out += off_of(bank.modes().front(), pursuit.truth(end).attitude);
  }
  return out;
}

Turning constant_turn(double seconds) {
  const Vec3<Body> rate = Vec3<Body>{0.2, -0.3, 0.25} * degree;
  return {turned(attitude_grid(1009)[300], rate * seconds), rate};
}

TEST(AttitudeBank, HoldsATurningBodyWithinItsOwnErrors) {
  Pursuit pursuit;
  pursuit.truth = constant_turn;
  constexpr std::uint64_t seeds = 30;
  const double off = sum_off(pursuit, seeds);
  // chi-square of 90: between its 1 in 1000 on either side.
  EXPECT_GT(off, 54.2);
  EXPECT_LT(off, 137.2);
}

/// Faster and faster, 0 to .29 deg/s in 390 s about an axis that stands in the body.
Turning drifting(double seconds) {
  const Vec3<Body> faster = Vec3<Body>{2e-4, 4e-4, 6e-4} * degree; // [rad/s2]
  return {turned(attitude_grid(1009)[300], faster * (seconds * seconds / 2)), faster * seconds};
}

TEST(AttitudeBank, HoldsARateThatDriftsWhereItsWalkAllowsIt) {
  Pursuit pursuit;
  pursuit.truth = drifting;
  pursuit.snr = 200;
  // 7e-3 deg/s in 10 s, always the same way: a walk of a third of that would be left behind.
  pursuit.options.rate_noise = 5e-3 * degree;
  const Turning truth = drifting(390);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const AttitudeBank held = followed(pursuit, seed);
    const TrackMode &mode = held.modes().front();
    EXPECT_EQ(held.loss(), TrackLoss::None) << seed;
    EXPECT_LT(off_of(mode, truth.attitude), 16.3) << seed; // 1 in 1000
    // A quarter of what it has turned, which a body at rest would be off.
    EXPECT_LT(angle_between(mode.turning.attitude, truth.attitude), 14 * degree) << seed;
  }
  // A constant rate cannot follow, and says so.
  pursuit.options.rate_noise = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_EQ(followed(pursuit, seed).loss(), TrackLoss::Misfit) << seed;
}

TEST(AttitudeBank, ABodyOfAnotherLightIsLostNotFollowed) {
  Pursuit pursuit;
  pursuit.truth = constant_turn;
  pursuit.spoil = [](ObservedCurve &curve) { // colours change places
    for (ObservedSample &s : curve.samples)
      s.band = 1 - s.band;
  };
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_EQ(followed(pursuit, seed).loss(), TrackLoss::Misfit) << seed;
}

TEST(AttitudeBank, WithoutLightItOnlyTurnsOn) {
  Pursuit pursuit;
  pursuit.truth = constant_turn;
  pursuit.options.rate_noise = 1e-3 * degree;
  pursuit.spoil = [](ObservedCurve &curve) {
    for (ObservedSample &s : curve.samples)
      if (s.epoch >= 20)
        s.i = s.q = s.u = std::nan("");
  };
  const TrackMode before = followed(pursuit, 1, 20).modes().front();
  const TrackMode after = followed(pursuit, 1, 30).modes().front();
  EXPECT_EQ(after.chi2, before.chi2);
  EXPECT_EQ(after.measurements, before.measurements);
  TrackMode alone = before;
  for (int k = 0; k < 10; ++k)
    alone = turned_on(alone, 10, pursuit.options.rate_noise);
  EXPECT_EQ(after.covariance, alone.covariance);
  EXPECT_LT(angle_between(after.turning.attitude, alone.turning.attitude), 1e-15);
  EXPECT_LT(off_of(after, constant_turn(290).attitude), 16.3); // 1 in 1000
  EXPECT_GT(after.covariance[0], before.covariance[0]);
}

/// 1 deg and .01 deg/s: 201 deg after 20000 s, which as an attitude is folded at half a turn and
/// would look known.
TEST(AttitudeBank, AnAttitudeThatOpensAllAroundIsToldWhateverTheDataSay) {
  Pursuit pursuit;
  pursuit.truth = [](double) { return Turning{attitude_grid(1009)[300], {}}; };
  pursuit.attitude_sd = 1 * degree;
  pursuit.rate_sd = 0.01 * degree;
  const ObservedCurve curve = seen(pursuit, 1);
  struct Case {
    double gap_s;
    TrackLoss loss;
  };
  for (const Case &one : {Case{1000, TrackLoss::None}, {20'000, TrackLoss::Open}}) {
    AttitudeBank bank({guess(pursuit, 1)}, pursuit.light, curve.bands, {}, pursuit.options);
    ASSERT_TRUE(bank.step(epoch_of(curve, 0), one.gap_s));
    EXPECT_EQ(bank.loss(), one.loss) << one.gap_s;
    EXPECT_EQ(bank.modes().front().measurements == 0, one.loss == TrackLoss::Open) << one.gap_s;
  }
}

/// The filters near the heaviest as one normal of their mean and covariance: what they say
/// together.
TrackMode together(const AttitudeBank &bank) {
  TrackMode out = bank.modes().front();
  const auto n = static_cast<int>(6 + out.nuisances.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  MatrixXd second = MatrixXd::Zero(3, 3);
  double sum = 0;
  for (const TrackMode &mode : bank.modes()) {
    const Vec3<Body> turn = turn_between(out.turning.attitude, mode.turning.attitude);
    const Eigen::Vector3d v(turn.x, turn.y, turn.z);
    if (v.norm() > 20 * degree)
      continue;
    const double weight = std::exp(mode.log_weight);
    const MatrixXd all = Eigen::Map<const MatrixXd>(mode.covariance.data(), n, n);
    sum += weight;
    mean += weight * v;
    second += weight * (all.topLeftCorner<3, 3>() + v * v.transpose());
  }
  mean /= sum;
  MatrixXd all = MatrixXd::Identity(n, n);
  all.topLeftCorner<3, 3>() = second / sum - mean * mean.transpose();
  out.turning.attitude = turned(out.turning.attitude, {mean[0], mean[1], mean[2]});
  out.covariance = flat(all);
  out.log_weight = std::log(sum);
  return out;
}

/// Starts that are known to tens of degrees about each axis: a lone filter becomes sure of the
/// first place that fits.
TEST(AttitudeBank, AWideStartIsSpreadAndFollowed) {
  Pursuit pursuit;
  pursuit.truth = constant_turn;
  pursuit.attitude_sd = 25 * degree;
  const Quaternion truth = pursuit.truth(10.0 * static_cast<double>(pursuit.epochs - 1)).attitude;
  constexpr std::uint64_t seeds = 6;
  double off = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const AttitudeBank bank = followed(pursuit, seed);
    EXPECT_EQ(bank.loss(), TrackLoss::None) << seed;
    EXPECT_FALSE(bank.memory().is_wide) << seed;
    EXPECT_LE(bank.modes().size(), 60u) << seed; // that can be split
    const TrackMode found = together(bank);
    EXPECT_GT(std::exp(found.log_weight), 0.95) << seed;
    EXPECT_LT(angle_between(found.turning.attitude, truth), 10 * degree) << seed;
    off += off_of(found, truth);
  }
  EXPECT_LT(off, 42.3); // chi-square of 18: 1 in 1000
}

TEST(AttitudeBank, AWrongNumberIsNotFollowedWhereSomeMayBeWrong) {
  Pursuit pursuit;
  pursuit.truth = constant_turn;
  pursuit.options.errors.outlier_share = 0.05;
  pursuit.spoil = [](ObservedCurve &curve) {
    for (ObservedSample &s : curve.samples)
      if (s.epoch % 9 == 4 && s.band == 0)
        s.i *= 2;
  };
  double off = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const AttitudeBank bank = followed(pursuit, seed);
    EXPECT_EQ(bank.loss(), TrackLoss::None);
    off += off_of(bank.modes().front(), constant_turn(390).attitude);
  }
  EXPECT_LT(off, 59.7); // chi-square of 30, 1 in 1000
}

/// A box with a mirror on each face, whose glint is 1.3 deg wide: an angle of the bisector.
bool glinting(std::span<const Pose> poses, StokesTable &out) {
  const bool is_lit = Box()(poses, out);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Vec3<Body> half = normalized(poses[k].sun + poses[k].observer);
    const double most = std::max({std::abs(half.x), std::abs(half.y), std::abs(half.z)});
    for (std::size_t b = 0; b < 2; ++b)
      out.i[2 * k + b] += 5 * std::pow(most, 2000);
  }
  return is_lit;
}

/// Within a glint at the tenth epoch.
Turning into_a_glint(double seconds) {
  const ObservedEpoch glint = pass(40).epochs[10];
  const Vec3<Gcrs> x = normalized(glint.to_sun + glint.to_observer);
  const Vec3<Gcrs> y = normalized(cross(x, Vec3<Gcrs>{0.2, 0.3, 1}));
  const Vec3<Body> rate = Vec3<Body>{0.02, -0.01, 0.03} * degree;
  const Quaternion there = quaternion_from(Rotation<Body, Gcrs>(x, y, cross(x, y)));
  return {turned(there, rate * (seconds - glint.seconds)), rate};
}

TEST(AttitudeBank, AGlintNarrowerThanAFilterDoesNotMakeItSureOfAWrongPlace) {
  Pursuit pursuit;
  pursuit.truth = into_a_glint;
  pursuit.light = glinting;
  pursuit.attitude_sd = 6 * degree;
  constexpr std::uint64_t seeds = 20;
  int held = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const AttitudeBank bank = followed(pursuit, seed, 16);
    double near = 0; // weight of modes that do not rule the truth out at 1 in 1000
    for (const TrackMode &mode : bank.modes())
      near += off_of(mode, into_a_glint(150).attitude) < 16.3 ? std::exp(mode.log_weight) : 0;
    held += near > 0.05 ? 1 : 0;
    wrong += near <= 0.05 && bank.loss() == TrackLoss::None ? 1 : 0;
  }
  EXPECT_GE(held, 18);
  EXPECT_LE(wrong, 1);
}

} // namespace
} // namespace umov
