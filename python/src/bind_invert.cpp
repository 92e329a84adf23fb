// From light curves back to what made them, and the libraries that such questions look through.

#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/jobs/identify.h>
#include <umov/jobs/invert.h>
#include <umov/jobs/library.h>
#include <umov/jobs/plan.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;
using Request = jobs::InvertRequest;

/// Runs `question(monitor, diagnostics)` with Python looked after.
template <class Question> auto answer(nb::handle watch, Question question) {
  Attention attention(watch);
  auto made = attend(attention, question);
  attention.settle(was_interrupted(made));
  return take(std::move(made));
}

jobs::Inversion pose(const Scenario &scenario, const Request &request,
                     const jobs::JobOptions &options, nb::handle watch) {
  return answer(watch, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::invert_pose(scenario, request, options, monitor, diagnostics);
  });
}

/// `axis`: "x", "y", "z", or "" for any.
jobs::Inversion spin(const Scenario &scenario, const Request &request, double period_s,
                     bool has_aliases, const std::string &axis, const jobs::JobOptions &options,
                     nb::handle watch) {
  const jobs::SpinOptions known{period_s, has_aliases, axis.empty() ? '\0' : axis.front()};
  return answer(watch, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::invert_spin(scenario, request, known, options, monitor, diagnostics);
  });
}

jobs::Inversion track(const Scenario &scenario, const Request &request, const std::string &start,
                      double rate_noise, double rate_sd, const jobs::JobOptions &options,
                      nb::handle watch) {
  return answer(watch, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::invert_track(scenario, request, {start, rate_noise, rate_sd}, options, monitor,
                              diagnostics);
  });
}

jobs::Inversion material(const Scenario &scenario, const Request &request, const std::string &group,
                         const std::vector<std::string> &candidates,
                         const jobs::JobOptions &options, nb::handle watch) {
  return answer(watch, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::invert_material(scenario, request, {group, candidates}, options, monitor,
                                 diagnostics);
  });
}

jobs::Inversion health(const Scenario &scenario, const Request &request,
                       const std::vector<std::string> &drifts,
                       const std::vector<std::string> &baseline, double attitude_sd_deg,
                       const jobs::JobOptions &options, nb::handle watch) {
  return answer(watch, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::invert_health(scenario, request, {drifts, baseline, attitude_sd_deg}, options,
                               monitor, diagnostics);
  });
}

/// `request`: how the model is known; its observations are none. `snr` 0: of the instrument.
jobs::Inversion plan(const Scenario &scenario, const std::vector<std::string> &names,
                     const std::vector<const Scenario *> &scenarios,
                     const std::vector<double> &priors, const std::string &modes,
                     const Request &request, double snr, double sky_mag,
                     const jobs::JobOptions &options, nb::handle watch) {
  std::vector<jobs::PlanAlternative> alternatives;
  for (std::size_t k = 0; k < names.size(); ++k)
    alternatives.push_back({names[k], *scenarios[k], priors[k]});
  const jobs::PlanRequest asked{request.errors, request.method, snr, sky_mag,
                                request.allow_old_elements};
  return answer(
      watch,
      [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) -> Result<jobs::Inversion> {
        if (!modes.empty()) {
          UMOV_ASSIGN(open, jobs::alternatives_of_modes(scenario, modes));
          alternatives.insert(alternatives.end(), open.begin(), open.end());
        }
        return jobs::plan_observations(scenario, alternatives, asked, options, monitor,
                                       diagnostics);
      });
}

jobs::Inversion identify(const Scenario &scenario, const Request &request,
                         const std::string &library, const std::vector<std::string> &objects,
                         double none_prior, const jobs::JobOptions &options, nb::handle watch) {
  const jobs::IdentifyRequest asked{request, library, objects, none_prior};
  return answer(watch, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::identify_object(scenario, asked, options, monitor, diagnostics);
  });
}

Table build_library(const std::vector<std::string> &scenarios, const std::string &folder,
                    std::size_t cells, std::size_t first, std::size_t count,
                    const jobs::JobOptions &options, nb::handle watch) {
  const jobs::LibraryRequest request{scenarios, folder, cells, first, count};
  return answer(watch,
                [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
                  return jobs::build_library(request, options, monitor, diagnostics);
                })
      .table;
}

