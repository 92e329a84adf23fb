#include <umov/jobs/calibrate.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <tuple>
#include <umov/core/text.h>
#include <umov/io/table.h>
#include <umov/jobs/reduce.h>
#include <umov/time/epoch.h>

namespace umov::jobs {
namespace {

std::string note_of(const CountsFile &counts, const char *name) {
  const auto found = counts.notes.find(name);
  return found == counts.notes.end() ? "" : found->second;
}

/// No set of a standard: for want of its name, or of q and u.
std::string no_standard(const Table &table, const std::vector<StandardStar> &standards) {
  std::vector<std::string> seen, known;
  for (const StandardStar &one : standards)
    known.push_back(printable(one.name));
  for (std::size_t k = 0; k < table.rows(); ++k)
    if (const std::string name = printable(table.text("name", k));
        std::ranges::find(seen, name) == seen.end())
      seen.push_back(name);
  for (const std::string &name : seen)
    if (std::ranges::find(known, name) != known.end())
      return fmt::format("no set of \"{}\" has q and u; see the flags of umov reduce", name);
  constexpr std::size_t most = 5;
  return fmt::format("no name of the counts ({}) is that of a standard ({}); the column \"name\" "
                     "of both must agree",
                     listed(seen, most), listed(known, most));
}

/// A fit that rests on little, or that its own errors do not explain.
void warn_of_standards(const std::vector<StandardMeasurement> &data,
                       const PolarimeterCalibration &found, Diagnostics &diagnostics) {
  const double first = data.front().axis_rad;
  constexpr double apart = pi / 180;
  if (std::ranges::none_of(data, [&](const StandardMeasurement &one) {
        return std::abs(std::remainder(one.axis_rad - first, pi)) > apart;
      }))
    diagnostics.warn("all standards stand at one angle of the instrument: phi0 and q0, u0 are told "
                     "apart by what the tables say of the stars alone. Turn the instrument, or "
                     "take a plate");
  constexpr double chance = 1e-3;
  if (found.dof > 0 && boost::math::gamma_q(found.dof / 2., found.chi2 / 2) < chance)
    diagnostics.warn(fmt::format("chi2 = {:.3g} of {} degrees of freedom: the standards disagree "
                                 "by more than their errors. Is a name, an angle or x_axis_pa "
                                 "wrong?",
                                 found.chi2, found.dof));
}

/// Sets of standards, as the two fits want them.
struct Measured {
  std::vector<StandardMeasurement> polarized;
  std::vector<PhotometricStandard> bright;
  std::size_t faint = 0; ///< sets of standards with magnitudes that were hardly seen
};

/// A set's magnitude behind the air, by the w0 of its counts.
PhotometricStandard measured_light(const Table &table, std::size_t k, const StandardStar &star) {
  const double through = table.number("I_obs", k) / table.number("I", k);
  return {star.mag, table.number("mag", k) - 2.5 * std::log10(through), table.number("airmass", k),
          star.colour};
}

StandardMeasurement measured_polarization(const Table &table, std::size_t k,
                                          const StandardStar &star, std::size_t number) {
  const double axis = table.number("x_axis_pa", k) * pi / 180;
  const double variance = (table.number("cov_qq", k) + table.number("cov_uu", k)) / 2;
  return {std::complex(table.number("q", k), table.number("u", k)) * std::polar(1.0, -2 * axis),
          std::polar(star.p, 2 * star.angle_rad),
          axis,
          std::sqrt(variance),
          number,
          star.p_sd,
          star.angle_sd};
}

Measured measured(const Table &table, const std::vector<StandardStar> &standards) {
  Measured out;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const auto star = std::ranges::find(standards, table.text("name", k), &StandardStar::name);
    if (star == standards.end())
      continue;
    if (!std::isnan(star->p) && std::isfinite(table.number("q", k)))
      out.polarized.push_back(measured_polarization(
          table, k, *star, static_cast<std::size_t>(star - standards.begin())));
    if (std::isnan(star->mag))
      continue;
    // What was not seen has no magnitude, and what was hardly seen one that a cloud made.
    if (!(table.number("I", k) > 0) || table.text("flags", k).find("faint") != std::string::npos)
      ++out.faint;
    else
      out.bright.push_back(measured_light(table, k, *star));
  }
  return out;
}

/// Zero point and extinction; the colour term where every star has a colour.
Result<PhotometricCalibration> photometry_of(const std::vector<PhotometricStandard> &stars,
                                             bool has_second_order) {
  for (const PhotometricStandard &one : stars) {
    if (!std::isfinite(one.instrumental_mag))
      return fail(ErrorCode::BadInput,
                  "photometry of counts without magnitudes behind the air: columns airmass and "
                  "k_mag (0 where w0 knows no air) and a line \"zero_flux BAND\" of the header "
                  "were expected");
    if (constexpr double least = 0.99; !(one.airmass >= least))
      return fail(ErrorCode::BadInput, fmt::format("photometry at an air mass of {}: a column "
                                                   "airmass of 1 and more was expected",
                                                   one.airmass));
  }
  const auto known = std::ranges::count_if(
      stars, [](const PhotometricStandard &one) { return !std::isnan(one.colour); });
  if (known == 0 && !has_second_order)
    return calibrate_photometry(stars, 2);
  if (known < static_cast<std::ptrdiff_t>(stars.size()))
    return fail(ErrorCode::BadInput,
                fmt::format("a colour stands beside {} of {} measurements of standards: all of "
                            "them, or none (and no k''), were expected",
                            known, stars.size()));
  return calibrate_photometry(stars, has_second_order ? 4 : 3);
}

/// No instrument makes more of polarization than there is, nor all but nothing of it: degrees of
/// another unit.
Result<void> check_efficiency(const PolarimeterCalibration &found) {
  const double efficiency = std::abs(found.factor);
  const bool has_sd = std::isfinite(found.factor_sd);
  const double sd = has_sd ? found.factor_sd : std::numeric_limits<double>::infinity();
  constexpr double most = 1.2, surely = 2, least = .02, deviations = 3;
  const bool is_more = efficiency > surely || efficiency - deviations * sd > most;
  if (!is_more && efficiency + deviations * sd > least)
    return {};
  return fail(
      ErrorCode::BadInput,
      fmt::format("efficiency = {:.3g}{}: the counts are polarized by {:.3g} times "
                  "what p_percent says; {:g} to {:g} was expected. Are the standards in per "
                  "cent (4.893, not 0.04893 nor 489.3), and the names those of the stars?",
                  efficiency, has_sd ? fmt::format(" +- {:.2g}", sd) : "", efficiency, least,
                  most));
}

/// Both fits; where one of them works, what hinders the other is a warning.
Result<void> fit(const Measured &data, bool has_second_order, CalibrationFile &out,
                 Diagnostics &diagnostics) {
  std::vector<std::string> hindered;
  if (!data.polarized.empty()) {
    const auto found = calibrate_polarimeter(data.polarized);
    const Result<void> fits =
        found ? check_efficiency(*found) : Result<void>(tl::unexpected(found.error()));
    if (fits) {
      out.calibration = *found;
      warn_of_standards(data.polarized, *found, diagnostics);
    } else {
      hindered.push_back(fits.error().message);
    }
  }
  if (!data.bright.empty()) {
    const auto found = photometry_of(data.bright, has_second_order);
    if (found)
      out.photometry = *found;
    else
      hindered.push_back(found.error().message);
  }
  if (!out.calibration && !out.photometry)
    return fail(ErrorCode::BadInput, hindered.front());
  for (const std::string &words : hindered)
    diagnostics.warn(words);
  return {};
}

/// The table of channels, row by row.
class ChannelColumns {
public:
  Result<void> add(const std::string &name, const std::vector<PolarizerCount> &all,
                   Diagnostics &diagnostics);
  Table table() &&;

private:
  std::vector<std::string> names_;
  std::vector<std::int64_t> angles_, dof_;
  std::array<std::vector<double>, 11> numbers_;
};

Result<void> ChannelColumns::add(const std::string &name, const std::vector<PolarizerCount> &all,
                                 Diagnostics &diagnostics) {
  std::vector<double> angles, counts;
  double variance = 0;
  for (const PolarizerCount &one : all)
    if (one.channel == name) {
      angles.push_back(one.angle_rad);
      counts.push_back(one.counts);
      variance += one.variance;
    }
  const auto n = static_cast<double>(counts.size());
  // Over even angles the variances of the counts act as their mean.
  auto found = calibrate_channel(angles, counts, variance / n);
  if (!found)
    return fail(found.error().code,
                name.empty()
                    ? found.error().message
                    : fmt::format("channel \"{}\": {}", printable(name), found.error().message));
  ChannelAnalyser analyser = analyser_of(*found);
  if (constexpr double seen = 3; !(analyser.efficiency > seen * analyser.efficiency_sd)) {
    analyser.angle_rad = analyser.angle_sd = std::nan("");
    diagnostics.warn(fmt::format("{}efficiency {:.2g}, error {:.2g}: the polarizer makes no "
                                 "difference, so that no angle is told. Did it turn, and is there "
                                 "an analyser?",
                                 name.empty() ? "" : "channel \"" + printable(name) + "\": ",
                                 analyser.efficiency, analyser.efficiency_sd));
  }
  double chi2 = 0;
  for (std::size_t k = 0, at = 0; k < all.size(); ++k)
    if (all[k].channel == name) {
      const double twice = 2 * angles[at];
      const double missed = counts[at++] - found->row[0] - found->row[1] * std::cos(twice) -
                            found->row[2] * std::sin(twice);
      chi2 += missed * missed / all[k].variance;
    }
  const int dof = static_cast<int>(counts.size()) - 3;
  if (constexpr double chance = 1e-3; dof > 0 && boost::math::gamma_q(dof / 2., chi2 / 2) < chance)
    diagnostics.warn(fmt::format("{}chi2 = {:.3g} of {} degrees of freedom: the counts do not "
                                 "follow a polarizer's cosine. Did the lamp change, or is an angle "
                                 "wrong?",
                                 name.empty() ? "" : "channel \"" + printable(name) + "\": ", chi2,
                                 dof));
  constexpr double degree = pi / 180;
  names_.push_back(name);
  angles_.push_back(static_cast<std::int64_t>(counts.size()));
  dof_.push_back(dof);
  const double values[] = {found->row[0],
                           found->row[1],
                           found->row[2],
                           found->sd[0],
                           found->sd[1],
                           found->sd[2],
                           analyser.efficiency,
                           analyser.efficiency_sd,
                           analyser.angle_rad / degree,
                           analyser.angle_sd / degree,
                           chi2};
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    numbers_[k].push_back(values[k]);
  return {};
}

Table ChannelColumns::table() && {
  constexpr std::array texts{
      std::array{"w0", "electron", "of unpolarized light as bright as the lamp"},
      std::array{"w1", "electron", "counts = w0 + w1 cos 2a + w2 sin 2a at an angle a"},
      std::array{"w2", "electron", "the same"},
      std::array{"w0_err", "electron", "standard deviation"},
      std::array{"w1_err", "electron", "standard deviation"},
      std::array{"w2_err", "electron", "standard deviation"},
      std::array{"efficiency", "", "of the analyser, the polarizer's own in it"},
      std::array{"efficiency_err", "", "standard deviation"},
      std::array{"analyser_deg", "deg", "from where the polarizer's circle begins"},
      std::array{"analyser_err", "deg", "standard deviation"},
      std::array{"chi2", "", "of the fit"}};
  Table out;
  out.add("channel", "", "as in the file", std::move(names_));
  out.add("n_angle", "", "angles of the polarizer", std::move(angles_));
  for (std::size_t k = 0; k < texts.size(); ++k)
    out.add(texts[k][0], texts[k][1], texts[k][2], std::move(numbers_[k]));
  out.add("dof", "", "degrees of freedom", std::move(dof_));
  note_conventions(out);
  return out;
}

} // namespace

