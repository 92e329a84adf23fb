// Stokes of many poses.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "block_size.h"
#include "errors.h"
#include "gil.h"
#include "options.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/core/parallel.h>
#include <umov/jobs/pose_light.h>
#include <umov/light/poses.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

/// Directions of a Python call and where the results go.
struct PoseArrays {
  const double *sun, *observer;
  std::size_t count;
  double *stokes, *half_width; ///< [pose, band, 4]; half_width may be null
  bool *is_dark;               ///< may be null
  std::uint8_t *method;        ///< may be null
};

Result<Vec3<Body>> direction_of(const double *xyz, const char *name, std::size_t row) {
  if (const auto direction = direction_along({xyz[0], xyz[1], xyz[2]}))
    return *direction;
  return fail(ErrorCode::BadInput,
              fmt::format("{}[{}] is ({}, {}, {}); a finite direction other than 0 was expected",
                          name, row, xyz[0], xyz[1], xyz[2]));
}

/// How many poses were lit, and why not all of them.
struct Lit {
  std::size_t done = 0;
  std::optional<Error> stopped;
};

/// A scene ready for directions.
class Light {
public:
  explicit Light(jobs::PoseLight light) : light_(std::move(light)) {}

  [[nodiscard]] const jobs::PoseLight &light() const { return light_; }
  /// By what the last poses took, so many are done before anybody would want to stop them.
  [[nodiscard]] bool is_short(std::size_t poses) const {
    constexpr double short_s = 0.01;
    return static_cast<double>(poses) * seconds_per_pose_ < short_s;
  }
  /// All poses, block by block; stopped where the monitor says so.
  Result<Lit> evaluate(const PoseArrays &arrays, unsigned threads, const jobs::Monitor &monitor) {
    const auto begin = Clock::now();
    // Light between surfaces is shared by the poses of a block: those of `umov signature`.
    BlockSize block(light_.options().bounces > 1 ? std::optional(light_.block()) : std::nullopt);
    std::vector<Pose> poses;
    StokesTable table;
    LightTask task;
    task.threads = threads;
    task.cancel = monitor.cancel;
    for (std::size_t done = 0; done < arrays.count; done += poses.size()) {
      const auto block_begin = Clock::now();
      poses.resize(std::min(block.size(), arrays.count - done));
      UMOV_TRY(take_poses(arrays, done, poses));
      if (monitor.is_cancelled() || !light_.evaluate(poses, table, task))
        return Lit{done, stopped_after(done, arrays.count)};
      put(table, done, threads, arrays);
      monitor.advance("poses", done + poses.size(), arrays.count);
      block.learn(seconds_since(block_begin));
    }
    if (arrays.count > 0)
      seconds_per_pose_ = seconds_since(begin) / static_cast<double>(arrays.count);
    return Lit{arrays.count, {}};
  }

private:
  Result<void> take_poses(const PoseArrays &arrays, std::size_t first,
                          std::vector<Pose> &poses) const {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::size_t row = first + i;
      UMOV_ASSIGN(sun, direction_of(arrays.sun + 3 * row, "sun", row));
      UMOV_ASSIGN(observer, direction_of(arrays.observer + 3 * row, "observer", row));
      poses[i] = {sun, observer, light_.sun_radius_rad()};
    }
    return {};
  }
  static void put(const StokesTable &table, std::size_t first, unsigned threads,
                  const PoseArrays &arrays) {
    const std::size_t bands = table.bands;
    constexpr std::size_t per_task = 8192;
    parallel_for((table.poses() + per_task - 1) / per_task, threads, [&](std::size_t part) {
      const std::size_t end = std::min(table.poses(), (part + 1) * per_task);
      for (std::size_t k = part * per_task * bands; k < end * bands; ++k) {
        double *const out = arrays.stokes + 4 * (first * bands + k);
        out[0] = table.i[k], out[1] = table.q[k], out[2] = table.u[k], out[3] = table.v[k];
        if (arrays.half_width == nullptr)
          continue;
        double *const err = arrays.half_width + 4 * (first * bands + k);
        err[0] = table.i_err[k], err[1] = table.q_err[k];
        err[2] = table.u_err[k], err[3] = table.v_err[k];
      }
      for (std::size_t i = part * per_task; i < end && arrays.is_dark != nullptr; ++i) {
        arrays.is_dark[first + i] = table.is_dark[i] != 0;
        arrays.method[first + i] = static_cast<std::uint8_t>(table.method[i]);
      }
    });
  }

  jobs::PoseLight light_;
  std::atomic<double> seconds_per_pose_{1e9};
};

/// Short calls run where they are; others so that Python can stop them.
Lit run_poses(Light &light, const PoseArrays &arrays, unsigned threads, nb::handle watch) {
  if (light.is_short(arrays.count)) {
    Result<Lit> done;
    {
      const WithoutGil free;
      done = light.evaluate(arrays, threads, {});
    }
    return take(std::move(done));
  }
  Attention attention(watch);
  auto done = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &) {
    return light.evaluate(arrays, threads, monitor);
  });
  attention.settle(done && done->stopped);
  return take(std::move(done));
}

std::size_t bands_of(const Light &light) { return light.light().model().scene().bands.size(); }

/// Stokes of the poses that were lit, and why there are not more.
nb::tuple stokes_of(Light &light, const Vectors &sun, const Vectors &observer, unsigned threads,
                    nb::handle watch) {
  const std::size_t count = sun.shape(0), bands = bands_of(light);
  const NewArray<double> stokes(count * bands * 4);
  const Lit lit =
      run_poses(light, {sun.data(), observer.data(), count, stokes.data, nullptr, nullptr, nullptr},
                threads, watch);
  return nb::make_tuple(stokes.shaped({lit.done, bands, 4}),
                        tuple_of(lit.stopped ? &*lit.stopped : nullptr));
}

