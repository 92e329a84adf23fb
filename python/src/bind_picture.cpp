// What an object looks like: pictures of it, and its triangles.

#include "arrays.h"
#include "attend.h"
#include "bindings.h"
#include "errors.h"
#include "options.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <umov/jobs/render.h>
#include <umov/light/poses.h>

namespace umov::python {
namespace {

using nb::literals::operator""_a;
using Three = std::array<double, 3>;

Vec3<Body> direction_of(const Three &v, const char *name) {
  if (const auto direction = direction_along({v[0], v[1], v[2]}))
    return *direction;
  return take(Result<Vec3<Body>>(fail(
      ErrorCode::BadInput,
      std::string(name) + " is no direction; three finite numbers other than 0 were expected")));
}

jobs::RenderRequest::Shade shade_from(const std::string &word) {
  using Shade = jobs::RenderRequest::Shade;
  return word == "polarization" ? Shade::Polarization
         : word == "angle"      ? Shade::PositionAngle
         : word == "material"   ? Shade::Material
         : word == "colour"     ? Shade::Colour
                                : Shade::Intensity;
}

/// `directions`: Sun, observer and what is up, in the body frame; none: along the orbit, at `time`
/// or when it is brightest.
nb::bytes render(const Scenario &scenario, const std::string &shade, const std::string &band,
                 const std::vector<Three> &directions, const std::optional<std::string> &time,
                 std::uint32_t side, std::uint32_t samples, const jobs::JobOptions &options,
                 nb::handle watch) {
  jobs::RenderRequest request;
  request.shade = shade_from(shade);
  request.band = band;
  request.side = side;
  request.samples = samples;
  if (directions.size() == 3)
    request.view = KeyFrameView{
        {direction_of(directions[0], "sun"), direction_of(directions[1], "observer"), 0},
        direction_of(directions[2], "up")};
  if (time)
    request.time = take(utc_from_iso(*time));
  Attention attention(watch);
  std::string picture;
  const jobs::PictureSink keep = [&](std::size_t, std::string &&bytes) -> Result<void> {
    picture = std::move(bytes);
    return {};
  };
  auto made = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return jobs::render(scenario, request, keep, options, monitor, diagnostics);
  });
  attention.settle(was_interrupted(made));
  take(std::move(made));
  return nb::bytes(picture.data(), picture.size());
}

/// Corners (V, 3) [m, body frame], triangles (F, 3), the group of each, and the groups' names.
nb::tuple mesh_of(const Scenario &scenario, std::size_t object, nb::handle watch) {
  Attention attention(watch);
  auto made = attend(attention, [&](const jobs::Monitor &monitor, Diagnostics &diagnostics) {
    return load_object(scenario, object, {.turns_in_time = false, .cancel = monitor.cancel},
                       diagnostics);
  });
  attention.settle(was_interrupted(made));
  const Mesh mesh = take(std::move(made)).scene.mesh;
  const NewArray<double> corners(3 * mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    corners.data[3 * i] = mesh.positions[i].x;
    corners.data[3 * i + 1] = mesh.positions[i].y;
    corners.data[3 * i + 2] = mesh.positions[i].z;
  }
  const NewArray<std::uint32_t> triangles(3 * mesh.triangles.size());
  const NewArray<std::uint32_t> groups(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::copy_n(mesh.triangles[i].vertex.begin(), 3, triangles.data + 3 * i);
    groups.data[i] = mesh.triangles[i].front;
  }
  return nb::make_tuple(corners.shaped({mesh.positions.size(), 3}),
                        triangles.shaped({mesh.triangles.size(), 3}),
                        groups.shaped({mesh.triangles.size()}), mesh.groups);
}

} // namespace

void bind_picture(nb::module_ &m) {
  m.def("render", &render, "scenario"_a, "shade"_a, "band"_a, "directions"_a, "time"_a.none(),
        "side"_a, "samples"_a, "options"_a, "watch"_a.none());
  m.def("mesh", &mesh_of, "scenario"_a, "object"_a, "watch"_a.none(),
        nb::sig("def mesh(scenario: Scenario, object: int, watch: object | None) -> "
                "tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.uint32], "
                "numpy.typing.NDArray[numpy.uint32], list[str]]"));
}

} // namespace umov::python