void bind_request(nb::module_ &m) {
  nb::class_<Request>(m, "InvertRequest",
                      "Observations, and how well they and the model are known.")
      .def(
          "__init__",
          [](Request *self, std::vector<std::string> observations, std::size_t grid,
             const std::string &method, bool allow_old_elements) {
            new (self) Request();
            self->observations = std::move(observations);
            self->grid = grid;
            self->method = method_from(method);
            self->allow_old_elements = allow_old_elements;
          },
          "observations"_a, "grid"_a, "method"_a, "allow_old_elements"_a)
      .def(
          "set_errors",
          [](Request &r, double floor, double zero_point_sd, double scale_sd, bool has_clouds,
             double outlier_share, bool has_polarization) {
            r.errors.floor = floor;
            r.errors.zero_point_sd = zero_point_sd;
            r.errors.scale_sd = scale_sd;
            r.errors.has_clouds = has_clouds;
            r.errors.outlier_share = outlier_share;
            r.errors.has_polarization = has_polarization;
          },
          "floor"_a, "zero_point_sd"_a, "scale_sd"_a, "has_clouds"_a, "outlier_share"_a,
          "has_polarization"_a)
      .def(
          "set_material_errors",
          [](Request &r, double slope_sd, double reflectance_sd, double haze_sd, double tilt_sd_deg,
             bool by_group, double largest_floor) {
            r.materials = {slope_sd, reflectance_sd, haze_sd, tilt_sd_deg, by_group};
            r.largest_floor = largest_floor;
          },
          "slope_sd"_a, "reflectance_sd"_a, "haze_sd"_a, "tilt_sd_deg"_a, "by_group"_a,
          "largest_floor"_a);
}

} // namespace

void bind_invert(nb::module_ &m) {
  bind_request(m);
  nb::class_<jobs::Inversion>(m, "Inversion", "A verdict and its tables.")
      .def_prop_ro("verdict", [](const jobs::Inversion &i) { return jobs::name_of(i.verdict); })
      .def_prop_ro("names",
                   [](const jobs::Inversion &i) {
                     std::vector<std::string> out;
                     for (const jobs::NamedTable &one : i.tables)
                       out.push_back(one.name);
                     return out;
                   })
      .def(
          "table", [](const jobs::Inversion &i, std::size_t k) { return &i.tables.at(k).table; },
          "k"_a, nb::rv_policy::reference_internal)
      .def_ro("summary", &jobs::Inversion::summary)
      .def_ro("json", &jobs::Inversion::json)
      .def_ro("page", &jobs::Inversion::page)
      .def_ro("state", &jobs::Inversion::state);
  m.def("invert_pose", &pose, "scenario"_a, "request"_a, "options"_a, "watch"_a.none());
  m.def("invert_spin", &spin, "scenario"_a, "request"_a, "period_s"_a, "has_aliases"_a, "axis"_a,
        "options"_a, "watch"_a.none());
  m.def("invert_track", &track, "scenario"_a, "request"_a, "start"_a, "rate_noise"_a, "rate_sd"_a,
        "options"_a, "watch"_a.none());
  m.def("invert_material", &material, "scenario"_a, "request"_a, "group"_a, "candidates"_a,
        "options"_a, "watch"_a.none());
  m.def("invert_health", &health, "scenario"_a, "request"_a, "drifts"_a, "baseline"_a,
        "attitude_sd_deg"_a, "options"_a, "watch"_a.none());
  m.def("invert_plan", &plan, "scenario"_a, "names"_a, "scenarios"_a, "priors"_a, "modes"_a,
        "request"_a, "snr"_a, "sky_mag"_a, "options"_a, "watch"_a.none());
  m.def("identify", &identify, "scenario"_a, "request"_a, "library"_a, "objects"_a, "none_prior"_a,
        "options"_a, "watch"_a.none());
  m.def("build_library", &build_library, "scenarios"_a, "folder"_a, "cells"_a, "first"_a, "count"_a,
        "options"_a, "watch"_a.none());
}

} // namespace umov::python
