// The main job: light curves of a scenario, in memory.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/jobs/run.h>
#include <umov/time/epoch.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

/// What a run computed, for Python.
struct Run {
  jobs::RunTables tables;
  std::vector<double> jd1, jd2;    ///< of every epoch, UTC
  std::vector<std::size_t> epochs; ///< of every object
  /// Of every object: its materials, and what each gives [epoch, material, band].
  std::vector<std::vector<std::string>> materials;
  std::vector<std::vector<double>> material_i;
  std::optional<Error> stopped;
};

Run run_of(jobs::RunResult result) {
  Run out;
  out.tables = jobs::run_tables(result);
  for (jobs::ObjectRun &one : result.objects) {
    const auto &epochs = one.outcome.curve.epochs;
    out.epochs.push_back(epochs.size());
    out.materials.push_back(one.outcome.curve.materials);
    out.material_i.push_back(std::move(one.outcome.curve.material_i));
    for (const LightCurveEpoch &epoch : epochs) {
      out.jd1.push_back(epoch.geometry.time.jd1);
      out.jd2.push_back(epoch.geometry.time.jd2);
    }
  }
  out.stopped = result.stopped;
  return out;
}

Run run(const Scenario &scenario, const jobs::JobOptions &options, nb::handle watch) {
  Attention attention(watch);
  auto result =
      attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) -> Result<Run> {
        UMOV_ASSIGN(objects, jobs::load_run(scenario, options, monitor, diagnostics));
        UMOV_ASSIGN(out,
                    jobs::compute_run(std::move(objects), scenario, options, monitor, diagnostics));
        return run_of(std::move(out));
      });
  attention.settle(was_interrupted(result) ||
                   (result && result->stopped && result->stopped->code == ErrorCode::Interrupted));
  return take(std::move(result));
}

nb::object view(nb::handle self, const std::vector<double> &values) {
  return nb::cast(View<double>(values.data(), {values.size()}, self));
}

nb::list contributions(nb::handle self) {
  const auto &run = nb::cast<const Run &>(self);
  nb::list out;
  for (std::size_t k = 0; k < run.epochs.size(); ++k) {
    const std::size_t cells = run.epochs[k] * run.materials[k].size();
    const std::size_t bands = cells > 0 ? run.material_i[k].size() / cells : 0;
    const View<double> values(run.material_i[k].data(),
                              {run.epochs[k], run.materials[k].size(), bands}, self);
    out.append(nb::make_tuple(run.materials[k], values));
  }
  return out;
}

} // namespace

void bind_run(nb::module_ &m) {
  nb::class_<jobs::JobOptions>(m, "JobOptions", "How a job runs, apart from its scenario.")
      .def(
          "__init__",
          [](jobs::JobOptions *self, unsigned threads, const std::string &mask_cache,
             bool allow_bad_checksum, bool allow_old_elements) {
            auto *options = new (self) jobs::JobOptions{};
            options->threads = threads;
            options->mask_cache = mask_cache;
            options->allow_bad_checksum = allow_bad_checksum;
            options->allow_old_elements = allow_old_elements;
          },
          "threads"_a, "mask_cache"_a, "allow_bad_checksum"_a, "allow_old_elements"_a)
      .def(
          "set_device",
          [](jobs::JobOptions &self, const std::string &device, const std::string &named,
             const std::vector<std::string> &environments) {
            self.device.choice =
                device == name_of(DeviceChoice::Cuda) ? DeviceChoice::Cuda : DeviceChoice::Auto;
            const std::vector<std::filesystem::path> where(environments.begin(),
                                                           environments.end());
            self.device.folders = device_folders(named, where);
            self.device.cache = self.mask_cache;
          },
          "device"_a, "named"_a, "environments"_a,
          "cuda or auto; folders with colons between them, and environments of Python, where "
          "drivers "
          "are looked for first.");
  nb::class_<Run>(m, "Run", "What a run computed.")
      .def_prop_ro(
          "light_curve", [](const Run &r) { return &r.tables.light_curve; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "passes", [](const Run &r) { return &r.tables.passes; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "jd1", [](nb::handle self) { return view(self, nb::cast<const Run &>(self).jd1); },
          nb::sig("def jd1(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro(
          "jd2", [](nb::handle self) { return view(self, nb::cast<const Run &>(self).jd2); },
          nb::sig("def jd2(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_ro("epochs", &Run::epochs)
      .def_prop_ro("contributions", &contributions,
                   nb::sig("def contributions(self) -> list[tuple[list[str], "
                           "numpy.typing.NDArray[numpy.float64]]]"))
      .def_prop_ro(
          "stopped", [](const Run &r) { return tuple_of(r.stopped ? &*r.stopped : nullptr); },
          nb::sig("def stopped(self) -> tuple[int, str, str, int, int] | None"));
  m.def("run", &run, "scenario"_a, "options"_a, "watch"_a.none());
}

} // namespace umov::python
