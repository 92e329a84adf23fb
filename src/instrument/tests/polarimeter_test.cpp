#include "instrument/tests/anchor.h"

#include <Eigen/Dense>
#include <complex>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <umov/instrument/mirrors.h>
#include <umov/instrument/polarimeter.h>

namespace umov {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
const Stokes<InstrumentAxes> light{1, .2, -.1, .05};

std::array<double, 2> beams(const Polarimeter &p, double plate_deg, double turn_deg = 0) {
  const auto channels = polarimeter_channels(p, {0, plate_deg, turn_deg}, 550);
  return {respond(channels->at(0).row, light), respond(channels->at(1).row, light)};
}

Polarimeter plate(double retardance_deg, double extinction = infinite) {
  Polarimeter out;
  out.type = PolarimeterType::HwpDualBeam;
  out.retardance_deg = {{}, {retardance_deg}};
  out.extinction = {{}, {extinction}};
  return out;
}

std::vector<StokesRow> rows_of(const Polarimeter &p, const std::vector<PolarimeterState> &states) {
  std::vector<StokesRow> out;
  for (const PolarimeterState &state : states) {
    const auto channels = polarimeter_channels(p, state, 550);
    for (const PolarimeterChannel &channel : *channels)
      out.push_back(channel.row);
  }
  return out;
}

TEST(Elements, QuarterWaveSigns) {
  // Fields: fast axis x, y is delayed by a quarter. U = 1 becomes V = +1; at 45 deg Q = 1, V = -1.
  const auto along = retarder(Angle::degrees(90), Angle()) * Stokes<InstrumentAxes>{1, 0, 1, 0};
  EXPECT_NEAR(along.v, 1, 1e-15);
  const auto across =
      retarder(Angle::degrees(90), Angle::degrees(45)) * Stokes<InstrumentAxes>{1, 1, 0, 0};
  EXPECT_NEAR(across.v, -1, 1e-15);
}

TEST(Elements, TurnsUndoEachOther) {
  const auto back = axes_turned(Angle::degrees(-31)) * axes_turned(Angle::degrees(31));
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(back.m[r][c], r == c ? 1 : 0, 1e-14);
}

/// Smallest eigenvalue of the coherency matrix: a Mueller matrix that fields can make has none
/// below 0 (Cloude 1986, Optik 75, 26).
double smallest_coherency(const InstrumentMueller &mueller) {
  using Complex = std::complex<double>;
  using Pauli = Eigen::Matrix2cd;
  const Complex i(0, 1);
  Pauli sigma[4];
  sigma[0] << 1, 0, 0, 1;
  sigma[1] << 1, 0, 0, -1;
  sigma[2] << 0, 1, 1, 0;
  sigma[3] << 0, -i, i, 0;
  Eigen::Matrix4cd sum = Eigen::Matrix4cd::Zero();
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b)
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
          sum(r, c) += mueller.m[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] / 4 *
                       sigma[a](r / 2, c / 2) * std::conj(sigma[b](r % 2, c % 2));
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4cd>(sum).eigenvalues()(0);
}

TEST(Elements, FieldsCanMakeThem) {
  for (const double angle : {0., 17., 45., 100.}) {
    const Angle at = Angle::degrees(angle);
    for (const InstrumentMueller &element :
         {polarizer(300, at), polarizer(infinite, at), retarder(Angle::degrees(131.8), at),
          turned(diattenuating_retarder(.9, .3, Angle::degrees(70)), at), axes_turned(at),
          behind(polarizer(100, at), retarder(Angle::degrees(90), Angle::degrees(22.5))),
          mirror_element({.96, 6.7}, std::cos(at.radians() / 2)), // aluminium
          nasmyth_port(mirror_element({.96, 6.7}, std::sqrt(.5)), NasmythSide::Left, at)})
      EXPECT_GE(smallest_coherency(element), -1e-12);
  }
  // A wrong sign in the lower block is found: no field makes it.
  InstrumentMueller wrong = retarder(Angle::degrees(70), Angle());
  wrong.m[3][2] = -wrong.m[3][2];
  EXPECT_LT(smallest_coherency(wrong), -.1);
}

TEST(Elements, PolarizerWithExtinction) { // nine digits
  const auto row = first_row(polarizer(300, Angle::degrees(30)));
  EXPECT_NEAR(respond(row, light), of("polarizer_300_30"), 1e-9);
  EXPECT_NEAR(std::hypot(row[1], row[2]) / row[0], of("diattenuation_300"), 1e-9);
  const auto worse = first_row(polarizer(100, Angle::degrees(30)));
  EXPECT_NEAR(std::hypot(worse[1], worse[2]) / worse[0], of("diattenuation_100"), 1e-9);
}

