#include <umov/instrument/polarimeter.h>

#include "algebra/dense.h"
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace umov {
namespace {

/// Nodes and weights of the Gauss-Legendre rule with 4 points on [-1/2, 1/2].
constexpr std::array<std::array<double, 2>, 4> gauss4{{{-0.43056815579702629, 0.17392742256872693},
                                                       {-0.16999052179242813, 0.32607257743127307},
                                                       {0.16999052179242813, 0.32607257743127307},
                                                       {0.43056815579702629, 0.17392742256872693}}};

/// sin(x)/x, what a mean over [-x, x] leaves of a wave.
double left_of_wave(double x) {
  if (std::abs(x) < 1e-8) // its square is below the last digit
    return 1;
  return std::isfinite(x) ? std::sin(x) / x : 0;
}

/// The plate before an analyser, averaged over its turn. A row is a constant and waves of twice and
/// four times the plate's angle, which rows a half and a quarter of the first one's period away
/// tell apart; so however far the plate turns, four rows are enough.
StokesRow plate_row(const InstrumentMueller &analyser, double retardance_deg, double plate_deg,
                    double turn_deg) {
  const auto at = [&](double ahead_deg) {
    return first_row(behind(
        analyser, retarder(Angle::degrees(retardance_deg), Angle::degrees(plate_deg + ahead_deg))));
  };
  const StokesRow here = at(0);
  if (turn_deg == 0)
    return here;
  const StokesRow across = at(90), sides = at(45) + at(135);
  const StokesRow constant = (here + across + sides) * .25;
  const StokesRow twice = (here + across * -1) * .5, fourfold = (here + across + sides * -1) * .25;
  const double turn = turn_deg * pi / 180;
  return constant + twice * left_of_wave(turn) + fourfold * left_of_wave(2 * turn);
}

/// Counts in eight equal parts of the modulator's period (docs/theory/observing.md).
std::vector<PolarimeterChannel> pem_channels(const Polarimeter &p, double extinction,
                                             double analyser_deg) {
  constexpr int bins = 8, pieces = 4;
  std::vector<PolarimeterChannel> out;
  const InstrumentMueller analyser = polarizer(extinction, Angle());
  for (int b = 0; b < bins; ++b) {
    StokesRow row{};
    for (int k = 0; k < pieces; ++k)
      for (const auto &[x, w] : gauss4) {
        const double phase = 2 * pi * (b + (k + .5 + x) / pieces) / bins;
        const Angle d = Angle::degrees(p.amplitude_deg * std::sin(phase));
        row = row +
              first_row(behind(analyser, retarder(d, Angle::degrees(45)))) * (w / pieces / bins);
      }
    out.push_back({fmt::format("phase{}", b), analyser_deg,
                   row_on_sky(row, Angle::degrees(analyser_deg)), 1. / bins});
  }
  return out;
}

std::vector<PolarimeterChannel> analyser_channels(const std::vector<double> &angles,
                                                  double extinction) {
  std::vector<PolarimeterChannel> out;
  out.reserve(angles.size());
  for (const double angle : angles)
    out.push_back({fmt::format("{:g}", angle), angle,
                   first_row(polarizer(extinction, Angle::degrees(angle))) *
                       (1 / static_cast<double>(angles.size()))});
  return out;
}

/// The two beams behind a plate; `share` of the time.
void add_beams(std::vector<PolarimeterChannel> &out, const std::string &suffix, double extinction,
               double retardance, double plate, double turn, double share) {
  for (const auto &[name, angle] : {std::pair{"o", 0.}, {"x", 90.}})
    out.push_back(
        {name + suffix, angle,
         plate_row(polarizer(extinction, Angle::degrees(angle)), retardance, plate, turn) * share,
         share});
}

} // namespace

Result<std::vector<PolarimeterChannel>>
polarimeter_channels(const Polarimeter &p, const PolarimeterState &state, double nm) {
  UMOV_ASSIGN(extinction, value_at(p.extinction, Wavelength::nm(nm), "polarimeter.extinction"));
  UMOV_ASSIGN(retardance,
              value_at(p.retardance_deg, Wavelength::nm(nm), "polarimeter.retardance_deg"));
  const double plate = state.plate_deg + p.plate_zero_deg;
  std::vector<PolarimeterChannel> out;
  switch (p.type) {
  case PolarimeterType::None:
    return {{{"all", 0, {1, 0, 0, 0}}}};
  case PolarimeterType::PolarizerWheel:
    return analyser_channels({state.analyser_deg}, extinction);
  case PolarimeterType::HwpDualBeam:
  case PolarimeterType::SpinningHwpDualBeam:
    add_beams(out, "", extinction, retardance, plate, state.plate_turn_deg, 1);
    return out;
  case PolarimeterType::RotatingRetarder:
    return {{{"all", 0,
              plate_row(polarizer(extinction, Angle::degrees(state.analyser_deg)), retardance,
                        plate, state.plate_turn_deg)}}};
  case PolarimeterType::Pem:
    return pem_channels(p, extinction, state.analyser_deg);
  case PolarimeterType::Flc:
    add_beams(out, "a", extinction, retardance, plate, 0, .5);
    add_beams(out, "b", extinction, retardance, plate + 45, 0, .5);
    return out;
  case PolarimeterType::FourCamera:
  case PolarimeterType::Mosaic:
    break;
  }
  out = analyser_channels(p.angles_deg, extinction);
  if (p.has_separate_pupils) // every lens has light of its own
    for (PolarimeterChannel &channel : out)
      channel.row = channel.row * static_cast<double>(out.size());
  return out;
}

bool is_simultaneous(PolarimeterType type) {
  return type == PolarimeterType::None || type == PolarimeterType::FourCamera ||
         type == PolarimeterType::Mosaic;
}

double pixel_parts(const Polarimeter &p) { return p.type == PolarimeterType::Mosaic ? 4 : 1; }

bool has_plate(PolarimeterType type) {
  return type == PolarimeterType::HwpDualBeam || type == PolarimeterType::SpinningHwpDualBeam ||
         type == PolarimeterType::RotatingRetarder || type == PolarimeterType::Flc;
}

std::size_t parameters_of(PolarimeterType type) {
  if (type == PolarimeterType::None)
    return 1;
  return type == PolarimeterType::RotatingRetarder || type == PolarimeterType::Pem ? 4 : 3;
}

const std::vector<std::string> &polarimeter_names() {
  static const std::vector<std::string> names{"none",
                                              "polarizer_wheel",
                                              "hwp_dual_beam",
                                              "spinning_hwp_dual_beam",
                                              "rotating_retarder",
                                              "pem",
                                              "flc",
                                              "four_camera",
                                              "mosaic"};
  return names;
}

const char *name_of(PolarimeterType type) {
  return polarimeter_names()[static_cast<std::size_t>(type)].c_str();
}

namespace {

/// Stokes parameters that change unseen: those in the directions of no weight.
std::string blind_to(const algebra::SymmetricEigen &squares, double smallest) {
  std::string out;
  for (Eigen::Index c = 0; c < squares.values.size(); ++c) {
    double share = 0;
    for (Eigen::Index k = 0; k < squares.values.size(); ++k)
      if (!(squares.values(k) > smallest))
        share += squares.vectors(c, k) * squares.vectors(c, k);
    if (constexpr double notable = 0.05; share > notable)
      out += (out.empty() ? "" : ", ") + std::string(1, "IQUV"[c]);
  }
  return out;
}

} // namespace

ModulationQuality modulation_quality(const std::vector<StokesRow> &rows, std::size_t parameters) {
  const auto columns = static_cast<Eigen::Index>(parameters);
  Eigen::MatrixXd w(static_cast<Eigen::Index>(rows.size()), columns);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < parameters; ++c)
      w(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
  // Of W^T W, rising.
  const algebra::SymmetricEigen squares = algebra::symmetric_eigen(algebra::gram(w));
  ModulationQuality out;
  // Field rotation of a second of arc makes plates at 0 and 45 deg tell U by name, with errors a
  // thousand times and more those of q: nothing is told.
  constexpr double worst_condition = 1000;
  constexpr double blind = 1 / (worst_condition * worst_condition);
  const double smallest = squares.values(0), largest = squares.values(columns - 1);
  if (!(smallest > blind * largest)) {
    out.condition = out.weighted_variance = out.linear_variance =
        std::numeric_limits<double>::infinity();
    if (constexpr double rounding = 1e-13; smallest > rounding * largest)
      out.condition = std::sqrt(largest / smallest);
    out.missing = blind_to(squares, blind * largest);
    return out;
  }
  out.condition = std::sqrt(largest / smallest);
  out.weighted_variance = squares.values.cwiseInverse().sum();
  const auto variance = [&](Eigen::Index parameter) {
    return squares.vectors.row(parameter).cwiseAbs2().dot(
        squares.values.cwiseInverse().transpose());
  };
  if (columns > 2)
    out.linear_variance = (variance(1) + variance(2)) / 2;
  return out;
}

} // namespace umov
