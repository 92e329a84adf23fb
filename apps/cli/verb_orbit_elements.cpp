// umov orbit show and convert: files of mean elements, read and written.

#include "console.h"
#include "verbs.h"

#include "tables.h"
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>

namespace umov::cli {
namespace {

struct ElementsOptions {
  std::string orbit, output, form;
  int norad = 0;
  bool allow_bad_checksum = false, keep_going = false;
};

Result<std::vector<ElementSet>> read_sets(const ElementsOptions &o, Diagnostics &diagnostics) {
  UMOV_ASSIGN(text, read_file(o.orbit));
  UMOV_ASSIGN(sets,
              read_elements(text, o.orbit, {o.allow_bad_checksum, o.keep_going}, diagnostics));
  if (o.norad == 0)
    return sets;
  std::erase_if(sets, [&](const ElementSet &set) { return set.norad_cat_id != o.norad; });
  if (sets.empty())
    return fail(ErrorCode::BadInput, fmt::format("holds no object {}", o.norad), {o.orbit});
  return sets;
}

/// Semi-major axis [km] of the mean motion as published, WGS 72.
double semi_major_axis_km(const ElementSet &set) {
  constexpr double gm = 398600.8; // km3/s2
  const double n = set.mean_motion / 60;
  return std::cbrt(gm / (n * n));
}

Table elements_table(const std::vector<ElementSet> &sets) {
  using E = const ElementSet &;
  Table t;
  std::vector<std::string> names, ids, epochs;
  std::vector<std::int64_t> numbers;
  for (E e : sets) {
    names.push_back(e.name);
    numbers.push_back(e.norad_cat_id);
    ids.push_back(e.international_designator);
    epochs.push_back(to_iso_exact(e.epoch));
  }
  t.add("name", "", "as in the file", std::move(names));
  t.add("norad_cat_id", "", "catalogue number", std::move(numbers));
  t.add("object_id", "", "international designator", std::move(ids));
  t.add("epoch_utc", "", "of the elements", std::move(epochs));
  const auto add = [&](const char *name, const char *unit, const char *text, auto take) {
    std::vector<double> values;
    for (E e : sets)
      values.push_back(take(e));
    t.add(name, unit, text, std::move(values));
  };
  constexpr double earth_radius_km = 6378.135; // WGS 72
  const auto degrees = [](double radians) {
    return parse_number(degrees_text(Angle::radians(radians))).value_or(0); // as printed
  };
  add("mean_motion", "1 / d", "revolutions, Kozai",
      [](E e) { return e.mean_motion / (2 * pi / 1440); });
  add("eccentricity", "", "mean", [](E e) { return e.eccentricity; });
  add("inclination", "deg", "mean, TEME", [&](E e) { return degrees(e.inclination); });
  add("raan", "deg", "right ascension of the node, TEME", [&](E e) { return degrees(e.raan); });
  add("arg_of_pericenter", "deg", "mean", [&](E e) { return degrees(e.argument_of_perigee); });
  add("mean_anomaly", "deg", "mean", [&](E e) { return degrees(e.mean_anomaly); });
  add("bstar", "", "drag term, per Earth radius", [](E e) { return e.bstar; });
  add("period", "min", "of the mean motion", [](E e) { return 2 * pi / e.mean_motion; });
  add("perigee_alt", "km", "above a sphere of 6378.135 km, mean",
      [](E e) { return semi_major_axis_km(e) * (1 - e.eccentricity) - earth_radius_km; });
  add("apogee_alt", "km", "above a sphere of 6378.135 km, mean",
      [](E e) { return semi_major_axis_km(e) * (1 + e.eccentricity) - earth_radius_km; });
  return t;
}

Result<ElementsForm> wanted_form(const ElementsOptions &o) {
  constexpr std::pair<const char *, ElementsForm> known[] = {
      {"tle", ElementsForm::Tle},      {"3le", ElementsForm::Tle},    {"txt", ElementsForm::Tle},
      {"kvn", ElementsForm::OmmKvn},   {"omm", ElementsForm::OmmKvn}, {"xml", ElementsForm::OmmXml},
      {"json", ElementsForm::OmmJson}, {"csv", ElementsForm::OmmCsv}};
  std::string name = o.form;
  if (name.empty() && !o.output.empty() && o.output != "-")
    if (const std::string suffix = std::filesystem::path(o.output).extension().string();
        !suffix.empty())
      name = suffix.substr(1);
  for (const auto &[text, form] : known)
    if (name == text)
      return form;
  return fail(ErrorCode::Usage,
              fmt::format("{}: give --to tle, kvn, xml, json or csv, or a file name that ends so",
                          o.output.empty() ? "no form to write" : "-o " + o.output));
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
    UMOV_ASSIGN(sets, read_sets(o, diagnostics));
    return put_table(o.output, elements_table(sets), common);
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

int run_convert(const ElementsOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<void> {
    UMOV_ASSIGN(form, wanted_form(o));
    UMOV_ASSIGN(sets, read_sets(o, diagnostics));
    UMOV_ASSIGN(text, write_elements(sets, form, now(), diagnostics));
    return put(o.output, text);
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

void add_options(CLI::App &verb, ElementsOptions &o) {
  verb.add_option("--orbit", o.orbit, "TLE, 3LE or OMM (KVN, XML, JSON, CSV) file")->required();
  verb.add_option("--norad", o.norad, "Only the sets of this catalogue number");
  verb.add_flag("--allow-bad-checksum", o.allow_bad_checksum, "Read lines with a wrong checksum");
  verb.add_flag("--keep-going", o.keep_going, "Report bad sets and keep the others");
}

} // namespace

void add_orbit_show(CLI::App &orbit, const Exit &exit_with) {
  auto *verb = orbit.add_subcommand("show", "Elements of every object of a file, as a table");
  auto o = std::make_shared<ElementsOptions>();
  auto common = std::make_shared<Common>();
  add_options(*verb, *o);
  verb->add_option("-o,--output", o->output, "Table: .csv, .ecsv, .fits or .json by its suffix");
  add_common(*verb, *common, true);
  verb->callback([o, common, exit_with] { exit_with(run_show(*o, *common)); });
}

void add_orbit_convert(CLI::App &orbit, const Exit &exit_with) {
  auto *verb = orbit.add_subcommand("convert", "Elements from one form to another");
  auto o = std::make_shared<ElementsOptions>();
  auto common = std::make_shared<Common>();
  add_options(*verb, *o);
  verb->add_option("-o,--output", o->output,
                   "File: .tle, .kvn, .xml, .json or .csv; without it the text is printed");
  verb->add_option("--to", o->form, "tle, kvn, xml, json or csv, whatever the file's name");
  add_common(*verb, *common, false);
  verb->callback([o, common, exit_with] { exit_with(run_convert(*o, *common)); });
}

} // namespace umov::cli