/// Difference of two plate positions' beams, halved (docs/theory/observing.md 4).
double difference(std::array<double, 2> a, std::array<double, 2> b) {
  return ((a[0] - a[1]) / (a[0] + a[1]) - (b[0] - b[1]) / (b[0] + b[1])) / 2;
}

TEST(HalfWavePlate, ImperfectionsAsFieldsGiveThem) { // nine digits
  for (const auto &[name, p] :
       {std::pair{"retardance", plate(185)}, {"extinction", plate(180, 300)}}) {
    EXPECT_NEAR(difference(beams(p, 0), beams(p, 45)), of(name + std::string("_difference_q")),
                1e-9);
    EXPECT_NEAR(difference(beams(p, 22.5), beams(p, 67.5)), of(name + std::string("_difference_u")),
                1e-9);
  }
}

TEST(HalfWavePlate, ItsZeroTurnsTheAngleTwice) { // nine digits
  Polarimeter p = plate(180);
  p.plate_zero_deg = .5;
  EXPECT_NEAR(difference(beams(p, 0), beams(p, 45)), of("plate_zero_ratio_q"), 1e-9);
  EXPECT_NEAR(difference(beams(p, 22.5), beams(p, 67.5)), of("plate_zero_ratio_u"), 1e-9);
}

/// The mean over a turn is the mean of plates that stand, at 2000 midpoints: off by the square of a
/// piece's angle in the fourfold wave over 24, for 400 deg 8e-6.
TEST(TurningPlate, ItsRowIsTheMeanOfPlatesThatStand) {
  Polarimeter p = plate(131.8, 30); // all waves, and V
  p.plate_zero_deg = 7;
  constexpr int pieces = 2000;
  for (const double turn : {1e-7, -3., 22.5, 90., 400.}) {
    std::array<StokesRow, 2> sums{};
    for (int k = 0; k < pieces; ++k) {
      const auto c = polarimeter_channels(p, {0, 20 + turn * ((k + .5) / pieces - .5), 0}, 550);
      for (std::size_t beam = 0; beam < 2; ++beam)
        sums[beam] = sums[beam] + c->at(beam).row * (1. / pieces);
    }
    const double piece = 4 * std::abs(turn) * pi / 180 / pieces;
    const auto turned = polarimeter_channels(p, {0, 20, turn}, 550);
    for (std::size_t beam = 0; beam < 2; ++beam)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(turned->at(beam).row[k], sums[beam][k], piece * piece / 24 + 1e-12)
            << turn << " " << beam << " " << k;
  }
}

/// Of ever more turns only what the plate does at no angle is left: (1 + cos)/2 of q.
TEST(TurningPlate, AnyNumberOfTurnsIsAveraged) {
  const double expected = (1 + std::cos(131.8 * pi / 180)) / 4;
  for (const double turn : {1e12, 1e300, infinite}) {
    const auto rows = polarimeter_channels(plate(131.8), {0, 20, turn}, 550);
    EXPECT_NEAR(rows->at(0).row[0], .5, 1e-12) << turn;
    EXPECT_NEAR(rows->at(0).row[1], expected, 1e-10) << turn; // 1/(1e12 deg)
    EXPECT_NEAR(rows->at(0).row[2], 0, 1e-10) << turn;
    EXPECT_NEAR(rows->at(0).row[3], 0, 1e-10) << turn;
  }
}

TEST(HalfWavePlate, ASimplePlateIsOneForOneWavelength) {
  // Half a wave at 550 nm is 180 + e deg elsewhere: (1 + cos e)/2 of q is left, sin(e)/2 of v
  // added.
  Polarimeter p = plate(180);
  p.retardance_deg = {{425, 550, 650}, {180 * 550 / 425., 180, 180 * 550 / 650.}};
  struct Case {
    double nm, efficiency, leak;
  };
  for (const Case &one : {Case{425, .8013173, .399}, {550, 1, 0}, {650, .9427280, -.232}}) {
    StokesRow row{};
    for (const double angle : {0., 45.}) {
      const auto c = polarimeter_channels(p, {0, angle, 0}, one.nm);
      row = row + (c->at(0).row + c->at(1).row * -1) * (angle > 0 ? -.5 : .5);
    }
    EXPECT_NEAR(row[1], one.efficiency, 5e-8) << one.nm; // seven digits, three of the leak
    EXPECT_NEAR(row[3], one.leak, 5e-4) << one.nm;
  }
}