Result<CalibrationFile> calibrate(const CountsFile &counts,
                                  const std::vector<StandardStar> &standards, bool has_second_order,
                                  Diagnostics &diagnostics) {
  CalibrationFile out;
  out.band = counts.rows.front().band;
  out.instrument = note_of(counts, "instrument");
  out.pol_frame = note_of(counts, "pol_frame");
  out.made_utc = to_iso(counts.rows.back().time);
  const bool has_angles =
      std::ranges::any_of(standards, [](const StandardStar &star) { return star.p > 0; });
  if (has_angles && !out.pol_frame.empty() && out.pol_frame != "equatorial")
    return fail(ErrorCode::BadInput, "standards have position angles from north: counts in the "
                                     "frame \"" +
                                         out.pol_frame + "\" cannot be held against them");
  for (const CountRow &row : counts.rows)
    if (row.band != out.band)
      return fail(ErrorCode::BadInput,
                  "two bands, " + out.band + " and " + row.band + ": calibrate each by itself");
  UMOV_ASSIGN(table, reduce(counts, {}, {}, diagnostics));
  const Measured data = measured(table, standards);
  if (data.faint > 0)
    diagnostics.warn(fmt::format("{} of standards left out of photometry: fainter than three times "
                                 "their error",
                                 counted(data.faint, "set")));
  if (data.polarized.empty() && data.bright.empty())
    return fail(ErrorCode::BadInput, no_standard(table, standards));
  if (has_second_order && data.bright.empty())
    return fail(ErrorCode::BadInput, "k'' was asked for, and no standard of the counts has a mag");
  UMOV_TRY(fit(data, has_second_order, out, diagnostics));
  for (const Warning &one : diagnostics.warnings())
    out.warnings.push_back(one.message);
  return out;
}

