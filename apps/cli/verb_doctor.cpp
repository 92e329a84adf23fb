// umov doctor: what this build and machine can do, each fact asked of the part that knows it.

#include "cache_folder.h"
#include "console.h"
#include "device_options.h"
#include "tables.h"
#include "verbs.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/bench/bench.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <umov/io/index_file.h>
#include <umov/io/mesh_file.h>
#include <umov/io/report.h>
#include <umov/io/scenario.h>
#include <umov/io/sites.h>
#include <umov/surface/distribution.h>
#include <umov/time/earth_orientation.h>

namespace umov::cli {
namespace {

struct Finding {
  bool is_fine;
  std::string what, found;
};

std::string day_of(Epoch<Utc> time) { return to_iso(time).substr(0, 10); }

Finding cache_finding() {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty())
    return {true, "cache folder", "none: neither XDG_CACHE_HOME nor HOME is set"};
  if (!can_be_kept(folder))
    return {true, "cache folder",
            "none: " + folder.string() +
                " cannot be written, masks are made by every command anew"};
  const FolderFacts facts = cache_facts(folder);
  return {true, "cache folder",
          fmt::format("{}: {}, {:.1f} MB", folder.string(), counted(facts.files, "file"),
                      static_cast<double>(facts.bytes) / 1e6)};
}

void add_machine(std::vector<Finding> &out) {
  const bench::Machine machine = bench::machine();
  out.push_back({true, "version", fmt::format("umov {} ({})", version, source_revision)});
  out.push_back({true, "processor", machine.processor});
  out.push_back({true, "threads", fmt::format("{}", resolve_threads(0))});
  out.push_back({true, "instruction set", machine.instruction_set});
  const auto cards = describe_cards(cuda_folders());
  out.push_back({true, "cuda", cards ? *cards : "not used: " + cards.error().message});
  out.push_back(cache_finding());
}

void add_library(std::vector<Finding> &out) {
  const auto count = [&](const char *what, std::size_t number) {
    out.push_back({number > 0, what, fmt::format("{}", number)});
  };
  count("materials", material_library().size());
  count("index tables", index_names().size());
  count("distributions", distribution_models().size());
  count("sites", site_names().size());
}

void add_tables_of_time(std::vector<Finding> &out) {
  // Known answers through the whole of time and Earth orientation (IERS: UT1-UTC on 2018-01-21).
  const auto time = utc_from_iso("2018-01-21T00:00:00Z");
  const bool is_fine =
      time && earth_orientation(*time).is_covered && to_iso(*time) == "2018-01-21T00:00:00.000Z";
  const std::string broken = is_fine ? "" : "; broken: build again";
  out.push_back(
      {is_fine, "leap seconds", fmt::format("until {}{}", day_of(leap_seconds_expire()), broken)});
  const EarthOrientationTable table = earth_orientation_table();
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  constexpr double unix_mjd = 40587;
  const double age_d = unix_mjd + now.count() / 86400 - mjd(table.measured_last);
  out.push_back({is_fine, "Earth orientation",
                 fmt::format("{} to {}, measured until {} ({:.0f} d ago), then predicted{}",
                             day_of(table.first), day_of(table.last), day_of(table.measured_last),
                             std::max(age_d, 0.0), broken)});
}

void add_formats(std::vector<Finding> &out) {
  out.push_back(
      {true, "meshes",
       fmt::format(".obj, .gltf, .glb, .stl, .ply, {}", fmt::join(other_mesh_suffixes(), ", "))});
  out.push_back({true, "orbits", "TLE, 3LE, OMM, OPM, OEM"});
  out.push_back({true, "tables", fmt::format("{}", fmt::join(table_suffixes(), ", "))});
  out.push_back({true, "pictures", ".png, .exr"});
  out.push_back({has_report(), "report",
                 has_report() ? "plotting script is built in"
                              : "no plotting script in this build: run tools/setup, build again"});
}

std::vector<Finding> examine() {
  std::vector<Finding> out;
  add_machine(out);
  add_library(out);
  add_tables_of_time(out);
  add_formats(out);
  return out;
}

Table table_of(const std::vector<Finding> &findings) {
  std::vector<std::string> what, found;
  std::vector<bool> is_fine;
  for (const Finding &finding : findings) {
    what.push_back(finding.what);
    found.push_back(finding.found);
    is_fine.push_back(finding.is_fine);
  }
  Table out;
  out.add("what", "", "what was looked at", std::move(what));
  out.add("found", "", "what it is", std::move(found));
  out.add("ok", "", "false where something does not work", std::move(is_fine));
  return out;
}

Result<int> run_doctor(const std::string &output, const Common &common) {
  UMOV_TRY(check_output(output));
  const std::vector<Finding> findings = examine();
  if (common.json || (!output.empty() && output != "-"))
    UMOV_TRY(put_table(output, table_of(findings), common));
  else
    for (const Finding &finding : findings)
      fmt::print("{:4} {:18} {}\n", finding.is_fine ? "ok" : "BAD", finding.what, finding.found);
  return std::ranges::all_of(findings, &Finding::is_fine) ? 0 : static_cast<int>(ErrorCode::Device);
}

} // namespace

void add_doctor(CLI::App &app, const Exit &exit_with) {
  auto *verb = app.add_subcommand("doctor", "Say what this build and machine can do");
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  add_table_output(*verb, *output);
  add_common(*verb, *common, true);
  verb->callback([common, output, exit_with] {
    const auto done = run_doctor(*output, *common);
    exit_with(done ? *done : report(done.error()));
  });
}

} // namespace umov::cli