TEST(HalfWavePlate, EightPositionsCancelCircularLight) {
  const Polarimeter p = plate(185);
  const double q =
      (difference(beams(p, 0), beams(p, 45)) + difference(beams(p, 90), beams(p, 135))) / 2;
  // (1 + cos e)/2 of q remains, no V.
  EXPECT_NEAR(q, .2 * (1 + std::cos(5 * pi / 180)) / 2, 1e-6);
}

TEST(HalfWavePlate, TurningLosesModulation) {
  // 16 frames a turn: sin(2a)/(2a) with a = 22.5 deg.
  const Polarimeter p = plate(180);
  const double q = difference(beams(p, 0, 22.5), beams(p, 45, 22.5));
  EXPECT_NEAR(q / .2, std::sin(pi / 4) / (pi / 4), 1e-9);
}

TEST(Modulation, RetarderSchemes) {
  Polarimeter p;
  p.type = PolarimeterType::RotatingRetarder;
  const auto at = [&](double retardance, std::vector<double> angles) {
    p.retardance_deg = {{}, {retardance}};
    std::vector<PolarimeterState> states;
    for (const double a : angles)
      states.push_back({0, a, 0});
    return modulation_quality(rows_of(p, states), 4);
  };
  const auto balanced = at(131.8, {-51.69, -15.12, 15.12, 51.69});
  EXPECT_NEAR(balanced.condition, of("balanced_condition"), 1e-8);
  EXPECT_NEAR(balanced.weighted_variance, of("balanced_variance"), 1e-7);
  // sd(q, u) = sqrt(3/N); of q and u alone it goes with the retardance, told to .05 deg (.0009
  // rad).
  EXPECT_NEAR(balanced.linear_variance, 3, 1e-3);
  const auto rounded = at(132, {-51.7, -15.1, 15.1, 51.7});
  EXPECT_NEAR(rounded.condition, of("rounded_condition"), 1e-8);
  EXPECT_NEAR(rounded.weighted_variance, of("rounded_variance"), 1e-7);
  const auto quarter = at(90, {0, 22.5, 45, 67.5, 90, 112.5, 135, 157.5});
  EXPECT_NEAR(quarter.condition, of("quarter_condition"), 1e-8);
  EXPECT_NEAR(quarter.weighted_variance, of("quarter_variance"), 1e-7);
  EXPECT_EQ(at(90, {0, 45, 90, 135}).missing, "U"); // cos^2, sin 2a cos 2a = 0, sin 2a
  EXPECT_TRUE(std::isinf(at(90, {0, 45, 90, 135}).condition));
}

TEST(Modulation, PolarizationIsOfQAndUAlone) {
  // Six rows (1, a, 0, 0), (1, 0, a, 0), (1, 0, 0, b) of both signs: W^T W is diag(6, 2 a^2, 2 a^2,
  // 2 b^2), so that V is known a quarter as well and does not count.
  const double a = 0.8, b = 0.2;
  const std::vector<StokesRow> rows{{1, a, 0, 0},  {1, -a, 0, 0}, {1, 0, a, 0},
                                    {1, 0, -a, 0}, {1, 0, 0, b},  {1, 0, 0, -b}};
  const ModulationQuality found = modulation_quality(rows, 4);
  EXPECT_NEAR(found.linear_variance, 1 / (2 * a * a), 1e-12);
  EXPECT_NEAR(found.weighted_variance, 1. / 6 + 1 / (a * a) + 1 / (2 * b * b), 1e-12);
}

TEST(Modulation, FourAnalysersAreAsGoodAsThree) {
  Polarimeter p;
  p.type = PolarimeterType::Mosaic;
  p.angles_deg = {90, 45, 135, 0};
  EXPECT_NEAR(modulation_quality(rows_of(p, {{}}), 3).condition, std::sqrt(2.), 1e-12);
  // W^T W of n rows (1, cos, sin)/(2 n): diag(1, 1/2, 1/2)/(4 n).
  EXPECT_NEAR(modulation_quality(rows_of(p, {{}}), 3).linear_variance, 8 * 4, 1e-9);
  EXPECT_NEAR(modulation_quality(rows_of(p, {{}}), 3).weighted_variance, 20 * 4, 1e-9);
  p.angles_deg = {0, 60, 120};
  EXPECT_NEAR(modulation_quality(rows_of(p, {{}}), 3).condition, std::sqrt(2.), 1e-12);
}