Result<Table> calibrate_channels(const std::vector<PolarizerCount> &counts,
                                 Diagnostics &diagnostics) {
  std::vector<std::string> names;
  for (const PolarizerCount &one : counts)
    if (std::ranges::find(names, one.channel) == names.end())
      names.push_back(one.channel);
  ChannelColumns out;
  for (const std::string &name : names)
    UMOV_TRY(out.add(name, counts, diagnostics));
  return std::move(out).table();
}

Result<void> check_calibration(const CalibrationFile &file, const CountsFile &counts,
                               const std::string &path, Diagnostics &diagnostics) {
  const CountRow &first = counts.rows.front();
  const auto strange =
      std::ranges::find_if(counts.rows, [&](const CountRow &row) { return row.band != file.band; });
  const CountRow &of_band = strange == counts.rows.end() ? first : *strange;
  for (const auto &[what, own, other] :
       {std::tuple{"instrument", file.instrument, note_of(counts, "instrument")},
        {"band", file.band, of_band.band}})
    if (!own.empty() && !other.empty() && own != other)
      return fail(ErrorCode::BadInput,
                  fmt::format("this calibration is of the {} \"{}\", the counts are of \"{}\"; "
                              "calibrate that one",
                              what, own, other),
                  {path});
  if (file.calibration && !file.pol_frame.empty() && file.pol_frame != "equatorial")
    return fail(
        ErrorCode::BadInput,
        fmt::format("this calibration has its angles in the frame \"{}\"; those of standards "
                    "are from north: \"equatorial\" was expected. Calibrate again",
                    file.pol_frame),
        {path});
  constexpr double old_days = 30;
  if (const auto made = utc_from_iso(file.made_utc))
    if (const double days = seconds_between(first.time, *made) / 86400; std::abs(days) > old_days)
      diagnostics.warn(fmt::format("the calibration is {:.0f} days {} than the counts",
                                   std::abs(days), days > 0 ? "older" : "younger"),
                       {path});
  return {};
}

} // namespace umov::jobs
