// Scenarios: read, checked and written by the library.

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "gil.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/io/scenario.h>
#include <umov/io/sites.h>
#include <umov/time/epoch.h>
#include <umov/time/typed.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

std::vector<std::pair<std::string, double>> bands_of(const Scenario &scenario) {
  std::vector<std::pair<std::string, double>> out;
  for (const Band &band : scenario.bands)
    out.emplace_back(band.name, band.wavelength.nm());
  return out;
}

std::vector<std::string> objects_of(const Scenario &scenario) {
  std::vector<std::string> out;
  for (const ScenarioObject &object : scenario.objects)
    out.push_back(object.name);
  return out;
}

/// Keys of [render] that nobody gave: an engine of many poses fills them in otherwise than a light
/// curve.
std::vector<std::string> unsaid_of(const Scenario &scenario) {
  std::vector<std::string> out;
  if (!scenario.places.contains("render.accuracy"))
    out.emplace_back("accuracy");
  if (!scenario.light.accuracy_floor)
    out.emplace_back("accuracy_floor");
  return out;
}

SiteTuple site_tuple(const Site &site) {
  return nb::borrow<SiteTuple>(nb::make_tuple(site.name, site.latitude.degrees(),
                                              site.longitude.degrees(), site.altitude_m));
}

} // namespace

void bind_scenario(nb::module_ &m) {
  nb::class_<Scenario>(m, "Scenario", "A scenario with all defaults filled in.")
      .def_static(
          "read",
          [](const std::string &path, const std::vector<std::string> &changes) {
            const WithoutGil free;
            return take(read_scenario(path, changes));
          },
          "path"_a, "changes"_a)
      .def_static(
          "parse",
          [](const std::string &text, const std::string &path,
             const std::vector<std::string> &changes) {
            const WithoutGil free;
            return take(read_scenario_text(text, path, changes));
          },
          "text"_a, "path"_a, "changes"_a)
      .def_prop_ro("locked", [](const Scenario &s) { return locked_scenario(s); })
      .def_ro("file", &Scenario::file)
      .def_ro("title", &Scenario::title)
      .def_ro("seed", &Scenario::seed)
      .def_prop_ro("unsaid", &unsaid_of)
      .def_prop_ro("objects", &objects_of)
      .def_prop_ro("bands", &bands_of)
      .def("check_for_run", [](const Scenario &s) { take(check_complete_for_run(s)); });
  m.def("schema", &scenario_schema_json);
  m.def("site_names", &site_names);
  m.def(
      "site", [](const std::string &text) { return site_tuple(take(site_from(text))); }, "text"_a);
  m.def(
      "check_site",
      [](const std::string &name, double lat_deg, double lon_deg, double alt_m) {
        return site_tuple(take(make_site(name, lat_deg, lon_deg, alt_m)));
      },
      "name"_a, "lat_deg"_a, "lon_deg"_a, "alt_m"_a);
  m.def(
      "check_time",
      [](const std::string &text) { return to_iso_exact(take(utc_from_iso_or_day(text))); },
      "text"_a);
}

} // namespace umov::python
