#include <umov/shape/occluder.h>

#include "shape/embree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <type_traits>
#include <umov/core/result.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>

namespace umov {

/// Coordinates are moved and scaled to a unit box, which spends the float mantissa on the shape.
struct Occluder::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Vec3<Body> centre{};
  double scale = 1; ///< model units per metre
  /// Of packets: rays of one point into a grid's directions part soon (measured: a third faster).
  embree::Order order = embree::coherent;

  ~State() {
    if (!has_memory())
      return;
    if (scene != nullptr)
      rtcReleaseScene(scene);
    if (device != nullptr)
      rtcReleaseDevice(device);
  }
  [[nodiscard]] Vec3<Body> to_model(Vec3<Body> p) const { return (p - centre) * scale; }
  /// Embree takes memory to release a scene, and ends the program where there is none: what could
  /// not be built for lack of it is left as it is, and so is what is held when it ends.
  static bool has_memory() {
    constexpr std::size_t enough = 1u << 16;    // taken from the heap, not mapped
    void *volatile block = std::malloc(enough); // compilers leave out what is only asked for
    std::free(block);
    return block != nullptr;
  }
  static void leave(std::unique_ptr<State> &state) {
    [[maybe_unused]] const State *left = state.release();
  }
};

namespace {

constexpr std::size_t ray_packet = 16;

bool is_finite(Occluder::Point p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
bool is_finite(Vec3<Body> v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Box {
  Vec3<Body> centre{};
  double half = 1;
};

Box bounds(const Mesh &mesh) {
  if (mesh.triangles.empty())
    return {};
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Triangle &t : mesh.triangles)
    for (const std::uint32_t v : t.vertex) {
      const Vec3<Body> p = mesh.positions[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  return {(low + high) / 2, std::max(norm(high - low) / 2, 1e-300)};
}

const char *cause(RTCError code) {
  switch (code) {
  case RTC_ERROR_OUT_OF_MEMORY:
    return "out of memory; free some, or simplify the mesh";
  case RTC_ERROR_UNSUPPORTED_CPU:
    return "this processor is not supported by Embree (SSE2 is needed)";
  default:
    return "Embree refused";
  }
}

/// Embree tells of errors only if asked. `made` is what the call before returned.
void check(RTCDevice device, const Mesh &mesh, const void *made) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE && made != nullptr)
    return;
  throw Failure(Error{ErrorCode::Device,
                      fmt::format("no ray tests against the {}: {} (code {}).",
                                  counted(mesh.triangles.size(), "triangle"), cause(code),
                                  static_cast<int>(code)),
                      {}});
}
void check(RTCDevice device, const Mesh &mesh) { check(device, mesh, device); }

using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, void (*)(RTCGeometry)>;

/// Who may stop the building of a tree.
struct Watch {
  const std::atomic<bool> *cancel;
};
bool goes_on(void *watch, double /*part*/) {
  return !is_stopped(static_cast<const Watch *>(watch)->cancel);
}

Geometry new_geometry(RTCDevice device, const Mesh &mesh) {
  Geometry out(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry);
  check(device, mesh, out.get());
  return out;
}

} // namespace

Occluder::Occluder(const Mesh &mesh, Rays rays, const std::atomic<bool> *cancel)
    : state_(std::make_unique<State>()) {
  try {
    build(mesh, rays, cancel);
  } catch (const Failure &why) {
    if (why.error().code != ErrorCode::Interrupted)
      State::leave(state_);
    throw;
  } catch (...) {
    State::leave(state_);
    throw;
  }
}

void Occluder::build(const Mesh &mesh, Rays rays, const std::atomic<bool> *cancel) {
  leave_if_stopped(cancel);
  const Box box = bounds(mesh);
  state_->centre = box.centre;
  state_->scale = 1 / box.half;
  state_->device = rtcNewDevice("threads=1"); // the same tree on every machine
  check(state_->device, mesh);
  state_->scene = rtcNewScene(state_->device);
  check(state_->device, mesh, state_->scene);
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_HIGH);
  if (rays == Rays::Each)
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  else
    state_->order = embree::incoherent;
  if (!mesh.triangles.empty()) {
    const auto geometry = new_geometry(state_->device, mesh);
    auto *vertices = static_cast<float *>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size()));
    check(state_->device, mesh, vertices);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Vec3<Body> p = state_->to_model(mesh.positions[i]);
      vertices[3 * i] = static_cast<float>(p.x);
      vertices[3 * i + 1] = static_cast<float>(p.y);
      vertices[3 * i + 2] = static_cast<float>(p.z);
    }
    auto *indices = static_cast<unsigned *>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    check(state_->device, mesh, indices);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      std::copy_n(mesh.triangles[i].vertex.begin(), 3, indices + 3 * i);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(state_->scene, geometry.get());
  }
  Watch watch{cancel};
  rtcSetSceneProgressMonitorFunction(state_->scene, goes_on, &watch);
  rtcCommitScene(state_->scene);
  rtcSetSceneProgressMonitorFunction(state_->scene, nullptr, nullptr);
  leave_if_stopped(cancel);
  check(state_->device, mesh); // a scene that failed here would let every ray through
}

