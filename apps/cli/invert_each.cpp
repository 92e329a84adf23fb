#include "invert_each.h"

#include "device_options.h"
#include "scale_job.h"
#include "tables.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::cli {
namespace {

/// Answers stand side by side; what has none is named at the end.
Result<void> answer_each(InvertVerb &o, const EachOptions &each, const EachJob &many,
                         Diagnostics &diagnostics) {
  const auto started = std::chrono::system_clock::now();
  UMOV_ASSIGN(part, part_of(each.part));
  UMOV_ASSIGN(scenario, read_scenario(o.scenario, o.keys()));
  std::optional<RunFolder> folder;
  if (!o.output.empty()) {
    UMOV_ASSIGN(opened, RunFolder::open(o.output, o.common.force));
    folder = std::move(opened);
  }
  settle(o);
  JobConsole console(o.common);
  const jobs::Monitor monitor = console.monitor(o.common.verbose);
  UMOV_ASSIGN(job, many(scenario, o, job_options(o.common), monitor, diagnostics));
  UMOV_ASSIGN(answers, jobs::answer_curves(*job, part, monitor, diagnostics));
  if (folder)
    UMOV_TRY(jobs::write_answers(answers, scenario, manifest_of_command(o.common, started),
                                 diagnostics, *folder));
  if (o.common.json || !o.common.quiet)
    UMOV_TRY(put_table("", answers.tables.front().table, o.common));
  if (folder && !o.common.quiet && !o.common.json)
    fmt::print("written to {}\n", printable(o.output));
  return jobs::all_answered(answers.failed, answers.curves);
}

Result<void> check_alone(const EachOptions &each) {
  if (each.is_asked || (each.part.shard.empty() && each.part.range.empty()))
    return {};
  return fail(ErrorCode::Usage, "--shard and --range take a part of many curves: --each says that "
                                "every file is a curve by itself");
}

Result<RangedVerb> in_parts(CLI::App &verb, const std::vector<std::string> &arguments,
                            const std::shared_ptr<InvertVerb> &o, const EachOptions &each,
                            const EachJob &many, const PartsSetting &setting,
                            Diagnostics &diagnostics) {
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(refuse_output(o->output, each.part));
  if (!each.is_asked)
    return fail(ErrorCode::Usage, "one fit of all files has no parts: --each says that every file "
                                  "is a curve by itself");
  UMOV_ASSIGN(scenario, read_scenario(o->scenario, o->keys()));
  settle(*o);
  jobs::JobOptions options = setting.options;
  options.device = device_options(o->common);
  UMOV_ASSIGN(job, many(scenario, *o, options, setting.monitor, diagnostics));
  return RangedVerb{std::move(job), ""};
}

} // namespace

void add_each(CLI::App &verb, EachOptions &each) {
  verb.add_flag("--each", each.is_asked,
                "Every file is a curve by itself: a row of each, and all tables with a column of "
                "its name");
  add_part(verb, each.part, "curves of --each");
}

void run_invert_or_each(CLI::App &verb, const std::shared_ptr<InvertVerb> &o,
                        const std::shared_ptr<EachOptions> &each, const Exit &exit_with,
                        const InvertJob &one, const EachJob &many) {
  verb.callback([=] {
    if (const auto fits = check_alone(*each); !fits)
      return exit_with(report(fits.error()));
    if (!each->is_asked)
      return answer_one(*o, exit_with, one);
    watch_interrupts();
    Diagnostics diagnostics;
    const auto done = answer_each(*o, *each, many, diagnostics);
    report(diagnostics, o->common);
    exit_with(done ? 0 : report(done.error()));
  });
}

Result<RangedVerb> invert_in_parts(const std::vector<std::string> &arguments,
                                   const PartsSetting &setting, Diagnostics &diagnostics) {
  if (arguments.empty() || arguments.front() != "pose")
    return fail(ErrorCode::Usage,
                fmt::format("invert {}: of the questions of umov invert \"pose\" has parts, with "
                            "--each",
                            arguments.empty() ? "" : printable(arguments.front())));
  CLI::App verb("Which attitudes", "invert pose");
  const auto o = std::make_shared<InvertVerb>();
  EachOptions each;
  const EachJob many = pose_options(verb, o, each);
  return in_parts(verb, {arguments.begin() + 1, arguments.end()}, o, each, many, setting,
                  diagnostics);
}

Result<RangedVerb> identify_in_parts(const std::vector<std::string> &arguments,
                                     const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("Which object", "identify");
  const auto o = std::make_shared<InvertVerb>();
  const auto asked = std::make_shared<jobs::IdentifyRequest>();
  EachOptions each;
  const EachJob many = identify_options(verb, o, asked, each);
  return in_parts(verb, arguments, o, each, many, setting, diagnostics);
}

} // namespace umov::cli
