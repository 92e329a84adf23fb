#include <umov/io/calibration_file.h>

#include "io/scenario/node.h"
#include "io/scenario/parse_toml.h"
#include "io/scenario/parts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {
namespace {

using scenario::Node;

Result<PolarimeterCalibration> read_polarimeter(const Node &top) {
  for (const char *name : {"efficiency", "phi0_deg", "q0", "u0", "efficiency_sd", "q0_sd"})
    UMOV_TRY(top.require(name));
  PolarimeterCalibration c;
  const double efficiency = top.number("efficiency", 1);
  if (!(efficiency > 0 && efficiency <= 2))
    return fail(
        ErrorCode::BadInput,
        fmt::format("efficiency = {}; a number above 0, at most 2, was expected", efficiency),
        top.where("efficiency"));
  const double phi0_deg = top.number("phi0_deg", 0);
  if (!(std::abs(phi0_deg) <= 360))
    return tl::unexpected(
        scenario::wrong_value(top, "phi0_deg", phi0_deg, "an angle of -360 to 360 degrees"));
  c.factor = std::polar(efficiency, 2 * phi0_deg * pi / 180);
  c.offset = {top.number("q0", 0), top.number("u0", 0)};
  if (!(std::abs(c.offset) <= 1))
    return fail(ErrorCode::BadInput,
                fmt::format("q0 = {}, u0 = {}: together they polarize by {:.3g}; at most 1 was "
                            "expected (per cent are divided by 100)",
                            c.offset.real(), c.offset.imag(), std::abs(c.offset)),
                top.where("q0"));
  c.factor_sd = top.number("efficiency_sd", 0);
  c.offset_sd = top.number("q0_sd", 0);
  if (!(c.factor_sd >= 0 && c.offset_sd >= 0))
    return fail(ErrorCode::BadInput, "standard deviations are 0 or more",
                top.where("efficiency_sd"));
  c.chi2 = top.number("chi2", 0);
  c.dof = static_cast<int>(top.integer("dof", 0));
  return c;
}

Result<PhotometricCalibration> read_photometry(const Node &node) {
  for (const char *name : {"zero_mag", "k_mag", "colour_term", "covariance"})
    UMOV_TRY(node.require(name));
  PhotometricCalibration out;
  constexpr double most = 100; // magnitudes: more is another quantity
  for (const auto &[name, value] : {std::pair{"zero_mag", &out.zero_point},
                                    {"k_mag", &out.extinction},
                                    {"colour_term", &out.colour_term},
                                    {"k2_mag", &out.second_order},
                                    {"residual_mag", &out.residual_sd}}) {
    *value = node.number(name, 0);
    if (!(std::abs(*value) <= most))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} = {}; at most {} magnitudes were expected", name, *value, most),
                  node.where(name));
  }
  UMOV_ASSIGN(numbers, node.numbers("covariance"));
  const bool is_whole = numbers.size() == 16 && std::ranges::all_of(numbers, [](double value) {
                          return std::abs(value) <= most * most;
                        });
  if (!is_whole)
    return fail(ErrorCode::BadInput,
                numbers.size() != 16
                    ? fmt::format("covariance has {}; 16 numbers, row by row, were expected",
                                  counted(numbers.size(), "number"))
                    : fmt::format("covariance holds a number beyond {0:g} or below -{0:g}; mag2 "
                                  "were expected, row by row",
                                  most * most),
                node.where("covariance"));
  for (std::size_t k = 0; k < 16; ++k)
    out.covariance[k / 4][k % 4] = numbers[k];
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) {
      const auto &c = out.covariance;
      const double most_of_it = c[a][a] * c[b][b] * (1 + 1e-9);
      if (c[a][a] < 0 || c[a][b] != c[b][a] || c[a][b] * c[a][b] > most_of_it)
        return fail(
            ErrorCode::BadInput,
            fmt::format("covariance: numbers {} and {} of the matrix's diagonal are {:g} and "
                        "{:g}, between them stand {:g} and {:g}; a symmetric matrix without "
                        "correlations above 1 was expected",
                        a + 1, b + 1, c[a][a], c[b][b], c[a][b], c[b][a]),
            node.where("covariance"));
    }
  return out;
}

std::string polarimeter_as_toml(const PolarimeterCalibration &c) {
  return fmt::format("# measured = efficiency e^(2i phi0) (truth in the instrument's axes) + q0 + "
                     "i u0\nefficiency = {}\nphi0_deg = {}\nq0 = {}\nu0 = {}\nefficiency_sd = "
                     "{}\nq0_sd = {}\nchi2 = {}\ndof = {}\n",
                     shortest(std::abs(c.factor)), shortest(std::arg(c.factor) / 2 * 180 / pi),
                     shortest(c.offset.real()), shortest(c.offset.imag()), shortest(c.factor_sd),
                     shortest(c.offset_sd), shortest(c.chi2), c.dof);
}

std::string photometry_as_toml(const PhotometricCalibration &c) {
  std::string covariance;
  for (const auto &row : c.covariance)
    for (const double value : row)
      covariance += (covariance.empty() ? "" : ", ") + shortest(value);
  return fmt::format("\n# magnitude above the air = that behind it, by the counts' own w0, + "
                     "zero_mag - k_mag X - colour_term C + k2_mag C X\n[photometry]\nzero_mag = "
                     "{}\nk_mag = {}\ncolour_term = {}\nk2_mag = {}\nresidual_mag = "
                     "{}\ncovariance = [{}]\n",
                     shortest(c.zero_point), shortest(c.extinction), shortest(c.colour_term),
                     shortest(c.second_order), shortest(c.residual_sd), covariance);
}

} // namespace

Result<CalibrationFile> read_calibration_text(const std::string &text, const std::string &file) {
  UMOV_ASSIGN(document, scenario::parse_toml(text, file));
  const Node top(document, "calibration_file", "", file);
  UMOV_TRY(top.check());
  CalibrationFile out;
  out.instrument = top.text("instrument", "");
  out.band = top.text("band", "");
  out.pol_frame = top.text("pol_frame", "");
  out.made_utc = top.text("made_utc", "");
  const bool has_photometry = top.has("photometry");
  if (!has_photometry || top.has("efficiency")) {
    UMOV_ASSIGN(calibration, read_polarimeter(top));
    out.calibration = calibration;
  }
  if (has_photometry) {
    UMOV_ASSIGN(node, top.child("photometry", "calibration_photometry"));
    UMOV_ASSIGN(photometry, read_photometry(node));
    out.photometry = photometry;
  }
  return out;
}

std::string calibration_as_toml(const CalibrationFile &f) {
  std::string out;
  for (const std::string &words : f.warnings)
    out += "# warning: " + printable(words) + "\n";
  out += fmt::format("instrument = {}\nband = {}\npol_frame = {}\nmade_utc = {}\n",
                     scenario::quoted(f.instrument), scenario::quoted(f.band),
                     scenario::quoted(f.pol_frame), scenario::quoted(f.made_utc));
  if (f.calibration)
    out += polarimeter_as_toml(*f.calibration);
  if (f.photometry)
    out += photometry_as_toml(*f.photometry);
  return out;
}

} // namespace umov
