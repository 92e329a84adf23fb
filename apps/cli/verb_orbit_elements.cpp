// umov orbit show and convert: files of mean elements and CCSDS messages, read and written.

#include "console.h"
#include "site_options.h"
#include "verbs.h"

#include "tables.h"
#include <chrono>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <umov/jobs/orbit_files.h>

namespace umov::cli {
namespace {

struct ElementsOptions {
  jobs::OrbitFile file;
  std::string output, form, start, stop;
  double step_s = 60;
};

std::string form_name(const ElementsOptions &o) {
  if (!o.form.empty() || o.output.empty() || o.output == "-")
    return o.form;
  const std::string suffix = std::filesystem::path(o.output).extension().string();
  return suffix.empty() ? suffix : suffix.substr(1);
}

Epoch<Utc> now() {
  using std::chrono::system_clock;
  const auto text = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                                fmt::gmtime(system_clock::to_time_t(system_clock::now())));
  return utc_from_iso(text).value();
}

int run_show(const ElementsOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<void> {
    UMOV_TRY(check_output(o.output));
    UMOV_ASSIGN(table, jobs::orbit_file_table(o.file, diagnostics));
    return put_table(o.output, table, common);
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

Result<jobs::ConversionRequest> request_of(const ElementsOptions &o) {
  jobs::ConversionRequest out{o.file, form_name(o), o.output, {}, {}, o.step_s, now()};
  if (out.form != "oem" || o.start.empty() || o.stop.empty())
    return out;
  UMOV_ASSIGN(start, time_of("--start", o.start));
  UMOV_ASSIGN(stop, time_of("--stop", o.stop));
  out.start = start;
  out.stop = stop;
  return out;
}

int run_convert(const ElementsOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<void> {
    UMOV_ASSIGN(request, request_of(o));
    UMOV_ASSIGN(written, jobs::convert_orbit_file(request, diagnostics));
    return put(o.output, written);
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

void add_options(CLI::App &verb, ElementsOptions &o) {
  verb.add_option("--orbit", o.file.path, "TLE, 3LE, OMM, OEM, OPM, AEM or TDM file")->required();
  verb.add_option("--norad", o.file.norad, "Only the sets of this catalogue number");
  verb.add_flag("--allow-bad-checksum", o.file.allow_bad_checksum,
                "Read lines with a wrong checksum");
  verb.add_flag("--keep-going", o.file.keep_going, "Report bad sets and keep the others");
}

} // namespace

void add_orbit_show(CLI::App &orbit, const Exit &exit_with) {
  auto *verb =
      orbit.add_subcommand("show", "What a file of orbits or a CCSDS message holds, as a table");
  auto o = std::make_shared<ElementsOptions>();
  auto common = std::make_shared<Common>();
  add_options(*verb, *o);
  add_table_output(*verb, o->output);
  add_common(*verb, *common, true);
  verb->callback([o, common, exit_with] { exit_with(run_show(*o, *common)); });
}

void add_orbit_convert(CLI::App &orbit, const Exit &exit_with) {
  auto *verb =
      orbit.add_subcommand("convert", "Orbits and CCSDS messages from one form to another");
  auto o = std::make_shared<ElementsOptions>();
  auto common = std::make_shared<Common>();
  add_options(*verb, *o);
  verb->add_option("-o,--output", o->output,
                   "File: .tle, .kvn, .xml, .json, .csv or .oem; without it the text is printed");
  verb->add_option("--to", o->form, "tle, kvn, xml, json, csv or oem, whatever the file's name");
  verb->add_option("--start", o->start, "oem: first epoch, such as 2018-01-21T04:00:00Z");
  verb->add_option("--stop", o->stop, "oem: last epoch, included");
  verb->add_option("--step-s", o->step_s, "oem: step [s]")->capture_default_str();
  add_common(*verb, *common, false);
  verb->callback([o, common, exit_with] { exit_with(run_convert(*o, *common)); });
}

} // namespace umov::cli
