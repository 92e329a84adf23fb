#include <umov/jobs/reduce.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <span>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/reduction/polarization.h>
#include <umov/reduction/sequence.h>

namespace umov::jobs {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Rows = std::span<const CountRow>;

/// Rows of one object, band and set.
struct Set {
  std::vector<CountRow> rows; ///< without saturated ones
  bool is_cut = false;        ///< some channel was saturated
};

/// What a set becomes.
struct Reduced {
  CountRow first;
  Epoch<Utc> time{};
  StokesFit fit;
  StokesFractions fractions;
  std::string flags;
  double sky_share = nan;
  bool is_solved = false;
};

std::vector<Set> sets_of(const CountsFile &file) {
  std::vector<Set> out;
  std::map<std::tuple<std::string, std::string, std::int64_t>, std::size_t> index;
  for (const CountRow &row : file.rows) {
    const auto [at, is_new] = index.try_emplace({row.name, row.band, row.set}, out.size());
    if (is_new)
      out.emplace_back();
    Set &set = out[at->second];
    if (row.is_saturated)
      set.is_cut = true;
    else
      set.rows.push_back(row);
  }
  std::erase_if(out, [](const Set &set) { return set.rows.empty(); });
  return out;
}

ChannelDatum datum_of(const CountRow &row) {
  return {row.counts, row.sky, row.var_read + row.sky_err * row.sky_err, row.excess2, row.row};
}

std::vector<ChannelDatum> data_of(Rows rows) {
  std::vector<ChannelDatum> out;
  for (const CountRow &row : rows)
    out.push_back(datum_of(row));
  return out;
}

/// 4 where some channel answers to V, 1 where none answers to Q or U, else 3.
std::size_t parameters_of(const CountsFile &file) {
  double linear = 0, circular = 0;
  for (const CountRow &row : file.rows) {
    linear = std::max(linear, std::hypot(row.row[1], row.row[2]) / row.row[0]);
    circular = std::max(circular, std::abs(row.row[3]) / row.row[0]);
  }
  // Half-wave plates that are not perfect answer to V a little: not enough to solve for it.
  if (const auto note = file.notes.find("parameters"); note != file.notes.end())
    if (const auto told = parse_number(note->second); told && *told >= 1 && *told <= 4)
      return *told < 2 ? 1u : static_cast<std::size_t>(std::max(3.0, *told));
  constexpr double answers = 0.2;
  return circular > answers ? 4 : linear > answers ? 3 : 1;
}

/// Light flickers from exposure to exposure, alike in all channels of one pupil.
void add_scintillation(std::vector<CommonError> &out, Rows rows, const StokesFit &fit,
                       bool has_separate_pupils) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const bool is_first = k == 0 || has_separate_pupils || rows[k].exposure != rows[k - 1].exposure;
    if (!is_first || !(rows[k].scintillation > 0))
      continue;
    CommonError one{std::vector<double>(rows.size(), 0), rows[k].scintillation};
    const std::size_t behind = has_separate_pupils ? k + 1 : rows.size();
    for (std::size_t j = k; j < behind && rows[j].exposure == rows[k].exposure; ++j)
      for (std::size_t p = 0; p < 4; ++p)
        one.effect[j] += rows[j].row[p] * fit.stokes[p];
    out.push_back(std::move(one));
  }
}

