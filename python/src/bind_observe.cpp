// What an instrument records, and what its counts tell.

#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/core/quantity.h>
#include <umov/jobs/calibrate.h>
#include <umov/jobs/exposure.h>
#include <umov/jobs/measurement_files.h>
#include <umov/jobs/observe.h>
#include <umov/jobs/period.h>
#include <umov/jobs/reduce.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

/// Frames go into the folder `frames`, which is there, or nowhere if it is "".
jobs::Observation observe(const Scenario &scenario, const jobs::JobOptions &options,
                          const std::string &frames, nb::handle watch) {
  jobs::FrameSink take_frame;
  if (!frames.empty())
    take_frame = [&frames](const std::string &name, const FitsImage &image) {
      return write_fits_image(std::filesystem::path(frames) / name, image);
    };
  Attention attention(watch);
  auto made = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::observe(scenario, options, monitor, diagnostics, take_frame);
  });
  attention.settle(was_interrupted(made));
  return take(std::move(made));
}

/// `counts` and `calibration` are texts that stand for files of the names beside them.
Table reduce(const std::string &counts, const std::string &counts_path,
             const std::optional<std::string> &calibration, const std::string &calibration_path,
             const jobs::ReduceOptions &given, nb::handle watch) {
  Attention attention(watch);
  auto made = attend(
      attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) -> Result<Table> {
        jobs::ReduceOptions options = given;
        UMOV_ASSIGN(rows, read_counts_text(counts, counts_path, diagnostics));
        if (calibration) {
          UMOV_ASSIGN(file, read_calibration_text(*calibration, calibration_path));
          UMOV_TRY(jobs::check_calibration(file, rows, calibration_path, diagnostics));
          options.calibration = file.calibration;
          options.photometry = file.photometry;
        }
        return jobs::reduce(rows, options, monitor, diagnostics);
      });
  attention.settle(was_interrupted(made));
  return take(std::move(made));
}

/// `text` stands for a file of that path.
Table period(const std::string &text, const std::string &path, const std::string &band,
             std::size_t peaks, std::pair<double, double> reach_s,
             std::pair<double, double> gap_s_and_chance, nb::handle watch) {
  Attention attention(watch);
  auto made =
      attend(attention, [&](const jobs::Monitor &, Diagnostics &diagnostics) -> Result<Table> {
        UMOV_ASSIGN(rows, read_observations_text(text, path, diagnostics));
        const auto [gap_s, chance] = gap_s_and_chance;
        return jobs::period(rows, {band, peaks, reach_s.first, reach_s.second, gap_s, chance},
                            diagnostics);
      });
  attention.settle(false);
  return take(std::move(made));
}

/// The magnitudes that `period` looks at.
Table brightness(const std::string &text, const std::string &path, const std::string &band,
                 double gap_s, nb::handle watch) {
  Attention attention(watch);
  auto made =
      attend(attention, [&](const jobs::Monitor &, Diagnostics &diagnostics) -> Result<Table> {
        UMOV_ASSIGN(rows, read_observations_text(text, path, diagnostics));
        jobs::PeriodRequest request;
        request.band = band;
        request.gap_s = gap_s;
        return jobs::brightness(rows, request, diagnostics);
      });
  attention.settle(false);
  return take(std::move(made));
}

/// The text of a file in which others take the magnitudes of `stokes`; `counts` as for reduce.
std::string measurements(const Table &stokes, const std::string &counts,
                         const std::string &counts_path, const std::string &form,
                         const std::string &ecsv, const std::string &created_utc,
                         nb::handle watch) {
  Attention attention(watch);
  auto made = attend(
      attention, [&](const jobs::Monitor &, Diagnostics &diagnostics) -> Result<std::string> {
        UMOV_ASSIGN(rows, read_counts_text(counts, counts_path, diagnostics));
        const jobs::MeasurementNotes notes{rows.notes, ecsv, created_utc};
        return form == "tdm" ? jobs::as_tdm(stokes, notes) : jobs::score_text(stokes, notes);
      });
  attention.settle(false);
  return take(std::move(made));
}

std::string calibrate(const std::string &counts, const std::string &counts_path,
                      const std::string &standards, const std::string &standards_path,
                      bool has_second_order, nb::handle watch) {
  Attention attention(watch);
  auto made = attend(
      attention, [&](const jobs::Monitor &, Diagnostics &diagnostics) -> Result<std::string> {
        UMOV_ASSIGN(rows, read_counts_text(counts, counts_path, diagnostics));
        UMOV_ASSIGN(stars, read_standards_text(standards, standards_path));
        UMOV_ASSIGN(found, jobs::calibrate(rows, stars, has_second_order, diagnostics));
        return calibration_as_toml(found);
      });
  attention.settle(false);
  return take(std::move(made));
}

