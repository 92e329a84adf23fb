#include "jobs/count_rows.h"
#include "jobs/prepared_counts.h"
#include "jobs/reduce_series.h"
#include "jobs/result_folder.h"
#include <umov/core/median.h>
#include <umov/reduction/open_air.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/reduction/sequence.h>
#include <utility>

namespace umov::jobs {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Rows of one object, band and set.
struct Set {
  std::vector<CountRow> rows; ///< without saturated ones
  bool is_cut = false;        ///< some channel was saturated
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

/// Errors of gains act on the light that came through: a fifth of cloud times a twentieth of gain
/// is a hundredth, and half of that in q. So rows are those behind the air t of their exposure, the
/// most likely one for the model m; its logarithm is about its mean as before, which m t (ln t -
/// mean) brings to the counts.
std::vector<ChannelDatum> behind(const OpenAir &air, std::span<const double> transparencies,
                                 std::vector<ChannelDatum> data,
                                 const std::array<double, 4> &stokes) {
  for (std::size_t k = 0; k < data.size(); ++k) {
    const double t = transparencies[k];
    for (std::size_t p = 0; p < 4; ++p)
      data[k].counts += data[k].row[p] * stokes[p] * t * (std::log(t) - air.mean_logarithm(k));
    data[k].row = data[k].row * t;
  }
  return data;
}

/// q and u of the plate's first half turn against those of its second, which should be the same.
void put_null_test(Rows rows, const std::vector<ChannelDatum> &data, std::size_t parameters,
                   Reduced &out) {
  if (parameters < 3)
    return;
  std::array<std::vector<ChannelDatum>, 2> halves;
  for (std::size_t k = 0; k < rows.size(); ++k)
    halves[std::fmod(std::fmod(rows[k].plate_deg, 180) + 180, 180) < 90 ? 0 : 1].push_back(data[k]);
  if (halves[0].size() < parameters || halves[1].size() < parameters)
    return;
  const auto first = fit_stokes(halves[0], parameters), second = fit_stokes(halves[1], parameters);
  if (!first || !second || !(first->stokes[0] > 0 && second->stokes[0] > 0))
    return;
  const auto a = fractions_of(*first), b = fractions_of(*second);
  for (std::size_t k = 0; k < 2; ++k)
    out.null[k] = (a.value[k] - b.value[k]) / 2;
}

/// A fit of a set again, with what moves its channels together.
Result<StokesFit> with_common_errors(const Set &set, const std::vector<ChannelDatum> &data,
                                     Result<StokesFit> fit, std::size_t parameters,
                                     bool has_separate_pupils, const ReduceOptions &options) {
  const auto gains = gains_of(set.rows);
  std::vector<AirPlace> places;
  for (const CountRow &row : set.rows)
    places.push_back(
        {seconds_between(row.time, set.rows.front().time), row.exposure, row.scintillation});
  const OpenAir air(places, has_separate_pupils,
                    {options.transparency_sd, options.transparency_time_s});
  std::vector<double> transparencies;
  // What is common moves counts as the model has them: under cloud, as that of a fit which knows
  // it.
  const int passes = options.transparency_sd > 0 ? 5 : 1;
  for (int pass = 0; pass < passes && fit; ++pass) {
    if (pass > 0)
      transparencies = air.transparencies(data, fit->stokes);
    const auto seen = pass > 0 ? behind(air, transparencies, data, fit->stokes) : data;
    std::vector<ModelledDatum> model;
    for (std::size_t k = 0; k < data.size(); ++k)
      model.push_back(modelled(set.rows[k], seen[k], fit->stokes, gains[k]));
    const auto common = common_errors(options.priors, model);
    if (!common.empty() || !air.is_known())
      fit = fit_stokes(seen, parameters, common, air, fit->stokes);
  }
  return fit;
}

Reduced solve(const Set &set, std::size_t parameters, bool has_separate_pupils,
              const ReduceOptions &options) {
  Reduced out;
  out.middle = middle_of(set.rows);
  if (set.is_cut)
    out.flags = "saturated";
  const auto data = data_of(set.rows, options);
  auto fit = fit_stokes(data, parameters);
  if (!fit) {
    add_flag(out.flags, "incomplete");
    return out;
  }
  const StokesFit plain = *fit;
  fit = with_common_errors(set, data, *fit, parameters, has_separate_pupils, options);
  if (!fit || !(fit->covariance[0][0] > 0) || !std::isfinite(fit->covariance[0][0])) {
    add_flag(out.flags, "incomplete");
    return out;
  }
  out.fit = *fit;
  out.fractions = fractions_of(*fit);
  put_null_test(set.rows, data, parameters, out);
  double sky = 0, counts = 0;
  for (const ChannelDatum &d : data)
    sky += d.sky, counts += d.counts;
  out.sky_share = counts - sky > 0 ? sky / (counts - sky) : nan;
  // Nothing was seen: fractions of it say nothing. Air that flickers or clouds over, and gains that
  // are not known, hide how bright something is, not that it is there: noise alone judges.
  if (!(plain.stokes[0] > 3 * std::sqrt(plain.covariance[0][0])))
    add_flag(out.flags, "faint");
  else
    out.is_solved = parameters >= 3;
  judge(out, options);
  return out;
}

/// The polarization that brightness looks like which changes by `drift` of itself from exposure to
/// exposure: what the fit makes of unpolarized light that does (docs/theory/observing.md, 6).
double seeming_polarization(Rows rows, const ReduceOptions &options, std::size_t parameters,
                            double intensity, double drift) {
  std::vector<ChannelDatum> data = data_of(rows, options);
  const double middle = static_cast<double>(rows.back().exposure + rows.front().exposure) / 2;
  for (std::size_t k = 0; k < data.size(); ++k)
    data[k].counts =
        data[k].sky +
        data[k].row[0] * intensity * (1 + drift * (static_cast<double>(rows[k].exposure) - middle));
  const auto fit = fit_stokes(data, parameters);
  if (!fit)
    return nan;
  const auto &[q, u, v] = fractions_of(*fit).value;
  return std::hypot(q, u, parameters == 4 ? v : 0);
}

/// A change of brightness from exposure to exposure looks like polarization where analysers follow
/// each other: told in figures, from one set of a band to its next.
void warn_of_drift(const std::vector<Set> &sets, const std::vector<Reduced> &reduced,
                   std::size_t parameters, const ReduceOptions &options, Diagnostics &diagnostics) {
  std::vector<double> drifts, errors, seeming;
  std::map<std::pair<std::string, std::string>, std::size_t> before;
  for (std::size_t k = 0; k < reduced.size(); ++k) {
    const Reduced &b = reduced[k];
    const std::vector<CountRow> &rows = sets[k].rows;
    const auto states = static_cast<double>(rows.back().exposure - rows.front().exposure + 1);
    const bool is_sequence = states >= 3 && rows.size() == static_cast<std::size_t>(states);
    if (!is_sequence || !b.is_solved)
      continue;
    const auto [at, is_first] = before.try_emplace({b.middle.name, b.middle.band}, k);
    const std::size_t last = std::exchange(at->second, k);
    if (is_first)
      continue;
    const auto steps =
        static_cast<double>(rows.front().exposure - sets[last].rows.front().exposure);
    const double drift = std::abs(b.fit.stokes[0] / reduced[last].fit.stokes[0] - 1) / steps;
    const double looks = seeming_polarization(rows, options, parameters, b.fit.stokes[0], drift);
    if (!std::isfinite(looks))
      continue;
    drifts.push_back(drift);
    seeming.push_back(looks);
    const auto &cov = b.fractions.covariance;
    errors.push_back(parameters == 4 ? std::sqrt(cov[0][0] + cov[1][1] + cov[2][2])
                                     : std::sqrt(cov[0][0]));
  }
  if (drifts.empty())
    return;
  const double looks = median_of(seeming), error = median_of(errors);
  if (looks > error)
    diagnostics.warn(fmt::format(
        "brightness changes by {:.2g} from exposure to exposure while the {} turns: that alone "
        "looks like {} {:.2g}, more than its error {:.2g}. Reduce with --model fourier:PERIOD, "
        "or take the analysers at once",
        median_of(drifts), parameters == 4 ? "retarder" : "analyser",
        parameters == 4 ? "q, u, v of" : "p =", looks, error));
}

/// Every set by itself.
Result<std::vector<Reduced>> set_by_set(const CountsFile &file, std::size_t parameters,
                                        bool has_separate_pupils, const ReduceOptions &options,
                                        const Monitor &monitor, Diagnostics &diagnostics) {
  std::vector<Set> sets = sets_of(file);
  const std::size_t full = std::erase_if(sets, [](const Set &set) { return set.rows.empty(); });
  if (sets.empty())
    return all_saturated();
  if (full > 0)
    diagnostics.warn(fmt::format("{} of {} left out: all their channels are saturated",
                                 counted(full, "set"), full + sets.size()));
  std::vector<Reduced> out(sets.size());
  parallel_for(sets.size(), options.threads, [&](std::size_t k) {
    if (!monitor.is_cancelled())
      out[k] = solve(sets[k], parameters, has_separate_pupils, options);
  });
  if (monitor.is_cancelled())
    return fail(ErrorCode::Interrupted, "stopped by the user in the reduction of sets");
  const auto solved =
      std::ranges::count_if(out, [](const Reduced &r) { return r.fit.covariance[0][0] > 0; });
  if (solved == 0) {
    const auto first = fit_stokes(data_of(sets.front().rows, options), parameters);
    return first ? fail(ErrorCode::Physics,
                        "no set of counts tells a Stokes parameter with a finite error: are "
                        "counts, sky and w0 to w3 in the units that umov observe writes?")
                 : tl::unexpected(first.error());
  }
  warn_of_drift(sets, out, parameters, options, diagnostics);
  return out;
}

/// What is strange about many rows.
void warn_of_rows(const std::vector<Reduced> &reduced, Diagnostics &diagnostics) {
  std::size_t outside = 0, misfits = 0, bright = 0;
  for (const Reduced &r : reduced) {
    const double q = r.fractions.value[0], sd = std::sqrt(r.fractions.covariance[0][0]);
    outside += r.is_solved && std::abs(q) > 1 + 5 * sd ? 1u : 0u;
    misfits += r.flags.find("misfit") != std::string::npos ? 1u : 0u;
    constexpr double glaring = 10;
    bright += r.sky_share > glaring ? 1u : 0u;
  }
  if (outside > 0)
    diagnostics.warn(fmt::format("{} with |q| above 1 by more than five standard deviations: is "
                                 "the sky or the gain right?",
                                 counted(outside, "set")));
  if (misfits > 0)
    diagnostics.warn(fmt::format("{} of {} that noise does not explain (flag misfit): gains, sky, "
                                 "cloud (--transparency-sd) or a source that changes within a set; "
                                 "see chi2 and dof",
                                 counted(misfits, "row"), reduced.size()));
  if (bright > 0)
    diagnostics.warn(fmt::format("{} with a sky more than ten times as bright as the object: its "
                                 "polarization lies along q_scat, and one per cent of it is a "
                                 "tenth of the object. Give --sky-sd",
                                 counted(bright, "set")));
}

/// With the time in which a cloud changes, as the header tells it where no option does.
Result<ReduceOptions> with_clouds_of(const CountsFile &file, ReduceOptions options) {
  // Beyond it the mean of a lognormal is made by rows that nobody has seen.
  if (constexpr double most = 1; options.transparency_sd > most)
    return fail(
        ErrorCode::Usage,
        fmt::format("--transparency-sd {:g}: at most {:g} was expected, in parts of what the "
                    "air lets through; 10 % is 0.1",
                    options.transparency_sd, most));
  if (options.transparency_time_s > 0 && !(options.transparency_sd > 0))
    return fail(ErrorCode::Usage, "--transparency-time-s without --transparency-sd: how much the "
                                  "air changes is not told. Give both, or neither");
  const auto told = file.notes.find("cloud_time_s");
  if (!(options.transparency_sd > 0) || options.transparency_time_s > 0 || told == file.notes.end())
    return options;
  options.transparency_time_s = parse_number(told->second).value_or(0); // checked by its reader
  return options;
}

void note(Table &table, const CountsFile &file) {
  note_conventions(table);
  for (const char *key : {"pol_frame", "instrument", "polarimeter", "site", "site_lat_deg",
                          "site_lon_deg", "site_alt_m", "norad"})
    if (const auto found = file.notes.find(key); found != file.notes.end())
      table.note(key, found->second);
}

} // namespace

Result<Table> reduce(const CountsFile &given, const ReduceOptions &asked, const Monitor &monitor,
                     Diagnostics &diagnostics) {
  UMOV_ASSIGN(options, with_clouds_of(given, asked));
  if (options.colour && !options.photometry)
    return fail(ErrorCode::Usage,
                fmt::format("--colour {} without a calibration of brightness: only its colour term "
                            "takes it. Give --calibration with [photometry], or leave it out",
                            *options.colour));
  CountsFile prepared;
  if (is_prepared(options)) {
    UMOV_ASSIGN(made, prepare(given, options));
    prepared = std::move(made);
  }
  const CountsFile &file = is_prepared(options) ? prepared : given;
  if (options.photometry && !options.colour &&
      (options.photometry->colour_term != 0 || options.photometry->second_order != 0))
    diagnostics.warn(fmt::format("the object is taken to have the Sun's colour, B - V = {}; give "
                                 "--colour in the index of the standards",
                                 solar_colour));
  const std::size_t parameters = parameters_of(file);
  const auto pupils = file.notes.find("pupils");
  const bool has_separate_pupils = pupils != file.notes.end() && pupils->second == "separate";
  UMOV_ASSIGN(
      reduced,
      options.period_s > 0 || options.knot_s > 0
          ? reduce_series(file, parameters, has_separate_pupils, options, diagnostics)
          : set_by_set(file, parameters, has_separate_pupils, options, monitor, diagnostics));
  monitor.advance("sets", reduced.size(), reduced.size());
  if (!(options.period_s > 0 || options.knot_s > 0)) // a series has told its own
    warn_of_gaps(file.rows, false, diagnostics);
  warn_of_rows(reduced, diagnostics);
  Table out = stokes_table(file, parameters, reduced);
  note(out, file);
  note_warnings(out, diagnostics);
  return out;
}

} // namespace umov::jobs
