// A catalogue at many times.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/jobs/ephemeris.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;

static_assert(sizeof(TemeState) == 6 * sizeof(double), "a state is seen as six numbers");
static_assert(sizeof(Sgp4Code) == sizeof(int), "a code is seen as a number");

/// Among the codes of SGP4, which are 0 and above: nobody has come to that state.
constexpr int not_done = -1;

/// States of a catalogue, whose memory the arrays share.
struct States {
  jobs::CatalogueStates all;
  std::size_t times = 0;
};

States propagate(const std::string &orbit, const std::vector<std::string> &times,
                 const jobs::JobOptions &options, nb::handle watch) {
  jobs::StatesRequest request{orbit, {}, false};
  for (const std::string &time : times)
    request.times.push_back(take(utc_from_iso(time)));
  Attention attention(watch);
  auto result = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::propagate_catalogue(request, options, monitor, diagnostics);
  });
  const bool is_stopped = result && result->is_partial;
  attention.settle(was_interrupted(result) || is_stopped);
  jobs::CatalogueStates states = take(std::move(result));
  if (states.is_partial)
    for (std::size_t row = 0; row < states.codes.size(); ++row)
      if (states.is_done[row] == 0)
        states.codes[row] = static_cast<Sgp4Code>(not_done);
  return {std::move(states), times.size()};
}

nb::object teme(nb::handle self) {
  const auto &s = nb::cast<const States &>(self);
  return nb::cast(View<double>(reinterpret_cast<const double *>(s.all.states.data()),
                               {s.all.norad_cat_id.size(), s.times, 6}, self));
}

nb::object codes(nb::handle self) {
  const auto &s = nb::cast<const States &>(self);
  return nb::cast(View<int>(reinterpret_cast<const int *>(s.all.codes.data()),
                            {s.all.norad_cat_id.size(), s.times}, self));
}

nb::object numbers(nb::handle self) {
  const auto &ids = nb::cast<const States &>(self).all.norad_cat_id;
  return nb::cast(View<int>(ids.data(), {ids.size()}, self));
}

} // namespace

void bind_orbit(nb::module_ &m) {
  nb::class_<States>(m, "States", "States of a catalogue.")
      .def_prop_ro("teme", &teme, nb::sig("def teme(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro("error", &codes, nb::sig("def error(self) -> numpy.typing.NDArray[numpy.int32]"))
      .def_prop_ro("norad_cat_id", &numbers,
                   nb::sig("def norad_cat_id(self) -> numpy.typing.NDArray[numpy.int32]"))
      .def_prop_ro(
          "stopped",
          [](const States &s) { return tuple_of(s.all.error ? &*s.all.error : nullptr); },
          nb::sig("def stopped(self) -> tuple[int, str, str, int, int] | None"));
  m.def("propagate", &propagate, "orbit"_a, "times"_a, "options"_a, "watch"_a.none());
}

} // namespace umov::python
