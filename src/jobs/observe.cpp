#include <umov/jobs/observe.h>

#include "jobs/observed_object.h"
#include "jobs/result_folder.h"
#include "jobs/wanted_passes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <umov/core/text.h>
#include <umov/time/earth_orientation.h>

namespace umov::jobs {
namespace {

/// Where the rows of all objects go.
RecordedSink sink_into(Observation &out, const FrameSink &take_frame) {
  RecordedSink sink;
  sink.take_frame = take_frame;
  sink.take_rows = [&out](Table &&counts, Table &&truth) -> Result<void> {
    out.counts.append(std::move(counts));
    out.truth.append(std::move(truth));
    return {};
  };
  return sink;
}

Result<void> record_object(ObservedObject &object, IndexRange range, const Monitor &monitor,
                           RecordedSink &sink, Observation &out, Diagnostics &diagnostics) {
  if (range.count == 0)
    return {};
  UMOV_TRY(object.record(range, monitor, sink));
  const LightModels &models = *object.light();
  const LightFacts &facts = models.light->facts();
  out.light.push_back({object.name(), name_of(facts.method), facts.visibility,
                       models.light->instruction_set(), models.device()});
  tell_of_device(models.device(), diagnostics);
  return object.keep_masks();
}

/// A part counts the exposures of all objects, so that all are found before any is recorded.
Result<void> record_part(std::vector<ObservedObject> &objects,
                         const std::vector<std::size_t> &counts, const JobOptions &options,
                         const Monitor &monitor, RecordedSink &sink, Observation &out,
                         Diagnostics &diagnostics) {
  std::size_t total = 0;
  for (const std::size_t count : counts)
    total += count;
  UMOV_ASSIGN(range, options.part.of(total, "exposures"));
  std::size_t first = 0;
  for (std::size_t k = 0; k < objects.size(); first += counts[k], ++k) {
    const IndexRange wanted = overlap(range, first, counts[k]);
    if (wanted.count == 0)
      continue;
    Diagnostics told_when_counted;
    UMOV_TRY(objects[k].prepare(monitor, told_when_counted));
    UMOV_TRY(record_object(objects[k], wanted, monitor, sink, out, diagnostics));
    objects[k].let_go();
  }
  return {};
}

Result<void> record_all(const ObservationPlan &plan, const Monitor &monitor, RecordedSink &sink,
                        Observation &out, Diagnostics &diagnostics) {
  const bool is_whole = plan.options.part.is_whole();
  std::vector<ObservedObject> objects;
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k < plan.scenario.objects.size(); ++k) {
    UMOV_ASSIGN(object,
                ObservedObject::load(plan, static_cast<std::uint32_t>(k), monitor, diagnostics));
    out.inputs.insert(out.inputs.end(), object.inputs().begin(), object.inputs().end());
    UMOV_TRY(object.prepare(monitor, diagnostics));
    if (!object.left_out().empty())
      out.left_out.push_back(object.left_out());
    counts.push_back(object.exposures());
    if (is_whole)
      UMOV_TRY(record_object(object, {0, counts.back()}, monitor, sink, out, diagnostics));
    if (is_whole || plan.scenario.objects.size() > 1)
      object.let_go();
    if (!is_whole)
      objects.push_back(std::move(object));
  }
  return is_whole ? Result<void>()
                  : record_part(objects, counts, plan.options, monitor, sink, out, diagnostics);
}

/// What is told of exposures by their number. That all of a part are saturated says nothing of the
/// others.
Result<void> warn_of_exposures(const ObservationPlan &plan, const RecordedSink &sink,
                               Diagnostics &diagnostics) {
  std::vector<Tally> words = ObservationTally::words(plan.scenario, sink.exposures);
  if (!plan.options.part.is_whole())
    for (Tally &one : words)
      one.all.clear();
  auto told = sentences(words, sink.tally.counts(), sink.exposures);
  if (!told)
    return fail(told.error().code, told.error().message,
                plan.scenario.place("observation.exposure_s"));
  for (std::string &sentence : *told)
    diagnostics.warn(std::move(sentence));
  return {};
}

/// Counts of two objects can be told apart by their names alone.
Result<void> check_names(const Scenario &scenario) {
  std::set<std::string> names;
  for (const ScenarioObject &object : scenario.objects)
    if (!names.insert(object.name).second)
      return fail(ErrorCode::BadInput,
                  fmt::format("two objects have {}: a name of its own was expected of each, by "
                              "which their counts are told apart",
                              object.name.empty() ? "no name" : "the name \"" + object.name + "\""),
                  {scenario.file});
  return {};
}

} // namespace

Result<ObservationPlan> plan_observation(const Scenario &scenario, const JobOptions &options,
                                         Diagnostics &diagnostics) {
  UMOV_TRY(check_complete_for_run(scenario));
  if (!scenario.observation)
    return fail(ErrorCode::BadInput,
                "umov observe also needs [observation] and an instrument: add instrument = "
                "\"c11_imx250\" (umov instrument list has others) and [observation] exposure_s",
                {scenario.file});
  UMOV_TRY(check_names(scenario));
  UMOV_ASSIGN(bands, observed_bands(scenario));
  UMOV_ASSIGN(programme, Programme::make(scenario, bands.responses, diagnostics));
  warn_if_beyond_leap_seconds(scenario.time->stop, diagnostics);
  warn_if_outside_eop(scenario.time->start, scenario.time->stop, diagnostics);
  ObservationPlan out{scenario, std::move(bands), std::move(programme), options};
  out.scenario.bands = out.bands.bands;
  return std::move(out);
}

Result<Observation> observe(const Scenario &given, const JobOptions &options,
                            const Monitor &monitor, Diagnostics &diagnostics,
                            const FrameSink &take_frame) {
  UMOV_ASSIGN(plan, plan_observation(given, options, diagnostics));
  const Scenario &scenario = plan.scenario;
  Observation out;
  RecordedSink sink = sink_into(out, take_frame);
  UMOV_TRY(record_all(plan, monitor, sink, out, diagnostics));
  out.exposures = sink.exposures;
  out.frames = sink.frames;
  out.light_s = sink.light_s;
  out.counts_s = sink.counts_s;
  if (out.exposures == 0)
    return fail(ErrorCode::Nothing,
                fmt::format("no exposure falls in a pass; umov passes tells when there is one{}{}",
                            out.left_out.empty() ? "" : ". ", fmt::join(out.left_out, "; ")),
                scenario.place("time.start"));
  UMOV_TRY(warn_of_exposures(plan, sink, diagnostics));
  out.saturated = sink.tally.saturated();
  note_observation(out.counts, scenario, plan.bands);
  note_observation(out.truth, scenario, plan.bands);
  note_warnings(out.counts, diagnostics);
  return out;
}

} // namespace umov::jobs