Reduced solve(const Set &set, std::size_t parameters, bool has_separate_pupils,
              const ReduceOptions &options) {
  Reduced out;
  out.first = set.rows.front();
  out.time =
      plus_seconds(out.first.time, seconds_between(set.rows.back().time, out.first.time) / 2);
  if (set.is_cut)
    out.flags = "saturated";
  const auto data = data_of(set.rows);
  auto fit = fit_stokes(data, parameters);
  if (!fit) {
    out.flags += out.flags.empty() ? "incomplete" : " incomplete";
    return out;
  }
  std::vector<CommonError> common =
      common_errors(options.priors, data, *fit, out.first.x_axis_pa_deg * pi / 180);
  add_scintillation(common, set.rows, *fit, has_separate_pupils);
  if (!common.empty())
    fit = fit_stokes(data, parameters, common);
  if (!fit || !(fit->covariance[0][0] > 0) || !std::isfinite(fit->covariance[0][0])) {
    out.flags += out.flags.empty() ? "incomplete" : " incomplete";
    return out;
  }
  out.fit = *fit;
  out.fractions = fractions_of(*fit);
  double sky = 0, counts = 0;
  for (const ChannelDatum &d : data)
    sky += d.sky, counts += d.counts;
  out.sky_share = counts - sky > 0 ? sky / (counts - sky) : nan;
  const double error = std::sqrt(fit->covariance[0][0]);
  if (!(fit->stokes[0] > 3 * error)) // nothing was seen: fractions of it say nothing
    out.flags += out.flags.empty() ? "faint" : " faint";
  else
    out.is_solved = true;
  return out;
}

/// Takes the instrument's own polarization and angle out of q, u.
void calibrate(Reduced &r, const PolarimeterCalibration &c) {
  auto &f = r.fractions;
  const double axis = r.first.x_axis_pa_deg * pi / 180;
  const std::complex<double> sky(f.value[0], f.value[1]);
  const double variance = (f.covariance[0][0] + f.covariance[1][1]) / 2;
  const CalibratedTarget target = apply(c, sky * std::polar(1.0, -2 * axis), axis, variance);
  const double factor = std::norm(c.factor);
  f.value[0] = target.value.real();
  f.value[1] = target.value.imag();
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      f.covariance[a][b] = f.covariance[a][b] / factor + (a == b ? target.common_variance : 0);
}

/// Columns of the result.
class StokesTableWriter {
public:
  StokesTableWriter(const CountsFile &file, std::size_t parameters)
      : file_(file), parameters_(parameters) {}

  void add(const Reduced &r) {
    time_.push_back(to_iso(r.time));
    name_.push_back(r.first.name);
    band_.push_back(r.first.band);
    system_.push_back("AB");
    flags_.push_back(r.flags);
    set_.push_back(r.first.set);
    const auto v = numbers(r);
    for (std::size_t k = 0; k < v.size(); ++k)
      columns_[k].push_back(v[k]);
  }

  Table table() && {
    Table out;
    out.add("time_utc", "", "UTC, middle of the set", std::move(time_));
    out.add("set_id", "", "as in the counts", std::move(set_));
    out.add("name", "", "object", std::move(name_));
    out.add("band", "", "band", std::move(band_));
    const char *const names[][3] = {
        {"I_obs", "W / (m2 nm)", "irradiance above the air, from the counts"},
        {"I_err", "W / (m2 nm)", "standard deviation"},
        {"mag", "mag(AB)", "of I_obs"},
        {"q", "", "Q/I in the sky frame"},
        {"u", "", "U/I in the sky frame"},
        {"v", "", "V/I"},
        {"cov_qq", "", "variance of q"},
        {"cov_uu", "", "variance of u"},
        {"cov_qu", "", "covariance of q and u"},
        {"cov_vv", "", "variance of v"},
        {"p", "", "degree of linear polarization, biased"},
        {"p_debiased", "", "Plaszczynski et al. 2014"},
        {"p_lo", "", "95 % interval, Feldman & Cousins 1998"},
        {"p_hi", "", "its upper end, a limit where p_lo is 0"},
        {"pa", "deg", "position angle of polarization, [0, 180)"},
        {"pa_err", "deg", "68.27 % half width"},
        {"q_scat", "", "Q/I, + perpendicular to the scattering plane"},
        {"u_scat", "", "U/I in the scattering frame"},
        {"chi2", "", "of the fit"},
        {"dof", "", "degrees of freedom"},
        {"sky_share", "", "sky over object in the apertures"},
        {"phase_angle", "deg", "Sun-object-observer"}};
    for (std::size_t k = 0; k < std::size(names); ++k) {
      out.add(names[k][0], names[k][1], names[k][2], std::move(columns_[k]));
      if (k == 2)
        out.add("mag_system", "", "system of mag", std::move(system_));
    }
    out.add("flags", "", "saturated, incomplete, faint", std::move(flags_));
    return out;
  }

private:
  [[nodiscard]] double zero_flux(const std::string &band) const {
    const auto found = file_.notes.find("zero_flux " + band);
    const auto value = found == file_.notes.end() ? std::nullopt : parse_number(found->second);
    return value.value_or(nan);
  }

