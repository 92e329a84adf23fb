// Geometric sums of poses, which other materials and bands may be applied to.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "block_size.h"
#include "errors.h"
#include "options.h"

#include <algorithm>
#include <cstring>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <umov/jobs/requests.h>
#include <umov/light/light_sums.h>
#include <umov/light/poses.h>
#include <umov/scene/pose.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

/// One object, and the sums of poses that it was asked for.
class Sums {
public:
  Sums(const Scenario &scenario, const std::vector<Scenario> &others,
       const jobs::JobOptions &options, nb::handle watch) {
    Attention attention(watch);
    auto made = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
      return make(scenario, others, options, monitor, diagnostics);
    });
    attention.settle(was_interrupted(made));
    light_ = take(std::move(made));
    sun_radius_rad_ = scenario.has_solar_disk ? sun_radius_at_1au_rad : 0;
  }

  [[nodiscard]] const LightSums &light() const { return *light_; }
  [[nodiscard]] double sun_radius_rad() const { return sun_radius_rad_; }

private:
  static Result<std::unique_ptr<LightSums>>
  make(const Scenario &scenario, const std::vector<Scenario> &others,
       const jobs::JobOptions &options, const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    const LoadOptions stoppable{.turns_in_time = false, .cancel = monitor.cancel};
    UMOV_ASSIGN(object, load_object(scenario, 0, stoppable, diagnostics));
    SumsOptions how;
    how.mask_cache = options.mask_cache;
    how.threads = options.threads;
    how.device = options.device;
    for (const Scenario &other : others) {
      UMOV_ASSIGN(loaded, load_object(other, 0, stoppable, diagnostics));
      how.hypotheses.push_back(std::move(loaded.scene));
    }
    UMOV_ASSIGN(sums, make_sums(object.scene, how, monitor.cancel));
    jobs::tell_of_device(sums->device(), diagnostics);
    return std::move(sums);
  }
  std::unique_ptr<LightSums> light_;
  double sun_radius_rad_ = 0;
};

/// Sums of poses, whose memory the arrays share.
struct Abundances {
  AbundanceTable table;
  std::optional<Error> stopped; ///< why there are not more
};

/// Poses [first, first + poses.size()) of arrays.
Result<void> take_poses(const Vectors &sun, const Vectors &observer, std::size_t first,
                        double sun_radius_rad, std::vector<Pose> &poses) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t row = first + i;
    const double *const s = sun.data() + 3 * row, *const o = observer.data() + 3 * row;
    const auto to_sun = direction_along({s[0], s[1], s[2]});
    const auto to_observer = direction_along({o[0], o[1], o[2]});
    if (!to_sun || !to_observer)
      return fail(ErrorCode::BadInput,
                  std::string(to_sun ? "observer[" : "sun[") + std::to_string(row) +
                      "] has no direction; three finite numbers other than 0 were expected");
    poses[i] = {*to_sun, *to_observer, sun_radius_rad};
  }
  return {};
}

/// Adds a block's sums to those of the blocks before; the first makes room for all.
void append(AbundanceTable &&block, std::size_t count, AbundanceTable &out) {
  const auto put = [count](auto &&from, auto &to, std::size_t width) {
    if (to.empty())
      to.reserve(count * width);
    to.insert(to.end(), from.begin(), from.end());
  };
  out.columns = std::move(block.columns);
  const std::size_t width = out.columns.size();
  put(block.sum, out.sum, width);
  put(block.half_width, out.half_width, width);
  put(block.bias, out.bias, width);
  put(block.cos_phase, out.cos_phase, 1);
  put(block.has_plane, out.has_plane, 1);
  put(block.is_dark, out.is_dark, 1);
}

/// All poses, block by block; what is done where the monitor says so.
Result<Abundances> sum_up(const Sums &sums, const Vectors &sun, const Vectors &observer,
                          unsigned threads, const jobs::Monitor &monitor) {
  const std::size_t count = sun.shape(0);
  BlockSize block;
  std::vector<Pose> poses;
  Abundances out;
  std::size_t done = 0;
  do { // no poses at all have columns too
    const auto begin = Clock::now();
    poses.resize(std::min(block.size(), count - done));
    UMOV_TRY(take_poses(sun, observer, done, sums.sun_radius_rad(), poses));
    AbundanceTable table;
    const auto lit = sums.light().evaluate(poses, table, threads, monitor.cancel);
    if (!lit && lit.error().code != ErrorCode::Interrupted)
      return tl::unexpected(lit.error());
    if (!lit || monitor.is_cancelled()) {
      out.stopped = stopped_after(done, count);
      break;
    }
    append(std::move(table), count, out.table);
    done += poses.size();
    monitor.advance("poses", done, count);
    block.learn(seconds_since(begin));
  } while (done < count);
  return out;
}

