// Passes over a site, and where an object stands.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/jobs/ephemeris.h>
#include <umov/jobs/passes.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;
using Body = jobs::PassModel::Body;

/// Rows of a job that may have been stopped.
struct Rows {
  Table table;
  std::optional<Error> stopped;
};

ShadowModel shadow_from(const std::string &word) {
  return word == "sphere" ? ShadowModel::Sphere : ShadowModel::Ellipsoid;
}

jobs::PassOrder order_from(const std::string &word) {
  return word == "mag"   ? jobs::PassOrder::Magnitude
         : word == "alt" ? jobs::PassOrder::Altitude
                         : jobs::PassOrder::Rise;
}

/// Rows of a job, run off the calling thread; a stop leaves those that were done.
template <class Job> Rows rows_of(nb::handle watch, const Job &job) {
  Attention attention(watch);
  Result<Rows> result = attend(attention, job);
  attention.settle(was_interrupted(result) ||
                   (result && result->stopped && result->stopped->code == ErrorCode::Interrupted));
  return take(std::move(result));
}

Rows find_passes_of(const jobs::PassesRequest &request, const jobs::JobOptions &options,
                    nb::handle watch) {
  return rows_of(watch,
                 [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) -> Result<Rows> {
                   UMOV_ASSIGN(found, jobs::passes(request, options, monitor, diagnostics));
                   return Rows{jobs::passes_table(request, found), found.stopped};
                 });
}

Rows ephemeris_of(const jobs::EphemerisRequest &request, const jobs::JobOptions &options,
                  nb::handle watch) {
  return rows_of(watch,
                 [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) -> Result<Rows> {
                   UMOV_ASSIGN(out, jobs::ephemeris(request, options, monitor, diagnostics));
                   return Rows{std::move(out.table), out.error};
                 });
}

/// The site and span that every request of this file has.
template <class Request>
void set_place(Request &request, const SiteTuple &site, const std::string &start,
               const std::string &stop, const std::string &shadow) {
  request.site = take(make_site(nb::cast<std::string>(site[0]), nb::cast<double>(site[1]),
                                nb::cast<double>(site[2]), nb::cast<double>(site[3])));
  request.start = take(utc_from_iso(start));
  request.stop = take(utc_from_iso(stop));
  request.shadow = shadow_from(shadow);
}

} // namespace

void bind_passes(nb::module_ &m) {
  nb::class_<Rows>(m, "Rows", "Rows of a job, and why there are not more.")
      .def_prop_ro(
          "table", [](const Rows &r) { return &r.table; }, nb::rv_policy::reference_internal)
      .def_prop_ro(
          "stopped", [](const Rows &r) { return tuple_of(r.stopped ? &*r.stopped : nullptr); },
          nb::sig("def stopped(self) -> tuple[int, str, str, int, int] | None"));
  m.def(
      "passes",
      [](const std::string &orbit, const std::vector<int> &norad, const SiteTuple &site,
         const std::string &start, const std::string &stop, double alt_min_deg,
         double sun_alt_max_deg, const std::string &shadow, bool visible_only,
         std::optional<double> mag_max, const std::string &sort, const Scenario *scene,
         const std::string &band, const jobs::JobOptions &options, nb::handle watch) {
        jobs::PassesRequest request;
        set_place(request, site, start, stop, shadow);
        request.orbit = orbit;
        request.norad = norad;
        request.altitude_min = Angle::degrees(alt_min_deg);
        request.sun_altitude_max = Angle::degrees(sun_alt_max_deg);
        request.is_visible_only = visible_only;
        request.magnitude_max = mag_max;
        request.order = order_from(sort);
        if (scene != nullptr)
          request.model.scene = *scene;
        request.model.band = band;
        return find_passes_of(request, options, watch);
      },
      "orbit"_a, "norad"_a, "site"_a, "start"_a, "stop"_a, "alt_min_deg"_a, "sun_alt_max_deg"_a,
      "shadow"_a, "visible_only"_a, "mag_max"_a.none(), "sort"_a, "scene"_a.none(), "band"_a,
      "options"_a, "watch"_a.none());
  m.def(
      "ephemeris",
      [](const std::string &orbit, int norad, const SiteTuple &site, const std::string &start,
         const std::string &stop, double step_s, const std::string &shadow,
         const jobs::JobOptions &options, nb::handle watch) {
        jobs::EphemerisRequest request;
        set_place(request, site, start, stop, shadow);
        request.orbit = orbit;
        request.norad = norad;
        request.step_s = step_s;
        return ephemeris_of(request, options, watch);
      },
      "orbit"_a, "norad"_a, "site"_a, "start"_a, "stop"_a, "step_s"_a, "shadow"_a, "options"_a,
      "watch"_a.none());
}

} // namespace umov::python
