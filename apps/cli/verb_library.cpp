// umov library build.

#include "device_options.h"
#include "finishing.h"
#include "job_console.h"
#include "part_options.h"
#include "verbs.h"

#include <umov/jobs/library.h>

namespace umov::cli {
namespace {

struct LibraryVerb {
  jobs::LibraryRequest request;
  PartOptions part;
  Common common;
};

Result<void> take_part(LibraryVerb &o) {
  UMOV_ASSIGN(part, part_of(o.part));
  UMOV_ASSIGN(range, part.of(o.request.scenarios.size(), "scenarios"));
  o.request.first = range.first;
  o.request.count = range.count;
  return {};
}

Result<void> build(LibraryVerb &o, Diagnostics &diagnostics) {
  UMOV_TRY(take_part(o));
  JobConsole console(o.common);
  UMOV_ASSIGN(built, jobs::build_library(o.request, job_options(o.common),
                                         console.monitor(o.common.verbose), diagnostics));
  if (o.common.json)
    return put("", to_json(built.table));
  return o.common.quiet ? Result<void>() : put("", to_text(built.table));
}

void add_build(CLI::App &library, const Exit &exit_with) {
  auto *verb = library.add_subcommand(
      "build", "Light and abundances of objects over all directions, one file each");
  auto o = std::make_shared<LibraryVerb>();
  verb->add_option("scenarios", o->request.scenarios,
                   "Scenarios of one object each; the file's name is the object's")
      ->required();
  verb->add_option("-o,--output", o->request.folder, "Folder of the library")->required();
  verb->add_option("--cells", o->request.cells,
                   "Directions: (cells + 1)^2 of Sun and observer, 20: 97,461 pairs, 9 deg apart")
      ->check(CLI::Range(4, 60))
      ->capture_default_str();
  add_part(*verb, o->part, "scenarios");
  add_threads(*verb, o->common);
  add_cache(*verb, o->common);
  add_device(*verb, o->common);
  verb->add_flag("-v,--verbose", o->common.verbose, "Also say what was done");
  add_common(*verb, o->common, true);
  const std::shared_ptr<const Common> common(o, &o->common);
  verb->callback(stoppable(exit_with, common,
                           [o](Diagnostics &diagnostics) { return build(*o, diagnostics); }));
}

} // namespace

void add_library(CLI::App &app, const Exit &exit_with) {
  auto *library = app.add_subcommand("library", "Signatures of many objects");
  library->require_subcommand(1);
  add_build(*library, exit_with);
}

} // namespace umov::cli
