// Which observations would tell alternatives apart.

#include <umov/jobs/plan.h>

#include "jobs/known_light.h"
#include "jobs/observe_plan.h"
#include "jobs/plan_noise.h"
#include "jobs/plan_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <umov/core/text.h>
#include <umov/observation/track.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

constexpr double sure = 0.95;

Result<void> check(const Scenario &scenario, const std::vector<PlanAlternative> &alternatives) {
  UMOV_TRY(check_complete_for_run(scenario));
  if (alternatives.size() < 2)
    return fail(ErrorCode::Usage,
                fmt::format("{} named; two or more are needed to be told apart: give --alternative "
                            "NAME (the scenario as it is), NAME:KEY=VALUE or NAME:FILE.toml",
                            counted(alternatives.size(), "alternative")));
  constexpr std::size_t most = 32;
  if (alternatives.size() > most)
    return fail(ErrorCode::Usage,
                fmt::format("{} alternatives; {} is the limit", alternatives.size(), most));
  for (std::size_t k = 0; k < alternatives.size(); ++k) {
    const PlanAlternative &a = alternatives[k];
    for (std::size_t j = 0; j < k; ++j)
      if (alternatives[j].name == a.name)
        return fail(ErrorCode::Usage,
                    fmt::format("alternative {} stands twice; name each once", printable(a.name)));
    if (a.scenario.objects.size() != 1)
      return fail(ErrorCode::BadInput,
                  fmt::format("alternative {} holds {} objects; one was expected. Keep one "
                              "[[object]].",
                              printable(a.name), a.scenario.objects.size()),
                  {a.scenario.file});
    if (!(a.prior > 0))
      return fail(ErrorCode::Usage,
                  fmt::format("alternative {}: prior {}; more than 0 was expected",
                              printable(a.name), a.prior));
  }
  return {};
}

/// Orbit, observer, time and bands of the plan, object and attitude of the alternative.
Scenario placed(const Scenario &plan, const Scenario &alternative) {
  Scenario out = alternative;
  out.objects.front().orbit = plan.objects.front().orbit;
  out.observer = plan.observer;
  out.time = plan.time;
  out.earth_orientation = plan.earth_orientation;
  out.band_set = plan.band_set;
  out.bands = plan.bands;
  out.band_files = plan.band_files;
  out.has_solar_disk = plan.has_solar_disk;
  return out;
}

/// The epochs that an observer would have; Nothing if there are none.
Result<KeptEpochs> epochs_of(const Scenario &scenario, const Trajectory &orbit, unsigned threads,
                             const Monitor &monitor) {
  const ScenarioTime &time = *scenario.time;
  UMOV_ASSIGN(track, Track::make({orbit,
                                  *scenario.observer,
                                  ShadowModel::Ellipsoid,
                                  InertialLaw{},
                                  {},
                                  scenario.has_solar_disk}));
  UMOV_ASSIGN(kept, keep_epochs(track, time.span(), time.only, threads, monitor.cancel_flag()));
  if (!kept.geometry.empty())
    return std::move(kept);
  constexpr double days = 14; // beyond it the elements say little
  const auto next = find_next_pass(track, time.only, time.start, days);
  return fail(ErrorCode::Nothing,
              next
                  ? fmt::format("no epoch of the span can be observed; the next pass is near {}Z, "
                                "max alt {:.0f}: set time.start and time.stop, or --start and "
                                "--stop",
                                to_iso(next->first_row).substr(0, 16), next->altitude_max.degrees())
                  : fmt::format("no epoch of the span can be observed, nor any in the {:.0f} days "
                                "after time.start",
                                days),
              scenario.place("time.start"));
}

/// The epochs of some passes, in some bands.
ObservedCurve layout_of(const Plan &plan, const std::vector<std::size_t> &epochs,
                        std::size_t only_band) {
  ObservedCurve out;
  out.bands = plan.bands;
  out.is_absolute = true; // whether that says anything, --scale-sd decides
  for (std::size_t e = 0; e < epochs.size(); ++e)
    for (std::size_t b = 0; b < plan.bands.size(); ++b)
      if (only_band == plan.bands.size() || only_band == b) {
        ObservedSample s;
        s.epoch = e;
        s.band = b;
        out.samples.push_back(s);
      }
  out.epochs.resize(epochs.size());
  return out;
}