TEST(Pem, PhasesTellAllFourParametersWithTwoAngles) {
  Polarimeter p;
  p.type = PolarimeterType::Pem;
  const auto one = modulation_quality(rows_of(p, {{}}), 4);
  EXPECT_EQ(one.missing, "U"); // one modulator sees q and v
  EXPECT_LT(modulation_quality(rows_of(p, {{0, 0, 0}, {45, 0, 0}}), 4).condition, 3);
  // Bins together lose nothing, and where J0 of the amplitude is 0 no q stays in their mean.
  StokesRow sum{};
  for (const StokesRow &row : rows_of(p, {{}}))
    sum = sum + row;
  EXPECT_NEAR(sum[0], .5, 1e-12);
  EXPECT_NEAR(sum[1], 0, 1e-8); // amplitude given to 1e-6 deg
}

/// Counts of each part of the period are the harmonics of Jacobi and Anger's series, averaged over
/// it (docs/theory/observing.md 4). Nine digits.
TEST(Pem, PhasesHaveTheHarmonicsOfBessel) {
  Polarimeter p;
  p.type = PolarimeterType::Pem;
  for (const auto &[name, amplitude] : {std::pair{"dark", p.amplitude_deg}, {"quarter", 90.}}) {
    p.amplitude_deg = amplitude;
    const auto rows = rows_of(p, {{}});
    ASSERT_EQ(rows.size(), 8U);
    for (std::size_t b = 0; b < rows.size(); ++b) {
      const std::string part = fmt::format("modulator_{}_{}_", name, b);
      EXPECT_NEAR(rows[b][0], 1. / 16, 1e-12);
      EXPECT_NEAR(rows[b][1], of(part + "q"), 1e-9) << part;
      EXPECT_NEAR(rows[b][2], 0, 1e-12);
      EXPECT_NEAR(rows[b][3], of(part + "v"), 1e-9) << part;
    }
  }
}

/// 2 J1 of v at the modulator's frequency and 2 J2 of q at twice that, relative to the mean. Eight
/// parts take the harmonic 8 - m for m, a part in 7 or 3 of it: J7 is 6e-4, J6 is 3.4e-3.
TEST(Pem, DemodulatedAmplitudes) {
  Polarimeter p;
  p.type = PolarimeterType::Pem;
  const auto rows = rows_of(p, {{}});
  double v = 0, q = 0;
  for (std::size_t b = 0; b < 8; ++b) {
    const double phase = 2 * pi * (static_cast<double>(b) + .5) / 8;
    v += 16 * rows[b][3] * std::sin(phase) / 4;
    q += 16 * rows[b][1] * std::cos(2 * phase) / 4;
  }
  const auto averaged = [](double m) { return std::sin(m * pi / 8) / (m * pi / 8); };
  EXPECT_NEAR(v / averaged(1), 2 * of("modulator_j1"), 2 * 6e-4 / 7 * 1.1);
  EXPECT_NEAR(q / averaged(2), 2 * of("modulator_j2"), 2 * 3.4e-3 / 3 * 1.1);
}

/// A plate of 170 deg at 7 deg and, flipped, at 52, before beams of E = 300: as fields give it.
TEST(Flc, RowsOfBothStates) { // nine digits
  Polarimeter p;
  p.type = PolarimeterType::Flc;
  p.retardance_deg = {{}, {170}};
  p.extinction = {{}, {300}};
  const auto channels = polarimeter_channels(p, {0, 7, 0}, 550);
  ASSERT_EQ(channels->size(), 4U);
  for (const PolarimeterChannel &channel : *channels)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(channel.row[k], of(fmt::format("flip_{}_{}", channel.name, k)), 1e-9)
          << channel.name << k;
}

TEST(Polarimeter, SharesAddUpToOne) {
  for (const PolarimeterType type : {PolarimeterType::HwpDualBeam, PolarimeterType::Flc}) {
    Polarimeter p;
    p.type = type;
    StokesRow sum{};
    for (const StokesRow &row : rows_of(p, {{}}))
      sum = sum + row;
    EXPECT_NEAR(sum[0], 1, 1e-12);
    EXPECT_NEAR(sum[1], 0, 1e-12);
  }
}

} // namespace
} // namespace umov
