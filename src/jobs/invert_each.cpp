#include <umov/jobs/invert_each.h>

#include "jobs/curve_questions.h"
#include "jobs/invert_tables.h"
#include "jobs/job_journal.h"
#include "jobs/ready_objects.h"
#include "jobs/result_folder.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <string_view>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov::jobs {
namespace {

/// Its column `curve` first; notes that are of one answer alone are left out.
Table of_curve(const std::string &curve, const Table &table) {
  const std::string_view own[] = {"share_of_so3", epoch_note,   until_note, median_note,
                                  floor_note,     verdict_note, doubt_note, unit_note};
  Table out;
  for (const auto &[key, value] : table.notes())
    if (std::ranges::find(own, key) == std::end(own))
      out.note(key, value);
  out.add("curve", "", "file of the observations", std::vector<std::string>(table.rows(), curve));
  for (const Column &column : table.columns()) {
    out.add(column.name, column.unit, column.description, column.cells);
    out.set_precision(column.name, column.precision);
  }
  return out;
}

/// Lines side by side, without the room that aligns them.
std::string in_one_line(const std::string &text) {
  std::string out;
  for (const char c : text)
    if (c == '\n')
      out += out.empty() || out.ends_with("; ") ? "" : "; ";
    else if (c != ' ' || (!out.empty() && !out.ends_with(' ')))
      out += c;
  return out.ends_with("; ") ? out.substr(0, out.size() - 2) : out;
}

/// Rows of the table of all curves.
class CurveRows {
public:
  void add(const std::string &curve, const Result<Inversion> &found, const Diagnostics &told) {
    curve_.push_back(curve);
    verdict_.emplace_back(found ? name_of(found->verdict) : "failed");
    problem_.push_back(found ? "" : found.error().text());
    warnings_.push_back(fmt::format("{}", fmt::join(messages_of(told), "; ")));
    answer_.push_back(found ? in_one_line(found->summary) : "");
    failed_ += found ? 0u : 1u;
  }
  [[nodiscard]] std::size_t failed() const { return failed_; }
  [[nodiscard]] Table table() && {
    Table out;
    note_conventions(out);
    out.add("curve", "", "file of the observations", std::move(curve_));
    out.add("verdict", "", "how sure the answer is; failed: there is none", std::move(verdict_));
    out.add("problem", "", "why there is none", std::move(problem_));
    out.add("warnings", "", "of the curve", std::move(warnings_));
    out.add("answer", "", "in words, with what cannot be known", std::move(answer_));
    return out;
  }

private:
  std::vector<std::string> curve_, verdict_, problem_, warnings_, answer_;
  std::size_t failed_ = 0;
};

/// What ends all: nothing that another curve could do better.
bool is_of_all(const Error &error) {
  return error.code == ErrorCode::Interrupted || error.code == ErrorCode::Device ||
         error.code == ErrorCode::Internal;
}

class RangedCurves final : public RangedJob {
public:
  RangedCurves(CurveQuestion question, std::vector<InputFile> inputs, std::string identity,
               std::vector<std::string> warnings)
      : question_(std::move(question)), inputs_(std::move(inputs)), identity_(std::move(identity)),
        warnings_(std::move(warnings)) {}
  /// All that is read, the curves among it.
  [[nodiscard]] const std::vector<InputFile> &inputs() const { return inputs_; }
  [[nodiscard]] std::string unit() const override { return "curves"; }
  [[nodiscard]] std::size_t total() const override { return question_.curves.size(); }
  [[nodiscard]] std::string identity() const override { return identity_; }
  [[nodiscard]] std::vector<std::string> tables() const override {
    std::vector<std::string> out{"curves"};
    for (const NamedTable &one : question_.tables)
      out.push_back(one.name);
    return out;
  }
  [[nodiscard]] std::string problems() const override { return "problem"; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }
  [[nodiscard]] std::vector<Tally> tallies() const override {
    return {{"", "curves have no answer: see their problem", ""}};
  }
  Result<void> keep() override {
    if (question_.keep)
      question_.keep();
    return {};
  }
  Result<void> rows(IndexRange range, RangeSink &sink, const Monitor &monitor,
                    Diagnostics & /*told_in_the_rows*/) override {
    CurveRows all;
    Monitor quiet = monitor; // curves are what is counted
    quiet.progress = {};
    bool has_rows = false;
    for (std::size_t k = range.first; k < range.end(); ++k) {
      if (monitor.is_cancelled())
        return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
      const std::string &curve = question_.curves[k];
      Diagnostics told;
      const auto found = question_.ask(curve, quiet, told);
      if (!found && is_of_all(found.error()))
        return tl::unexpected(found.error());
      all.add(curve, found, told);
      has_rows = has_rows || found.has_value();
      if (found)
        UMOV_TRY(add(curve, found->tables, sink));
      monitor.advance("curves", k + 1 - range.first, range.count);
    }
    if (!has_rows)
      UMOV_TRY(add("", question_.tables, sink));
    sink.tally({all.failed()});
    return sink.add(0, std::move(all).table());
  }

private:
  static Result<void> add(const std::string &curve, const std::vector<NamedTable> &tables,
                          RangeSink &sink) {
    for (std::size_t t = 0; t < tables.size(); ++t)
      UMOV_TRY(sink.add(t + 1, of_curve(curve, tables[t].table)));
    return {};
  }
  CurveQuestion question_;
  std::vector<InputFile> inputs_;
  std::string identity_;
  std::vector<std::string> warnings_;
};

/// A curve that cannot be read is told when its turn comes.
std::vector<InputFile> hashed(const CurveQuestion &question) {
  std::vector<InputFile> out = question.inputs;
  out.reserve(out.size() + question.curves.size());
  for (const std::string &curve : question.curves) {
    const auto text = read_file(curve);
    out.push_back({curve, text ? sha256_hex(*text) : "unreadable"});
  }
  return out;
}

Result<std::unique_ptr<RangedJob>> job_of(CurveQuestion question, const Scenario &scenario,
                                          const JobOptions &options, const Diagnostics &told,
                                          Diagnostics &diagnostics) {
  UMOV_TRY(check_device_of_shards(options.device));
  UMOV_ASSIGN(device, device_text(options.device));
  for (const Warning &warning : told.warnings())
    diagnostics.warn(warning.message, warning.where);
  std::vector<InputFile> inputs = hashed(question);
  std::string identity = job_text(scenario, inputs, "each curve: " + question.asked + device);
  return std::make_unique<RangedCurves>(std::move(question), std::move(inputs), std::move(identity),
                                        messages_of(told));
}

/// All rows in memory.
class Collected final : public RangeSink {
public:
  explicit Collected(std::size_t count) : tables(count) {}
  Result<void> add(std::size_t table, Table &&rows) override {
    tables[table].append(std::move(rows));
    return {};
  }
  void tally(const std::vector<std::size_t> &given) override { counts = given; }
  std::vector<Table> tables;
  std::vector<std::size_t> counts;
};

} // namespace