/// The alternatives at some epochs alone.
std::vector<Alternative> part_of(const Plan &plan, const std::vector<std::size_t> &epochs) {
  std::vector<Alternative> out;
  const std::size_t bands = plan.bands.size();
  for (const Alternative &a : plan.alternatives) {
    Alternative one;
    one.light.name = a.light.name;
    for (const std::size_t e : epochs)
      for (std::size_t k = e * bands; k < (e + 1) * bands; ++k) {
        one.light.i.push_back(a.light.i[k]);
        one.light.q.push_back(a.light.q[k]);
        one.light.u.push_back(a.light.u[k]);
        one.errors.i_sd.push_back(a.errors.i_sd[k]);
        one.errors.q_sd.push_back(a.errors.q_sd[k]);
      }
    out.push_back(std::move(one));
  }
  return out;
}

/// What is asked of every set of epochs.
class Judge {
public:
  Judge(const Plan &plan, const PlanRequest &request, std::vector<double> prior, std::uint64_t seed)
      : plan_(plan), errors_(request.errors), prior_(std::move(prior)), seed_(seed) {}

  PlannedPass pass(std::size_t number, std::vector<std::size_t> epochs) const {
    PlannedPass out;
    out.pass = number;
    const auto light = part_of(plan_, epochs);
    const std::size_t bands = plan_.bands.size();
    for (std::size_t k = 0; k <= (bands > 1 ? bands : 0); ++k) {
      const std::size_t b = k == 0 ? bands : k - 1; // all of them first
      const ObservedCurve layout = layout_of(plan_, epochs, b);
      for (const bool has_polarization : {true, false}) {
        const auto ratios = ratios_of(layout, light, has_polarization);
        out.choices.push_back({b == bands ? "all" : plan_.bands[b], has_polarization,
                               discrimination(ratios, prior_, seed_)});
        if (b == bands)
          (has_polarization ? out.log_bayes : out.log_bayes_of_i) = ratios;
      }
    }
    out.epochs = std::move(epochs);
    return out;
  }
  Discrimination together(const std::vector<std::size_t> &epochs) const {
    const ObservedCurve layout = layout_of(plan_, epochs, plan_.bands.size());
    return discrimination(ratios_of(layout, part_of(plan_, epochs), true), prior_, seed_);
  }

private:
  std::vector<double> ratios_of(const ObservedCurve &layout, const std::vector<Alternative> &light,
                                bool has_polarization) const {
    CurveErrors errors = errors_;
    errors.has_polarization = has_polarization;
    errors.outlier_share = 0; // of data that nobody has yet
    return expected_log_bayes(layout, errors, light);
  }
  const Plan &plan_;
  CurveErrors errors_;
  std::vector<double> prior_;
  std::uint64_t seed_;
};

/// Better passes first: by information, where that is full by the hardest pair.
bool is_better(const Discrimination &a, const Discrimination &b) {
  constexpr double alike_bits = 1e-3;
  const double steps_a = std::round(a.information_bits / alike_bits);
  const double steps_b = std::round(b.information_bits / alike_bits);
  if (steps_a != steps_b)
    return steps_a > steps_b;
  return a.hardest_log_bayes > b.hardest_log_bayes;
}

/// Passes one after the other, each the one that adds most, until the question is decided.
void put_sequence(Plan &plan, const Judge &judge) {
  constexpr std::size_t looked_at = 12, most = 6;
  std::vector<std::size_t> epochs, left(std::min(looked_at, plan.passes.size()));
  std::iota(left.begin(), left.end(), std::size_t{0});
  while (!left.empty() && plan.sequence.size() < most) {
    PlanStep best;
    for (std::size_t k = 0; k < left.size(); ++k) {
      std::vector<std::size_t> joined = epochs;
      const auto &more = plan.passes[left[k]].epochs;
      joined.insert(joined.end(), more.begin(), more.end());
      const PlanStep step{left[k], judge.together(joined)};
      if (k == 0 || is_better(step.told, best.told))
        best = step;
    }
    const auto &more = plan.passes[best.pass].epochs;
    epochs.insert(epochs.end(), more.begin(), more.end());
    std::erase(left, best.pass);
    plan.sequence.push_back(best);
    if (best.told.decided >= sure)
      return;
  }
}

std::vector<std::vector<std::size_t>> epochs_by_pass(const KeptEpochs &kept) {
  std::vector<std::vector<std::size_t>> out(kept.passes.size());
  for (std::size_t e = 0; e < kept.pass.size(); ++e)
    out[kept.pass[e]].push_back(e);
  return out;
}