/// The same with half-widths, darkness and method.
nb::tuple light_of(Light &light, const Vectors &sun, const Vectors &observer, unsigned threads,
                   nb::handle watch) {
  const std::size_t count = sun.shape(0), bands = bands_of(light);
  const NewArray<double> stokes(count * bands * 4), half_width(count * bands * 4);
  const NewArray<bool> is_dark(count);
  const NewArray<std::uint8_t> method(count);
  const Lit lit = run_poses(
      light,
      {sun.data(), observer.data(), count, stokes.data, half_width.data, is_dark.data, method.data},
      threads, watch);
  return nb::make_tuple(stokes.shaped({lit.done, bands, 4}),
                        half_width.shaped({lit.done, bands, 4}), is_dark.shaped({lit.done}),
                        method.shaped({lit.done}), tuple_of(lit.stopped ? &*lit.stopped : nullptr));
}

void make_light_for(Light *self, const Scenario &scenario, const std::optional<std::string> &method,
                    const std::optional<double> &accuracy, const std::vector<double> &laser,
                    const std::vector<std::string> &temperatures, const std::string &mask_file,
                    const jobs::JobOptions &options, nb::handle watch) {
  jobs::SignatureRequest request;
  if (method)
    request.method = method_from(*method);
  request.accuracy = accuracy;
  request.temperatures = temperatures;
  request.mask_file = mask_file;
  if (!laser.empty()) {
    request.source = jobs::SignatureRequest::Source::Laser;
    request.state = {laser[0], laser[1], laser[2], laser[3]};
  } else if (!temperatures.empty()) {
    request.source = jobs::SignatureRequest::Source::Thermal;
  }
  Attention attention(watch);
  auto made = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    auto light = jobs::PoseLight::make(scenario, request, options, diagnostics, monitor.cancel);
    if (light)
      jobs::tell_of_device(light->model().device(), diagnostics);
    return light;
  });
  attention.settle(was_interrupted(made));
  new (self) Light(take(std::move(made)));
}

nb::dict facts_of(const Light &light) {
  const LightFacts &facts = light.light().model().facts();
  nb::dict out;
  out["method"] = name_of(facts.method);
  out["is_convex"] = facts.is_convex;
  out["triangles"] = facts.triangles;
  out["classes"] = facts.classes;
  out["visibility"] = facts.visibility;
  out["instruction_set"] = light.light().model().instruction_set();
  out["device"] = light.light().model().device();
  out["mask_bytes"] = light.light().model().mask_bytes();
  out["setup_s"] = facts.setup_s;
  return out;
}

/// [2, count, 3]: directions of the Sun and of the observer.
nb::ndarray<nb::numpy, double, nb::c_contig>
random_directions(std::size_t count, double phase_deg, std::uint64_t seed, std::size_t first) {
  if (first + count < count)
    throw Failure({ErrorCode::Usage, "first and count are too large together", {}});
  const jobs::PoseList list = take(jobs::random_poses(first + count, {phase_deg}, seed));
  const NewArray<double> out(count * 6);
  constexpr std::size_t at_once = 1u << 14;
  const auto fill = [&](std::size_t part) {
    for (std::size_t i = part * at_once; i < std::min(count, (part + 1) * at_once); ++i) {
      const Pose pose = list.at(first + i);
      for (const auto &[at, v] : {std::pair{i, pose.sun}, {count + i, pose.observer}}) {
        out.data[3 * at] = v.x;
        out.data[3 * at + 1] = v.y;
        out.data[3 * at + 2] = v.z;
      }
    }
  };
  in_parts((count + at_once - 1) / at_once, fill);
  return out.shaped({2, count, 3});
}

} // namespace

void bind_light(nb::module_ &m) {
  nb::class_<Light>(m, "Light", "A scene ready to be lit from any direction.")
      .def("__init__", &make_light_for, "scenario"_a, "method"_a.none(), "accuracy"_a.none(),
           "laser"_a, "temperatures"_a, "mask_file"_a, "options"_a, "watch"_a.none())
      .def("stokes", &stokes_of, "sun"_a, "observer"_a, "threads"_a, "watch"_a.none(),
           nb::sig("def stokes(self, sun: numpy.typing.NDArray[numpy.float64], observer: "
                   "numpy.typing.NDArray[numpy.float64], threads: int, watch: object | None) -> "
                   "tuple[numpy.typing.NDArray[numpy.float64], "
                   "tuple[int, str, str, int, int] | None]"))
      .def(
          "light", &light_of, "sun"_a, "observer"_a, "threads"_a, "watch"_a.none(),
          nb::sig("def light(self, sun: numpy.typing.NDArray[numpy.float64], observer: "
                  "numpy.typing.NDArray[numpy.float64], threads: int, watch: object | None) -> "
                  "tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], "
                  "numpy.typing.NDArray[numpy.bool_], numpy.typing.NDArray[numpy.uint8], "
                  "tuple[int, str, str, int, int] | None]"))
      .def_prop_ro("facts", &facts_of, nb::sig("def facts(self) -> dict[str, typing.Any]"))
      .def_prop_ro("materials",
                   [](const Light &light) { return light.light().model().materials(); })
      .def("keep_masks", [](const Light &light) { take(light.light().model().keep_masks()); });
  m.def("random_directions", &random_directions, "count"_a, "phase_deg"_a, "seed"_a, "first"_a);
}

} // namespace umov::python