Result<std::unique_ptr<RangedJob>> ranged_poses(const Scenario &scenario,
                                                const InvertRequest &request,
                                                const JobOptions &options, const Monitor &made_by,
                                                Diagnostics &diagnostics) {
  Diagnostics told;
  UMOV_ASSIGN(light, prepare_light(scenario, request, options, told, made_by.cancel));
  UMOV_TRY(take_coarse(light, scenario, request, options, made_by.cancel));
  take_apart(light, request, options, told, made_by.cancel);
  if (made_by.is_cancelled())
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  const auto ready = std::make_shared<const SearchedLight>(std::move(light));
  CurveQuestion question;
  question.curves = request.observations;
  question.tables = no_pose_tables();
  question.inputs = ready->light.inputs();
  question.asked = "pose; " + text_of(request);
  question.keep = [ready] { keep_masks(*ready); };
  question.ask = [=](const std::string &curve, const Monitor &monitor,
                     Diagnostics &of_curve) -> Result<Inversion> {
    std::vector<InputFile> inputs;
    UMOV_ASSIGN(files, read_observations({curve}, request.errors.has_polarization, options.threads,
                                         inputs, of_curve));
    UMOV_ASSIGN(observed,
                observed_light_curve(scenario, files, request.allow_old_elements, of_curve, false));
    return pose_answer(scenario, request, options, observed, *ready, monitor, of_curve);
  };
  return job_of(std::move(question), scenario, options, told, diagnostics);
}