  [[nodiscard]] std::array<double, 22> numbers(const Reduced &r) const {
    std::array<double, 22> out;
    out.fill(nan);
    const bool was_fitted = r.fit.covariance[0][0] > 0;
    if (was_fitted) {
      out[0] = r.fit.stokes[0];
      out[1] = std::sqrt(r.fit.covariance[0][0]);
      out[2] = out[0] > 0 ? -2.5 * std::log10(out[0] / zero_flux(r.first.band)) : nan;
      out[18] = r.fit.chi2;
      out[19] = r.fit.dof;
    }
    out[20] = r.sky_share;
    out[21] = r.first.phase_angle_deg;
    if (!r.is_solved || parameters_ < 3)
      return out;
    const auto &f = r.fractions;
    const auto &c = f.covariance;
    const double q = f.value[0], u = f.value[1];
    out[3] = q;
    out[4] = u;
    out[6] = c[0][0];
    out[7] = c[1][1];
    out[8] = c[0][1];
    if (parameters_ == 4) {
      out[5] = f.value[2];
      out[9] = c[2][2];
    }
    const auto p = polarization_of(q, u, {{{c[0][0], c[0][1]}, {c[1][0], c[1][1]}}});
    const double sd = std::sqrt((c[0][0] + c[1][1]) / 2);
    const auto interval = degree_interval(p.p / sd);
    out[10] = p.p;
    out[11] = p.debiased;
    out[12] = interval.low * sd;
    out[13] = interval.high * sd;
    out[14] = p.angle_rad * 180 / pi;
    out[15] = p.angle_sd_rad * 180 / pi;
    const double twice = 2 * r.first.pa_scat_deg * pi / 180;
    out[16] = q * std::cos(twice) + u * std::sin(twice);
    out[17] = u * std::cos(twice) - q * std::sin(twice);
    return out;
  }

  const CountsFile &file_;
  std::size_t parameters_;
  std::vector<std::string> time_, name_, band_, system_, flags_;
  std::vector<std::int64_t> set_;
  std::array<std::vector<double>, 22> columns_;
};

/// A change of brightness from exposure to exposure looks like polarization where analysers follow
/// each other: told in figures.
void warn_of_drift(const std::vector<Set> &sets, const std::vector<Reduced> &reduced,
                   Diagnostics &diagnostics) {
  std::vector<double> drifts, errors;
  for (std::size_t k = 1; k < reduced.size(); ++k) {
    const Reduced &a = reduced[k - 1], &b = reduced[k];
    const auto steps =
        static_cast<double>(sets[k].rows.back().exposure - sets[k].rows.front().exposure + 1);
    const bool is_sequence = steps >= 3 && sets[k].rows.size() == static_cast<std::size_t>(steps);
    if (!is_sequence || !a.is_solved || !b.is_solved || a.first.band != b.first.band ||
        a.first.name != b.first.name)
      continue;
    drifts.push_back(std::abs(b.fit.stokes[0] / a.fit.stokes[0] - 1) / steps);
    errors.push_back(std::sqrt(b.fractions.covariance[0][0]));
  }
  if (drifts.empty())
    return;
  const auto middle = static_cast<std::ptrdiff_t>(drifts.size() / 2);
  std::nth_element(drifts.begin(), drifts.begin() + middle, drifts.end());
  std::nth_element(errors.begin(), errors.begin() + middle, errors.end());
  const double drift = drifts[static_cast<std::size_t>(middle)];
  const double error = errors[static_cast<std::size_t>(middle)];
  if (std::sqrt(2.0) * drift > error)
    diagnostics.warn(fmt::format(
        "brightness changes by {:.2g} from exposure to exposure while the analyser turns: that "
        "alone looks like p = {:.2g}, more than its error {:.2g}. Reduce with --model "
        "fourier:PERIOD, or take the analysers at once",
        drift, std::sqrt(2.0) * drift, error));
}