Abundances sums_of(const Sums &sums, const Vectors &sun, const Vectors &observer, unsigned threads,
                   nb::handle watch) {
  Attention attention(watch);
  auto made = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &) {
    return sum_up(sums, sun, observer, threads, monitor);
  });
  attention.settle(made && made->stopped);
  return take(std::move(made));
}

/// Where the numbers of a table go: [pose, band, 4].
struct StokesArrays {
  double *stokes, *half_width;
};

/// Poses `first` and those behind it.
void put(const StokesTable &table, std::size_t first, StokesArrays to) {
  for (std::size_t k = 0; k < table.poses() * table.bands; ++k) {
    double *const out = to.stokes + 4 * (first * table.bands + k);
    double *const err = to.half_width + 4 * (first * table.bands + k);
    out[0] = table.i[k], out[1] = table.q[k], out[2] = table.u[k], out[3] = table.v[k];
    err[0] = table.i_err[k], err[1] = table.q_err[k], err[2] = table.u_err[k];
    err[3] = table.v_err[k];
  }
}

AbundanceTable part_of(const AbundanceTable &whole, std::size_t first, std::size_t count) {
  AbundanceTable out;
  out.columns = whole.columns;
  const auto take = [first, count](const auto &from, auto &to, std::size_t width) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first * width);
    to.assign(begin, begin + static_cast<std::ptrdiff_t>(count * width));
  };
  const std::size_t width = whole.columns.size();
  take(whole.sum, out.sum, width);
  take(whole.half_width, out.half_width, width);
  take(whole.bias, out.bias, width);
  take(whole.cos_phase, out.cos_phase, 1);
  take(whole.has_plane, out.has_plane, 1);
  take(whole.is_dark, out.is_dark, 1);
  return out;
}

/// All poses, some at a time, so that results stand nowhere twice and somebody may stop it.
/// Interrupted where the monitor says so.
Result<void> apply(const MaterialTables &tables, const AbundanceTable &from, unsigned threads,
                   const jobs::Monitor &monitor, StokesArrays to) {
  constexpr std::size_t at_once = 1u << 15;
  StokesTable table;
  for (std::size_t first = 0; first < from.poses(); first += at_once) {
    const std::size_t count = std::min(at_once, from.poses() - first);
    tables.apply(part_of(from, first, count), table, threads, monitor.cancel);
    if (monitor.is_cancelled())
      return fail(ErrorCode::Interrupted, "stopped by the user");
    put(table, first, to);
    monitor.advance("poses", first + count, from.poses());
  }
  return {};
}

/// What the materials and bands of a scenario make of sums: [pose, band, 4], and the half-widths.
nb::tuple applied(const Sums &sums, const Abundances &abundances, const Scenario &scenario,
                  unsigned threads, nb::handle watch) {
  const std::size_t count = abundances.table.poses(), bands = scenario.bands.size();
  const NewArray<double> stokes(count * bands * 4), half_width(count * bands * 4);
  Attention attention(watch);
  auto made = attend(
      attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) -> Result<double> {
        UMOV_ASSIGN(object,
                    load_object(scenario, 0, {.turns_in_time = false, .cancel = monitor.cancel},
                                diagnostics));
        UMOV_ASSIGN(tables, sums.light().tables_for(object.scene));
        if (tables.band_count() != bands)
          return fail(ErrorCode::Internal, "a scene has other bands than its scenario");
        UMOV_TRY(apply(tables, abundances.table, threads, monitor, {stokes.data, half_width.data}));
        return tables.diffuse_error();
      });
  attention.settle(was_interrupted(made));
  const double diffuse_error = take(std::move(made));
  return nb::make_tuple(stokes.shaped({count, bands, 4}), half_width.shaped({count, bands, 4}),
                        diffuse_error);
}

nb::object columns_of(nb::handle self, const std::vector<double> &values) {
  const auto &table = nb::cast<const Abundances &>(self).table;
  return nb::cast(View<double>(values.data(), {table.poses(), table.columns.size()}, self));
}

/// Kind, shape and sides of every column: ("specular", 0.3, ["body", "panel (back)"]).
nb::list names_of(const Abundances &abundances) {
  nb::list out;
  for (const AbundanceColumn &column : abundances.table.columns) {
    std::vector<std::string> sides;
    for (const AbundanceColumn::Side &side : column.sides)
      sides.push_back(side.group + (side.is_back_surface ? " (back)" : ""));
    const bool is_specular = column.kind == AbundanceColumn::Kind::Specular;
    out.append(nb::make_tuple(is_specular ? "specular" : "diffuse", column.shape, sides));
  }
  return out;
}

