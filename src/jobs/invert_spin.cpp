#include "jobs/curve_limits.h"
#include "jobs/invert_between.h"
#include "jobs/invert_light.h"
#include "jobs/invert_page.h"
#include "jobs/invert_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <umov/inverse/direction_table.h>
#include <umov/inverse/spin_search.h>
#include <umov/lightcurve/periodogram.h>

namespace umov::jobs {
namespace {

/// The period of the band with most rows, as the light shows it (synodic).
double shown_period(const ObservedCurve &curve) {
  std::vector<double> seconds, magnitudes, best_seconds, best_magnitudes;
  for (std::size_t b = 0; b < curve.bands.size(); ++b) {
    seconds.clear();
    magnitudes.clear();
    for (const ObservedSample &s : curve.samples)
      if (s.band == b && s.i > 0) {
        seconds.push_back(curve.epochs[s.epoch].seconds);
        magnitudes.push_back(-2.5 * std::log10(s.i));
      }
    if (seconds.size() > best_seconds.size()) {
      best_seconds = seconds;
      best_magnitudes = magnitudes;
    }
  }
  return periodogram(best_seconds, best_magnitudes).best_s;
}

/// Periods to be tried: a body that looks alike from two or four sides shows a part of its own.
Result<std::vector<double>> periods_to_try(const ObservedCurve &curve, const SpinOptions &spin) {
  double base = spin.period_s;
  if (!(base > 0))
    base = shown_period(curve);
  if (!(base > 0))
    return fail(ErrorCode::BadInput,
                "the curve tells no period: 12 brightnesses that change are needed, over more than "
                "a turn. Give one with --period");
  const double span = curve.epochs.back().seconds;
  if (!(span > 0))
    return fail(
        ErrorCode::BadInput,
        "all is of one time, which tells nothing of a turn, whatever its period: umov invert "
        "pose asks for the attitude");
  std::vector<double> out{base};
  if (spin.has_aliases)
    for (const double times : {2.0, 0.5, 4.0})
      if (base * times < 2 * span)
        out.push_back(base * times);
  return out;
}

std::optional<Vec3<Body>> axis_of(char name) {
  switch (name) {
  case 'x':
    return Vec3<Body>{1, 0, 0};
  case 'y':
    return Vec3<Body>{0, 1, 0};
  case 'z':
    return Vec3<Body>{0, 0, 1};
  default:
    return std::nullopt;
  }
}

/// periods.ecsv.
Table periods_table(const SpinAnswer &answer, const std::vector<double> &tried) {
  std::vector<double> period, error, weight, alias;
  for (const SpinPeriod &p : answer.periods) {
    period.push_back(p.period_s);
    error.push_back(p.period_err_s);
    weight.push_back(p.weight);
    alias.push_back(tried[p.tried] / tried.front());
  }
  Table out;
  out.add("period_s", "s", "of the spin among the stars", std::move(period));
  out.add("period_err", "s", "standard deviation", std::move(error));
  out.add("weight", "", "share of the posterior", std::move(weight));
  out.add("alias", "", "in parts of the period that was given or shown", std::move(alias));
  note_conventions(out);
  return out;
}

/// What makes a search for a spin quick: light of all pairs of directions, once.
Result<void> put_coarse_light(const PoseLighting &light, const ObservedCurve &curve,
                              unsigned threads, SpinRequest &out) {
  constexpr std::size_t cells = 36; // 5 deg; 1.9 million pairs
  auto table = DirectionTable::make(light, cells, curve.epochs.front().sun_radius_rad, threads);
  if (!table)
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  UMOV_ASSIGN(half, table->halved());
  out.coarsest = DirectionTable::lighting(std::move(half), threads);
  out.coarse = DirectionTable::lighting(std::move(table), threads);
  return {};
}

/// `is_doubted`: the period itself, not the attitude alone.
std::string spin_words(const SpinAnswer &answer, Verdict verdict, bool is_doubted) {
  if (verdict == Verdict::NoFit)
    return "no period explains the data\n";
  std::string out;
  if (is_doubted)
    out = "the period is not known; of the spins that were tried, ";
  for (const SpinPeriod &p : answer.periods)
    out += fmt::format("period {:.6g} +- {:.2g} s with {:.3g} % of the probability\n", p.period_s,
                       p.period_err_s, 100 * p.weight);
  return out;
}

/// Chi-square of the best attitude of a body that does not turn, to the errors of the one that
/// does.
Result<double> chi2_at_rest(const SearchModels &models, const CurveErrors &errors,
                            SearchOptions options) {
  constexpr std::size_t enough = 20'000; // as in the search for spins, basins are wide
  options.grid = std::min(options.grid, enough);
  options.errors = errors;
  options.largest_floor = 0;
  return least_chi2_at_rest(models, options);
}

/// What makes a period less than an answer, however narrow its peak; false if nothing does.
bool doubt_period(const SpinAnswer &answer, double chi2_at_rest, const SpinOptions &asked,
                  const ObservedCurve &curve, const CurveErrors &errors, Judgement &judgement) {
  std::vector<std::string> doubts;
  if (!(asked.period_s > 0) && shows_no_turn(curve, errors))
    doubts.emplace_back("a parabola of the time explains the brightness: no turn shows in it, and "
                        "periods that were read from it are some of many; --period gives one");
  constexpr double told = 25; // chi-square: three unknowns more, and periods to choose from
  if (chi2_at_rest < answer.pose.chi2 + told)
    doubts.push_back(fmt::format("a body that does not turn explains the data as well or better "
                                 "(chi-square {:.4g}): umov invert pose asks for its attitude",
                                 chi2_at_rest));
  const double span = curve.epochs.back().seconds;
  constexpr double near = 1.2; // to a period that was given: then it need not be seen
  if (!answer.periods.empty() &&
      answer.periods.front().period_s > std::max(span, near * asked.period_s))
    doubts.push_back(fmt::format("less than a turn lies within the {:.4g} s observed: longer or "
                                 "further passes tell the period",
                                 span));
  if (!doubts.empty() && judgement.verdict != Verdict::NoFit)
    judgement.verdict = Verdict::Undetermined;
  const bool is_doubted = !doubts.empty();
  std::ranges::move(doubts, std::back_inserter(judgement.notes));
  return is_doubted;
}

} // namespace

Result<Inversion> invert_spin(const Scenario &scenario, const InvertRequest &request,
                              const SpinOptions &spin, const JobOptions &options,
                              const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_ASSIGN(ready, prepare(scenario, request, options, diagnostics, monitor.cancel));
  UMOV_TRY(take_coarse(ready, scenario, request, options, monitor.cancel));
  take_apart(ready, request, options, diagnostics, monitor.cancel);
  const ObservedCurve &curve = ready.observed.curve;
  const auto light = lighting_of(ready.light, options.threads, monitor);
  UMOV_ASSIGN(periods, periods_to_try(curve, spin));
  monitor.advance("table of light", 0, 1);
  SpinRequest asked;
  asked.periods_s = periods;
  asked.axis = axis_of(spin.axis);
  asked.parts = parts_of(ready);
  UMOV_TRY(put_coarse_light(quick_lighting(ready, options.threads, monitor), curve, options.threads,
                            asked));
  asked.first = first_lighting(ready, options.threads, monitor);
  const auto searched = searched_lighting(ready, options.threads, monitor);
  UMOV_ASSIGN(answer, search_spin(curve, searched, ready.observed.column, asked,
                                  search_options(scenario, request, options, monitor)));
  const auto symmetries = find_symmetries(light, scenario.seed);
  keep_masks(ready);
  const CurveModel model(curve, searched, ready.observed.column, asked.parts);
  Judgement judgement = judge(answer.pose, model, model, request.errors, symmetries);
  UMOV_TRY(judge_direct_light(scenario, request, ready, curve, answer.pose, options, monitor,
                              judgement));
  const CurveModel coarse(curve, asked.coarse, ready.observed.column);
  const CurveModel first(curve, asked.first, ready.observed.column, asked.parts);
  UMOV_ASSIGN(at_rest, chi2_at_rest({model, first, coarse}, answer.pose.errors,
                                    search_options(scenario, request, options, monitor)));
  constexpr double sure = 0.95;
  const bool is_doubted = doubt_period(answer, at_rest, spin, curve, request.errors, judgement) ||
                          (judgement.verdict == Verdict::Undetermined &&
                           (answer.periods.empty() || answer.periods.front().weight < sure));
  Inversion out;
  out.verdict = judgement.verdict;
  out.summary =
      spin_words(answer, judgement.verdict, is_doubted) + summary_of(answer.pose, judgement);
  out.json = json_of("spin", answer.pose, judgement, symmetries);
  out.tables = {{"modes", modes_table(answer.pose, true)},
                {"periods", periods_table(answer, periods)},
                {"set95", set_table(answer.pose)},
                {"samples", samples_table(answer.pose, true)},
                {"fit", fit_table(ready.observed, model, answer.pose)},
                {"contributions", contributions_table(judgement.contributions)}};
  note_start(out.tables.front().table, body_words(ready.light.model().scene()), ready.observed,
             answer.pose, judgement);
  out.page = inversion_page("Which spin: " + scenario.title, out.tables[4].table, answer.pose,
                            out.verdict, judgement.contributions, out.summary);
  out.inputs = ready.observed.inputs;
  out.seed = scenario.seed;
  out.light = light_used(ready, scenario, diagnostics);
  return out;
}

} // namespace umov::jobs