Table calibrate_channels(const std::string &counts, const std::string &path, nb::handle watch) {
  Attention attention(watch);
  auto made =
      attend(attention, [&](const jobs::Monitor &, Diagnostics &diagnostics) -> Result<Table> {
        UMOV_ASSIGN(rows, read_polarizer_text(counts, path));
        return jobs::calibrate_channels(rows, diagnostics);
      });
  attention.settle(false);
  return take(std::move(made));
}

void bind_options(nb::module_ &m) {
  nb::class_<jobs::ReduceOptions>(m, "ReduceOptions", "How counts are reduced.")
      .def(
          "__init__",
          [](jobs::ReduceOptions *self, double period_s, int harmonics, double knot_s,
             const std::map<std::string, double> &errors, std::optional<double> colour,
             unsigned threads) {
            new (self) jobs::ReduceOptions();
            self->period_s = period_s;
            self->harmonics = harmonics;
            self->knot_s = knot_s;
            for (const jobs::ReducePrior &prior : jobs::reduce_priors())
              prior.of(*self) = errors.at(prior.name) * prior.unit;
            self->colour = colour;
            self->threads = threads;
          },
          "period_s"_a, "harmonics"_a, "knot_s"_a, "errors"_a, "colour"_a.none(), "threads"_a);
  nb::class_<jobs::ExposureRequest>(m, "ExposureRequest", "How bright, how high, how exact.")
      .def(nb::init<>())
      .def_rw("instrument", &jobs::ExposureRequest::instrument)
      .def_rw("mag", &jobs::ExposureRequest::mag)
      .def_rw("altitude_deg", &jobs::ExposureRequest::altitude_deg)
      .def_rw("height_m", &jobs::ExposureRequest::height_m)
      .def_rw("sd_p", &jobs::ExposureRequest::sd_p)
      .def_prop_rw(
          "magnitudes",
          [](const jobs::ExposureRequest &r) { return std::string(name_of(r.magnitudes)); },
          [](jobs::ExposureRequest &r, const std::string &name) {
            r.magnitudes = name == "Vega" ? MagnitudeSystem::Vega
                           : name == "ST" ? MagnitudeSystem::ST
                                          : MagnitudeSystem::AB;
          })
      .def_rw("aperture_fwhm", &jobs::ExposureRequest::aperture_fwhm)
      .def_rw("band", &jobs::ExposureRequest::band)
      .def_rw("nm", &jobs::ExposureRequest::nm)
      .def_rw("width_nm", &jobs::ExposureRequest::width_nm)
      .def_rw("sky_mag", &jobs::ExposureRequest::sky_mag)
      .def_rw("seeing_arcsec", &jobs::ExposureRequest::seeing_arcsec)
      .def_rw("exposure_s", &jobs::ExposureRequest::exposure_s)
      .def_rw("change_per_s", &jobs::ExposureRequest::change_per_s);
}

} // namespace

void bind_observe(nb::module_ &m) {
  bind_options(m);
  nb::class_<jobs::Observation>(m, "Observation", "Counts and truth.")
      .def_prop_ro(
          "counts", [](const jobs::Observation &o) { return &o.counts; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "truth", [](const jobs::Observation &o) { return &o.truth; },
          nb::rv_policy::reference_internal)
      .def_ro("exposures", &jobs::Observation::exposures)
      .def_ro("saturated", &jobs::Observation::saturated)
      .def_ro("frames", &jobs::Observation::frames);
  m.def("observe", &observe, "scenario"_a, "options"_a, "frames"_a, "watch"_a.none());
  m.def("reduce", &reduce, "counts"_a, "counts_path"_a, "calibration"_a.none(),
        "calibration_path"_a, "options"_a, "watch"_a.none());
  m.def(
      "check_calibration",
      [](const std::string &text, const std::string &path) {
        take(read_calibration_text(text, path));
      },
      "text"_a, "path"_a);
  m.def("calibrate", &calibrate, "counts"_a, "counts_path"_a, "standards"_a, "standards_path"_a,
        "second_order"_a, "watch"_a.none());
  m.def("calibrate_channels", &calibrate_channels, "counts"_a, "path"_a, "watch"_a.none());
  m.def("standards_names", &standards_names);
  m.def(
      "standards_text", [](const std::string &name) { return take(standards_text(name)); },
      "name"_a);
  m.def("period", &period, "text"_a, "path"_a, "band"_a, "peaks"_a, "reach_s"_a, "gap_s"_a,
        "watch"_a.none());
  m.def("brightness", &brightness, "text"_a, "path"_a, "band"_a, "gap_s"_a, "watch"_a.none());
  m.def("measurements", &measurements, "stokes"_a, "counts"_a, "counts_path"_a, "form"_a, "ecsv"_a,
        "created_utc"_a, "watch"_a.none());
  m.def("exposure",
        [](const jobs::ExposureRequest &request) { return take(jobs::exposure(request)); });
  m.def("instrument_list", [] { return take(jobs::instrument_list()); });
  m.def(
      "instrument",
      [](const std::string &name) { return instrument_as_toml(take(read_instrument(name))); },
      "name"_a);
}

} // namespace umov::python