/// All of a table, for pickle.
nb::tuple state_of(const Abundances &abundances) {
  const AbundanceTable &t = abundances.table;
  nb::list columns;
  for (const AbundanceColumn &column : t.columns) {
    std::vector<std::pair<std::string, bool>> sides;
    for (const AbundanceColumn::Side &side : column.sides)
      sides.emplace_back(side.group, side.is_back_surface);
    columns.append(nb::make_tuple(sides, static_cast<int>(column.kind), column.shape));
  }
  const auto bytes = [](const auto &values) {
    return nb::bytes(values.data(), values.size() * sizeof(values[0]));
  };
  return nb::make_tuple(columns, bytes(t.sum), bytes(t.half_width), bytes(t.bias),
                        bytes(t.cos_phase), bytes(t.has_plane), bytes(t.is_dark));
}

template <class T> std::vector<T> values_from(const nb::bytes &bytes) {
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.c_str(), out.size() * sizeof(T));
  return out;
}

using ColumnState = std::tuple<std::vector<std::pair<std::string, bool>>, int, double>;

Abundances restored(const std::vector<ColumnState> &columns, const nb::bytes &sum,
                    const nb::bytes &half_width, const nb::bytes &bias, const nb::bytes &cos_phase,
                    const nb::bytes &has_plane, const nb::bytes &is_dark) {
  Abundances out;
  AbundanceTable &t = out.table;
  for (const auto &[sides, kind, shape] : columns) {
    AbundanceColumn &column = t.columns.emplace_back();
    for (const auto &[group, is_back] : sides)
      column.sides.push_back({group, is_back});
    column.kind = static_cast<AbundanceColumn::Kind>(kind);
    column.shape = shape;
  }
  t.sum = values_from<double>(sum), t.half_width = values_from<double>(half_width);
  t.bias = values_from<double>(bias), t.cos_phase = values_from<double>(cos_phase);
  t.has_plane = values_from<char>(has_plane), t.is_dark = values_from<char>(is_dark);
  if (t.sum.size() != t.poses() * t.columns.size() || t.half_width.size() != t.sum.size() ||
      t.bias.size() != t.sum.size() || t.has_plane.size() != t.poses() ||
      t.is_dark.size() != t.poses())
    take(Result<void>(fail(ErrorCode::BadInput, "a pickle of abundances whose parts do not fit")));
  return out;
}

} // namespace

void bind_abundances(nb::module_ &m) {
  nb::class_<Abundances>(m, "Abundances", "Geometric sums of poses.")
      .def_prop_ro(
          "sum",
          [](nb::handle self) {
            return columns_of(self, nb::cast<const Abundances &>(self).table.sum);
          },
          nb::sig("def sum(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro(
          "half_width",
          [](nb::handle self) {
            return columns_of(self, nb::cast<const Abundances &>(self).table.half_width);
          },
          nb::sig("def half_width(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro("columns", &names_of,
                   nb::sig("def columns(self) -> list[tuple[str, float, list[str]]]"))
      .def_prop_ro("poses", [](const Abundances &a) { return a.table.poses(); })
      .def_prop_ro(
          "stopped",
          [](const Abundances &a) { return tuple_of(a.stopped ? &*a.stopped : nullptr); },
          nb::sig("def stopped(self) -> tuple[int, str, str, int, int] | None"))
      .def_prop_ro("state", &state_of, nb::sig("def state(self) -> tuple[typing.Any, ...]"))
      .def_static("restore", &restored);
  nb::class_<Sums>(m, "Sums", "An object that is asked for sums.")
      .def(nb::init<const Scenario &, const std::vector<Scenario> &, const jobs::JobOptions &,
                    nb::handle>(),
           "scenario"_a, "others"_a, "options"_a, "watch"_a.none())
      .def("abundances", &sums_of, "sun"_a, "observer"_a, "threads"_a, "watch"_a.none())
      .def("apply", &applied, "abundances"_a, "scenario"_a, "threads"_a, "watch"_a.none(),
           nb::sig(
               "def apply(self, abundances: Abundances, scenario: Scenario, threads: int, watch: "
               "object | None) -> tuple[numpy.typing.NDArray[numpy.float64], "
               "numpy.typing.NDArray[numpy.float64], float]"));
}

} // namespace umov::python
