// umov orbit show and convert: files of mean elements and CCSDS messages, read and written.

#include "console.h"
#include "verbs.h"

#include "tables.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/quantity.h>
#include <umov/core/text.h>
#include <umov/io/elements_file.h>
#include <umov/io/trajectory_file.h>
#include <umov/lightcurve/compute.h>

namespace umov::cli {
namespace {

struct ElementsOptions {
  std::string orbit, output, form, start, stop;
  int norad = 0;
  double step_s = 60;
  bool allow_bad_checksum = false, keep_going = false;
};

Result<std::vector<ElementSet>> read_sets(const ElementsOptions &o, const std::string &text,
                                          Diagnostics &diagnostics) {
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

/// One row per segment of a message.
Table segments_table(const ccsds::Message &message) {
  Table t;
  const auto add = [&](const char *name, const char *text,
                       std::initializer_list<const char *> keys) {
    std::vector<std::string> values;
    for (const ccsds::Segment &segment : message.segments) {
      std::string value;
      for (const char *key : keys)
        if (const ccsds::Field *field = ccsds::find(segment.metadata, key); value.empty() && field)
          value = field->text;
      values.push_back(value);
    }
    t.add(name, "", text, std::move(values));
  };
  add("name", "object, or participant of a tracking message", {"OBJECT_NAME", "PARTICIPANT_2"});
  add("object_id", "international designator", {"OBJECT_ID"});
  add("center", "centre of the frame", {"CENTER_NAME"});
  add("frame", "reference frame", {"REF_FRAME", "REF_FRAME_A"});
  add("time_system", "of all dates", {"TIME_SYSTEM"});
  add("start", "as written", {"USEABLE_START_TIME", "START_TIME"});
  add("stop", "as written", {"USEABLE_STOP_TIME", "STOP_TIME"});
  add("kind", "of attitude or interpolation", {"ATTITUDE_TYPE", "INTERPOLATION", "MODE"});
  std::vector<std::int64_t> counts;
  for (const ccsds::Segment &segment : message.segments)
    counts.push_back(static_cast<std::int64_t>(
        std::count_if(segment.data.begin(), segment.data.end(), [](const ccsds::Record &record) {
          return record.name != "comment" && record.name != "covarianceMatrix";
        })));
  t.add("records", "", "states, attitudes, observations or blocks of parameters",
        std::move(counts));
  t.note("message", fmt::format("CCSDS {} {}", ccsds::to_text(message.kind), message.version));
  return t;
}

std::string form_name(const ElementsOptions &o) {
  if (!o.form.empty() || o.output.empty() || o.output == "-")
    return o.form;
  const std::string suffix = std::filesystem::path(o.output).extension().string();
  return suffix.empty() ? suffix : suffix.substr(1);
}

Result<ElementsForm> wanted_form(const ElementsOptions &o) {
  constexpr std::pair<const char *, ElementsForm> known[] = {
      {"tle", ElementsForm::Tle},      {"3le", ElementsForm::Tle},    {"txt", ElementsForm::Tle},
      {"kvn", ElementsForm::OmmKvn},   {"omm", ElementsForm::OmmKvn}, {"xml", ElementsForm::OmmXml},
      {"json", ElementsForm::OmmJson}, {"csv", ElementsForm::OmmCsv}};
  const std::string name = form_name(o);
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

/// OPM, OEM, AEM and TDM between KVN and XML.
Result<std::string> converted_message(const ElementsOptions &o, const std::string &text,
                                      Diagnostics &diagnostics) {
  const std::string name = form_name(o);
  const bool is_kvn = name == "kvn" || name == "opm" || name == "aem" || name == "tdm";
  if (!is_kvn && name != "xml")
    return fail(
        ErrorCode::Usage,
        "a message is written as KVN or XML: give --to kvn or xml, or a file name that ends "
        "so");
  UMOV_ASSIGN(message, ccsds::read_message(text, o.orbit, diagnostics));
  return ccsds::write_message(message, is_kvn ? ccsds::Form::Kvn : ccsds::Form::Xml);
}

/// Any orbit as an ephemeris: states at even steps in TEME or the frame of its own.
Result<ccsds::Message> sampled_orbit(const ElementsOptions &o, const std::string &text,
                                     Diagnostics &diagnostics) {
  if (o.start.empty() || o.stop.empty())
    return fail(ErrorCode::Usage, "an ephemeris needs --start and --stop (and --step-s)");
  UMOV_ASSIGN(start, utc_from_iso(o.start));
  UMOV_ASSIGN(stop, utc_from_iso(o.stop));
  UMOV_ASSIGN(times, time_grid({start, stop, o.step_s}));
  UMOV_ASSIGN(orbit,
              read_trajectory(text, o.orbit,
                              {o.norad, start, stop, o.allow_bad_checksum, o.keep_going, true},
                              diagnostics));
  return oem_from(orbit, times, now());
}

int run_show(const ElementsOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<void> {
    UMOV_TRY(check_output(o.output));
    UMOV_ASSIGN(text, read_file(o.orbit));
    if (ccsds::is_message(text)) {
      UMOV_ASSIGN(message, ccsds::read_message(text, o.orbit, diagnostics));
      return put_table(o.output, segments_table(message), common);
    }
    UMOV_ASSIGN(sets, read_sets(o, text, diagnostics));
    return put_table(o.output, elements_table(sets), common);
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

int run_convert(const ElementsOptions &o, const Common &common) {
  Diagnostics diagnostics;
  const auto done = [&]() -> Result<void> {
    UMOV_ASSIGN(text, read_file(o.orbit));
    if (form_name(o) == "oem") {
      UMOV_ASSIGN(message, sampled_orbit(o, text, diagnostics));
      UMOV_ASSIGN(written, ccsds::write_message(message, ccsds::Form::Kvn));
      return put(o.output, written);
    }
    if (ccsds::is_message(text)) {
      UMOV_ASSIGN(written, converted_message(o, text, diagnostics));
      return put(o.output, written);
    }
    UMOV_ASSIGN(form, wanted_form(o));
    UMOV_ASSIGN(sets, read_sets(o, text, diagnostics));
    UMOV_ASSIGN(written, write_elements(sets, form, now(), diagnostics));
    return put(o.output, written);
  }();
  report(diagnostics, common);
  return done ? 0 : report(done.error());
}

void add_options(CLI::App &verb, ElementsOptions &o) {
  verb.add_option("--orbit", o.orbit, "TLE, 3LE, OMM, OEM, OPM, AEM or TDM file")->required();
  verb.add_option("--norad", o.norad, "Only the sets of this catalogue number");
  verb.add_flag("--allow-bad-checksum", o.allow_bad_checksum, "Read lines with a wrong checksum");
  verb.add_flag("--keep-going", o.keep_going, "Report bad sets and keep the others");
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
