// umov passes: when the objects of a file pass over a site.

#include "finishing.h"
#include "job_console.h"
#include "passes_options.h"
#include "scale_job.h"
#include "tables.h"
#include "verbs.h"

#include <umov/jobs/ranged_job.h>

namespace umov::cli {
namespace {

Result<void> run_passes(const PassesOptions &o, const Common &common, Diagnostics &diagnostics) {
  UMOV_TRY(check_output(o.output));
  UMOV_ASSIGN(request, request_of(o, common));
  jobs::JobOptions options = with_elements(job_options(common), o.elements);
  UMOV_ASSIGN(part, part_of(o.part));
  options.part = part;
  JobConsole console(common, tracing_masks);
  UMOV_ASSIGN(result, jobs::passes(request, options, console.monitor(true), diagnostics));
  Table table = jobs::passes_table(request, result);
  if (result.stopped)
    return tl::unexpected(stop_table(o.output, std::move(table), common, *result.stopped));
  if (!o.chart.empty())
    UMOV_TRY(put(o.chart, jobs::sky_chart(request, result)));
  UMOV_ASSIGN(shown, chosen_columns(table, o.columns,
                                    {"name", "rise_utc", "culmination_utc", "set_utc",
                                     "culmination_alt", "culmination_az", "visible_alt", "visible",
                                     "phase_min", "mag_min", "p_max"},
                                    o.output, common));
  return put_table(o.output, shown, common);
}

} // namespace

Result<RangedVerb> passes_in_parts(const std::vector<std::string> &arguments,
                                   const PartsSetting &setting, Diagnostics &diagnostics) {
  CLI::App verb("When objects pass over a site", "passes");
  PassesOptions o;
  Common common;
  add_passes_options(verb, o, common);
  UMOV_TRY(parse_verb(verb, arguments));
  UMOV_TRY(refuse_output(o.output, o.part));
  UMOV_ASSIGN(request, request_of(o, common));
  UMOV_ASSIGN(job, jobs::ranged_passes(request, with_elements(setting.options, o.elements),
                                       setting.monitor, diagnostics));
  return RangedVerb{std::move(job), o.site.earth_orientation};
}

void add_passes(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("passes", "When objects pass over a site, and in which light");
  auto o = std::make_shared<PassesOptions>();
  auto common = std::make_shared<Common>();
  add_passes_options(*verb, *o, *common);
  verb->callback(stoppable(exit_with, common, [=](Diagnostics &diagnostics) {
    return run_passes(*o, *common, diagnostics);
  }));
}

} // namespace umov::cli