Result<std::vector<Reduced>> over_time(const CountsFile &file, std::size_t parameters,
                                       const ReduceOptions &options) {
  std::map<std::pair<std::string, std::string>, std::vector<CountRow>> groups;
  for (const CountRow &row : file.rows)
    if (!row.is_saturated)
      groups[{row.name, row.band}].push_back(row);
  std::vector<Reduced> out;
  for (const auto &[key, rows] : groups) {
    std::vector<TimedDatum> data;
    for (const CountRow &row : rows) {
      ChannelDatum datum = datum_of(row);
      const double star = std::max(0.0, datum.counts - datum.sky);
      datum.fixed_variance += row.scintillation * row.scintillation * star * star;
      data.push_back({seconds_between(row.time, rows.front().time), datum});
    }
    UMOV_ASSIGN(fit, fit_sequence(data, options.period_s, options.harmonics,
                                  std::max<std::size_t>(3, parameters)));
    Reduced one;
    one.first = rows.front();
    one.time = plus_seconds(one.first.time, data.back().time_s / 2);
    one.fractions = fit.fractions;
    one.fit.stokes[0] = fit.series[0];
    one.fit.covariance[0][0] = fit.mean_variance;
    one.fit.chi2 = fit.chi2;
    one.fit.dof = fit.dof;
    one.is_solved = true;
    out.push_back(std::move(one));
  }
  return out;
}

void note(Table &table, const CountsFile &file) {
  note_conventions(table);
  for (const char *key : {"pol_frame", "instrument", "polarimeter"})
    if (const auto found = file.notes.find(key); found != file.notes.end())
      table.note(key, found->second);
  table.note("POLCCONV", "IAU");
}

} // namespace

Result<Table> reduce(const CountsFile &file, const ReduceOptions &options, const Monitor &monitor,
                     Diagnostics &diagnostics) {
  const std::size_t parameters = parameters_of(file);
  std::vector<Reduced> reduced;
  if (options.period_s > 0) {
    UMOV_ASSIGN(found, over_time(file, parameters, options));
    reduced = std::move(found);
  } else {
    const std::vector<Set> sets = sets_of(file);
    if (sets.empty())
      return fail(ErrorCode::Physics, "every channel is saturated: there is nothing to reduce");
    reduced.resize(sets.size());
    const auto pupils = file.notes.find("pupils");
    const bool has_separate_pupils = pupils != file.notes.end() && pupils->second == "separate";
    parallel_for(sets.size(), options.threads, [&](std::size_t k) {
      reduced[k] = solve(sets[k], parameters, has_separate_pupils, options);
    });
    const auto solved =
        std::ranges::count_if(reduced, [](const Reduced &r) { return r.fit.covariance[0][0] > 0; });
    if (solved == 0) {
      const auto first = fit_stokes(data_of(sets.front().rows), parameters);
      return first ? fail(ErrorCode::Physics,
                          "no set of counts tells a Stokes parameter with a finite error: are "
                          "counts, sky and w0 to w3 in the units that umov observe writes?")
                   : tl::unexpected(first.error());
    }
    warn_of_drift(sets, reduced, diagnostics);
    monitor.advance("sets", sets.size(), sets.size());
  }
  std::size_t outside = 0;
  for (Reduced &r : reduced) {
    if (options.calibration && r.is_solved)
      calibrate(r, *options.calibration);
    const double q = r.fractions.value[0], sd = std::sqrt(r.fractions.covariance[0][0]);
    outside += r.is_solved && std::abs(q) > 1 + 5 * sd ? 1u : 0u;
  }
  if (outside > 0)
    diagnostics.warn(fmt::format("{} with |q| above 1 by more than five standard deviations: is "
                                 "the sky or the gain right?",
                                 counted(outside, "set")));
  StokesTableWriter writer(file, parameters);
  for (const Reduced &r : reduced)
    writer.add(r);
  Table out = std::move(writer).table();
  note(out, file);
  return out;
}

} // namespace umov::jobs
