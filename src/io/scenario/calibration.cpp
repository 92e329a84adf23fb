#include <umov/io/calibration_file.h>

#include "io/scenario/node.h"
#include "io/scenario/parts.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {

Result<CalibrationFile> read_calibration_text(const std::string &text, const std::string &file) {
  try {
    const toml::table document = toml::parse(text, file);
    const scenario::Node top(document, "calibration_file", "", file);
    UMOV_TRY(top.check());
    for (const char *name : {"efficiency", "phi0_deg", "q0", "u0", "efficiency_sd", "q0_sd"})
      UMOV_TRY(top.require(name));
    CalibrationFile out;
    out.instrument = top.text("instrument", "");
    out.band = top.text("band", "");
    out.pol_frame = top.text("pol_frame", "");
    out.made_utc = top.text("made_utc", "");
    PolarimeterCalibration &c = out.calibration;
    const double efficiency = top.number("efficiency", 1);
    if (!(efficiency > 0 && efficiency <= 2))
      return fail(
          ErrorCode::BadInput,
          fmt::format("efficiency = {}; a number above 0, at most 2, was expected", efficiency),
          top.where("efficiency"));
    c.factor = std::polar(efficiency, 2 * top.number("phi0_deg", 0) * pi / 180);
    c.offset = {top.number("q0", 0), top.number("u0", 0)};
    c.factor_sd = top.number("efficiency_sd", 0);
    c.offset_sd = top.number("q0_sd", 0);
    if (!(c.factor_sd >= 0 && c.offset_sd >= 0))
      return fail(ErrorCode::BadInput, "standard deviations are 0 or more",
                  top.where("efficiency_sd"));
    c.chi2 = top.number("chi2", 0);
    c.dof = static_cast<int>(top.integer("dof", 0));
    return out;
  } catch (const toml::parse_error &problem) {
    return tl::unexpected(scenario::no_toml(problem, file));
  }
}

std::string calibration_as_toml(const CalibrationFile &f) {
  const PolarimeterCalibration &c = f.calibration;
  std::string warnings;
  for (const std::string &words : f.warnings)
    warnings += "# warning: " + printable(words) + "\n";
  return fmt::format(
      "# measured = efficiency e^(2i phi0) (truth in the instrument's axes) + q0 + i u0\n"
      "{}instrument = {}\nband = {}\npol_frame = {}\nmade_utc = {}\nefficiency = {}\nphi0_deg = "
      "{}\n"
      "q0 = {}\nu0 = {}\nefficiency_sd = {}\nq0_sd = {}\nchi2 = {}\ndof = {}\n",
      warnings, scenario::quoted(f.instrument), scenario::quoted(f.band),
      scenario::quoted(f.pol_frame), scenario::quoted(f.made_utc), shortest(std::abs(c.factor)),
      shortest(std::arg(c.factor) / 2 * 180 / pi), shortest(c.offset.real()),
      shortest(c.offset.imag()), shortest(c.factor_sd), shortest(c.offset_sd), shortest(c.chi2),
      c.dof);
}

} // namespace umov