Occluder::~Occluder() = default;
Occluder::Occluder(Occluder &&) noexcept = default;
Occluder &Occluder::operator=(Occluder &&) noexcept = default;

Occluder::Point Occluder::to_point(Vec3<Body> p) const {
  const Vec3<Body> m = state_->to_model(p);
  return {static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)};
}
Vec3<Body> Occluder::from_point(Point p) const {
  return Vec3<Body>{p.x, p.y, p.z} / state_->scale + state_->centre;
}

bool Occluder::is_one_free(Point origin, Point direction) const {
  if (!is_finite(origin) || !is_finite(direction))
    return false;
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  embree::occluded(state_->scene, ray);
  return ray.tfar > 0;
}

void Occluder::is_free(std::span<const Vec3<Body>> origins, Vec3<Body> direction,
                       std::span<unsigned char> free) const {
  const Point along{static_cast<float>(direction.x), static_cast<float>(direction.y),
                    static_cast<float>(direction.z)};
  if (origins.size() == 1) { // fifteen idle lanes cost more than one ray
    free[0] = is_one_free(to_point(origins[0]), along) ? 1 : 0;
    return;
  }
  std::array<Point, ray_packet> packet{}, directions{};
  directions.fill(along);
  for (std::size_t begin = 0; begin < origins.size(); begin += ray_packet) {
    const std::size_t count = std::min(ray_packet, origins.size() - begin);
    for (std::size_t i = 0; i < count; ++i)
      packet[i] = to_point(origins[begin + i]);
    is_free({packet.data(), count}, {directions.data(), count}, free.subspan(begin, count));
  }
}

void Occluder::is_free(std::span<const Point> origins, std::span<const Point> directions,
                       std::span<unsigned char> free) const {
  if (origins.size() == 1) {
    free[0] = is_one_free(origins[0], directions[0]) ? 1 : 0;
    return;
  }
  for (std::size_t begin = 0; begin < origins.size(); begin += ray_packet) {
    const std::size_t count = std::min(ray_packet, origins.size() - begin);
    alignas(64) RTCRay16 ray{};
    alignas(64) int valid[ray_packet];
    for (std::size_t i = 0; i < ray_packet; ++i) {
      const Point p = i < count ? origins[begin + i] : Point{};
      const Point d = i < count ? directions[begin + i] : Point{};
      valid[i] = i < count && is_finite(p) && is_finite(d) ? -1 : 0;
      ray.org_x[i] = p.x;
      ray.org_y[i] = p.y;
      ray.org_z[i] = p.z;
      ray.dir_x[i] = d.x;
      ray.dir_y[i] = d.y;
      ray.dir_z[i] = d.z;
      ray.tnear[i] = 0;
      ray.tfar[i] = std::numeric_limits<float>::infinity();
      ray.mask[i] = ~0u;
    }
    embree::occluded(state_->scene, valid, ray, state_->order);
    for (std::size_t i = 0; i < count; ++i) // Embree sets tfar to -inf where something was hit
      free[begin + i] = valid[i] != 0 && ray.tfar[i] > 0 ? 1 : 0;
  }
}

Occluder::Hit Occluder::nearest(Vec3<Body> origin, Vec3<Body> direction) const {
  if (!is_finite(origin) || !is_finite(direction))
    return {};
  const Vec3<Body> p = state_->to_model(origin);
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(p.x);
  ray.ray.org_y = static_cast<float>(p.y);
  ray.ray.org_z = static_cast<float>(p.z);
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(state_->scene, ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return {};
  return {ray.hit.primID, ray.hit.u, ray.hit.v, static_cast<double>(ray.ray.tfar) / state_->scale};
}

} // namespace umov