/// The light of all alternatives, and the errors that observers would have.
Result<void> put_light(Plan &plan, const Scenario &scenario,
                       const std::vector<PlanAlternative> &alternatives, const PlanRequest &request,
                       const JobOptions &options, const Monitor &monitor, Inversion &out) {
  std::vector<std::size_t> column(scenario.bands.size());
  std::iota(column.begin(), column.end(), std::size_t{0});
  for (const PlanAlternative &a : alternatives) {
    monitor.advance("alternatives", plan.alternatives.size(), alternatives.size());
    UMOV_ASSIGN(light, known_light(placed(scenario, a.scenario),
                                   {plan.kept.geometry, column, request.method, {}}, options,
                                   monitor, out.light));
    light.name = a.name;
    plan.alternatives.push_back({std::move(light), {}});
  }
  UMOV_ASSIGN(errors, planned_errors(scenario, request,
                                     {plan.kept.geometry, plan.alternatives, plan.bands.size()}));
  for (std::size_t k = 0; k < plan.alternatives.size(); ++k)
    plan.alternatives[k].errors = std::move(errors.of[k]);
  plan.noise = std::move(errors.text);
  if (errors.saturated > 0)
    plan.notes.push_back(fmt::format("{} left out: the brightest pixel would be full; shorten "
                                     "observation.exposure_s",
                                     counted(errors.saturated, "row")));
  return {};
}

/// What a reader of the answer should know.
void put_notes(Plan &plan, const PlanRequest &request) {
  const Discrimination &best = plan.passes.front().choices.front().told;
  const bool is_dark = std::ranges::all_of(plan.alternatives, [](const Alternative &a) {
    return std::ranges::none_of(a.light.i, [](double light) { return light > 0; });
  });
  if (is_dark)
    plan.notes.emplace_back("no alternative gives light at these epochs: nothing is told by them; "
                            "are attitudes and times right?");
  else if (const double last = plan.sequence.back().told.hardest_log_bayes; last < 1)
    plan.notes.push_back(fmt::format(
        "{} and {} stay alike (expected ln Bayes factor {:.2g} after {}): other times, bands or a "
        "smaller --floor are needed",
        plan.names[plan.sequence.back().told.hardest_a],
        plan.names[plan.sequence.back().told.hardest_b], last,
        counted(plan.sequence.size(), "pass", "passes")));
  if (plan.kept.stopped)
    plan.notes.push_back("the orbit ends within the span: " + plan.kept.stopped->message);
  if (!(request.errors.floor > 0))
    plan.notes.emplace_back("--floor 0 takes the model for perfect: real passes tell less");
  plan.verdict = best.decided >= sure                        ? Verdict::Determined
                 : plan.sequence.back().told.decided >= sure ? Verdict::Ambiguous
                                                             : Verdict::Undetermined;
}

} // namespace

Result<Inversion> plan_observations(const Scenario &given,
                                    const std::vector<PlanAlternative> &alternatives,
                                    const PlanRequest &request, const JobOptions &options,
                                    const Monitor &monitor, Diagnostics &diagnostics) {
  UMOV_TRY(check(given, alternatives));
  Scenario scenario = given;
  if (given.observation && !(request.snr > 0)) {
    UMOV_ASSIGN(bands, observed_bands(given));
    scenario.bands = std::move(bands.bands);
  }
  warn_if_beyond_leap_seconds(scenario.time->stop, diagnostics);
  warn_if_outside_eop(scenario.time->start, scenario.time->stop, diagnostics);
  UMOV_ASSIGN(object,
              load_object(scenario, 0,
                          {.allow_old_elements = request.allow_old_elements, .reads_shape = false},
                          diagnostics));
  Plan plan;
  UMOV_ASSIGN(kept, epochs_of(scenario, *object.orbit, options.threads, monitor));
  plan.kept = std::move(kept);
  for (const Band &band : scenario.bands)
    plan.bands.push_back(band.name);
  std::vector<double> prior;
  for (const PlanAlternative &a : alternatives) {
    plan.names.push_back(a.name);
    prior.push_back(a.prior);
  }
  Inversion out;
  UMOV_TRY(put_light(plan, scenario, alternatives, request, options, monitor, out));
  tell_of_device(out.light.device, diagnostics);
  const Judge judge(plan, request, prior, scenario.seed);
  const auto by_pass = epochs_by_pass(plan.kept);
  for (std::size_t k = 0; k < by_pass.size(); ++k) {
    monitor.advance("passes", k, by_pass.size());
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
    if (!by_pass[k].empty())
      plan.passes.push_back(judge.pass(k, by_pass[k]));
  }
  std::ranges::stable_sort(plan.passes, [](const PlannedPass &a, const PlannedPass &b) {
    return is_better(a.choices.front().told, b.choices.front().told);
  });
  put_sequence(plan, judge);
  put_notes(plan, request);
  out.verdict = plan.verdict;
  out.tables = plan_tables(plan);
  out.summary = plan_summary(plan);
  out.json = plan_json(plan);
  out.page = plan_page("What would tell them apart: " + scenario.title, plan);
  out.inputs = object.inputs;
  out.seed = scenario.seed;
  return out;
}

} // namespace umov::jobs