Result<std::unique_ptr<RangedJob>>
ranged_identities(const Scenario &scenario, const IdentifyRequest &request,
                  const JobOptions &options, const Monitor &made_by, Diagnostics &diagnostics) {
  UMOV_ASSIGN(library, library_text(request.library));
  CurveQuestion question;
  question.curves = request.observed.observations;
  question.tables = no_identity_tables();
  Diagnostics told_with_curves; // where it was and when the bands saw it
  UMOV_ASSIGN(place, load_object(scenario, 0, {.allow_old_elements = true, .reads_shape = false},
                                 told_with_curves));
  question.inputs = place.inputs;
  for (const std::string &object : request.objects) {
    UMOV_ASSIGN(text, read_file(object));
    question.inputs.push_back({object, sha256_hex(text)});
    UMOV_ASSIGN(own, read_scenario(object, {}));
    Diagnostics told_with_each;
    UMOV_ASSIGN(loaded, load_object(own, 0, {.allow_old_elements = true, .cancel = made_by.cancel},
                                    told_with_each));
    question.inputs.insert(question.inputs.end(), loaded.inputs.begin(), loaded.inputs.end());
  }
  question.asked = fmt::format("identity; {}; none {:.17g}; library {}", text_of(request.observed),
                               request.none_prior, sha256_hex(library));
  const auto ready = std::make_shared<ReadyObjects>();
  question.ask = [=](const std::string &curve, const Monitor &monitor, Diagnostics &of_curve) {
    IdentifyRequest one = request;
    one.observed.observations = {curve};
    return identity_answer(scenario, one, options, *ready, monitor, of_curve);
  };
  question.keep = [ready] { ready->keep(); };
  return job_of(std::move(question), scenario, options, {}, diagnostics);
}

Result<CurveAnswers> answer_curves(RangedJob &job, const JobPart &part, const Monitor &monitor,
                                   Diagnostics &diagnostics) {
  UMOV_ASSIGN(range, part.of(job.total(), job.unit()));
  const std::vector<std::string> names = job.tables();
  Collected all(names.size());
  UMOV_TRY(job.rows(range, all, monitor, diagnostics));
  UMOV_TRY(job.keep());
  UMOV_ASSIGN(told, sentences(job.tallies(), all.counts, range.count));
  std::vector<std::string> warnings = job.warnings();
  warnings.insert(warnings.end(), told.begin(), told.end());
  note_warnings(all.tables.front(), warnings);
  CurveAnswers out;
  if (const auto *const curves = dynamic_cast<const RangedCurves *>(&job))
    out.inputs = curves->inputs();
  out.curves = range.count;
  const Table &curves = all.tables.front();
  for (std::size_t row = 0; row < curves.rows(); ++row)
    if (curves.text("verdict", row) == "failed")
      out.failed.push_back(curves.text("problem", row));
  for (std::size_t t = 0; t < names.size(); ++t)
    out.tables.push_back({names[t], std::move(all.tables[t])});
  return out;
}

Result<void> all_answered(const std::vector<std::string> &problems, std::size_t curves) {
  if (problems.empty())
    return {};
  return fail(ErrorCode::BadInput,
              fmt::format("{} of {} have no answer, the others have theirs: {}", problems.size(),
                          counted(curves, "curve"), listed(problems, 5)));
}

Result<void> write_answers(const CurveAnswers &answers, const Scenario &scenario,
                           ManifestInput manifest, const Diagnostics &diagnostics,
                           RunFolder &folder) {
  for (const NamedTable &one : answers.tables) {
    manifest.files.push_back(one.name + ".ecsv");
    folder.add(manifest.files.back(), to_ecsv(one.table));
  }
  std::string log = counted(answers.curves, "curve") + "\n";
  for (const std::string &problem : answers.failed)
    log += "no answer: " + problem + "\n";
  UMOV_TRY(add_records(scenario, "", log + warning_lines(diagnostics), answers.inputs, diagnostics,
                       std::move(manifest), folder));
  return folder.commit();
}

} // namespace umov::jobs
