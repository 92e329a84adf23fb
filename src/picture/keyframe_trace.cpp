#include <umov/picture/keyframe.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Sphere {
  Vec3<Body> centre;
  double radius = 0;
};

/// Sphere about the middle of the box of all used vertices.
Sphere bounding_sphere(const Mesh &mesh) {
  constexpr double big = std::numeric_limits<double>::infinity();
  Vec3<Body> low{big, big, big}, high{-big, -big, -big};
  for (const Triangle &t : mesh.triangles)
    for (const std::uint32_t i : t.vertex) {
      const Vec3<Body> p = mesh.positions[i];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  Sphere out{(low + high) / 2, 0};
  for (const Triangle &t : mesh.triangles)
    for (const std::uint32_t i : t.vertex)
      out.radius = std::max(out.radius, norm(mesh.positions[i] - out.centre));
  return out;
}

/// Of each surface of the scene, by wavelength.
using FresnelOfSurfaces = std::map<const Surface *, std::vector<FresnelFactors>>;

/// One picture in the making: everything a row of rays needs.
struct Camera {
  const Scene &scene;
  const Occluder &occluder;
  KeyFrameView view;
  Sphere sphere;
  Vec3<Body> right, up; ///< unit; right x up points at the observer
  double half_width = 0;
  std::vector<std::uint32_t> front_material, back_material; ///< per mesh group
  FresnelOfSurfaces fresnel;
};

/// A point that is seen: where, its two normals turned to the observer, and its surface.
struct Seen {
  std::size_t column = 0;
  Vec3<Body> point, geometric, normal;
  const Surface *surface = nullptr;
  SurfacePoint at;
};

Vec3<Body> shown_normal(const Scene &scene, const Triangle &t, const Occluder::Hit &hit,
                        Vec3<Body> geometric) {
  if (scene.normals != NormalMode::Smooth || t.normal[0] == no_index)
    return geometric;
  const double u = hit.u, v = hit.v;
  const auto &n = scene.mesh.normals;
  const Vec3<Body> sum = n[t.normal[0]] * (1 - u - v) + n[t.normal[1]] * u + n[t.normal[2]] * v;
  const double length = norm(sum);
  return length > 0 ? sum / length : geometric;
}

std::uint32_t material_at(const std::vector<std::string> &names, const std::string &name) {
  return static_cast<std::uint32_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Casts the primary rays of a row; fills material and facing.
std::vector<Seen> look(const Camera &camera, std::size_t row, std::span<KeyFrameSample> line) {
  std::vector<Seen> seen;
  const Vec3<Body> v = camera.view.pose.observer;
  const auto side = static_cast<double>(line.size());
  const double step = 2 * camera.half_width / side;
  const double y = camera.half_width - (static_cast<double>(row) + 0.5) * step;
  const Vec3<Body> start = camera.sphere.centre + v * (2 * camera.sphere.radius) + camera.up * y;
  for (std::size_t column = 0; column < line.size(); ++column) {
    const double x = (static_cast<double>(column) + 0.5) * step - camera.half_width;
    const Occluder::Hit hit = camera.occluder.nearest(start + camera.right * x, -v);
    if (hit.triangle == no_index)
      continue;
    const Mesh &mesh = camera.scene.mesh;
    const Triangle &t = mesh.triangles[hit.triangle];
    Seen s{column, {},      normalized(area_vector_doubled(mesh, t)),
           {},     nullptr, {hit.triangle, hit.u, hit.v}};
    s.normal = shown_normal(camera.scene, t, hit, s.geometric);
    const bool is_front = dot(s.geometric, v) >= 0;
    if (!is_front) {
      s.geometric = -s.geometric;
      s.normal = -s.normal;
    }
    // Barycentric coordinates keep the point on its face better than the float distance does.
    const double a = hit.u, b = hit.v;
    s.point = mesh.positions[t.vertex[0]] * (1 - a - b) + mesh.positions[t.vertex[1]] * a +
              mesh.positions[t.vertex[2]] * b;
    s.surface = &surface_of_side(camera.scene, t, is_front);
    line[column].material = is_front ? camera.front_material[t.front]
                            : t.back == t.front
                                ? camera.back_material[t.back]
                                : camera.front_material[t.back]; // as surface_of_side
    line[column].facing = static_cast<float>(std::clamp(dot(s.normal, v), 0., 1.));
    line[column].p = nan;
    seen.push_back(s);
  }
  return seen;
}

/// Of the seen points of a row, those that the Sun reaches.
std::vector<Seen> reached_by_sun(const Camera &camera, const std::vector<Seen> &seen) {
  const Vec3<Body> l = camera.view.pose.sun, v = camera.view.pose.observer;
  const double lift = 1e-5 * camera.sphere.radius; // about 50 times the float resolution of a hit
  std::vector<Vec3<Body>> origins;
  for (const Seen &s : seen)
    origins.push_back(s.point + s.geometric * lift);
  std::vector<unsigned char> is_free(seen.size());
  camera.occluder.is_free(origins, l, is_free);
  std::vector<Seen> out;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (const Seen &s = seen[i];
        is_free[i] != 0 && dot(s.geometric, l) > 0 && dot(s.normal, l) > 0 && dot(s.normal, v) > 0)
      out.push_back(s);
  return out;
}

/// Light that a point sends to the observer, times the cosine at which it is seen, in a band.
Stokes<ScatteringPlane> reflected(const Surface &surface, std::span<const FresnelFactors> fresnel,
                                  const std::vector<BandTerm> &terms, const SurfaceDirections &at) {
  const bool is_grey = surface.is_specular_grey();
  const double grey = is_grey ? surface.specular(terms.front().node, at) : 0;
  const auto at_node = [&](std::size_t node) {
    const FresnelFactors f = fresnel[node];
    const double specular = is_grey ? grey : surface.specular(node, at);
    const auto diffuse = surface.diffuse(node, at, {1, 0, 0, 0});
    return Stokes<ScatteringPlane>{f.a * specular + diffuse.i, f.b * specular + diffuse.q,
                                   diffuse.u, diffuse.v};
  };
  return sum_band<Stokes<ScatteringPlane>>(terms, at_node).value;
}

/// Reflection of the microfacets of every surface at all wavelengths: one incidence serves a whole
/// picture, and a stack of films takes as long as a hundred points.
FresnelOfSurfaces fresnel_of(const Scene &scene, double l_v) {
  FresnelOfSurfaces out;
  for (const auto *side : {&scene.front, &scene.back})
    for (const Surface &surface : *side)
      for (std::size_t node = 0; node < scene.grid.nodes().size(); ++node)
        out[&surface].push_back(surface.fresnel(node, l_v));
  return out;
}

/// Reflected light of the lit points of a row in a band.
void light(const Camera &camera, std::size_t band, const std::vector<Seen> &lit,
           std::span<KeyFrameSample> line) {
  const Vec3<Body> l = camera.view.pose.sun, v = camera.view.pose.observer;
  const double l_v = dot(l, v);
  for (const Seen &s : lit) {
    KeyFrameSample &out = line[s.column];
    out.is_lit = true;
    const SurfaceDirections at =
        directions_on(s.normal, direction_field(camera.scene.mesh, *s.surface, s.at.triangle), l, v,
                      l_v, camera.view.pose.sun_radius_rad);
    const auto sent =
        reflected(*s.surface, camera.fresnel.at(s.surface), camera.scene.grid.terms()[band], at);
    out.radiance = static_cast<float>(sent.i / dot(s.normal, v));
    if (sent.i > 0) {
      out.q = static_cast<float>(sent.q / sent.i);
      out.u = static_cast<float>(sent.u / sent.i);
      out.v = static_cast<float>(sent.v / sent.i);
      out.p = std::hypot(out.q, out.u);
    }
  }
}

/// Adds what touched several surfaces, [point * nodes + node] at all wavelengths of the scene.
void add_indirect(const std::vector<Seen> &seen, const std::vector<Stokes<ScatteringPlane>> &light,
                  const BandGrid &grid, std::size_t band, std::span<KeyFrameSample> line) {
  for (std::size_t k = 0; k < seen.size(); ++k) {
    KeyFrameSample &out = line[seen[k].column];
    const auto direct = static_cast<double>(out.radiance);
    const auto more = sum_band<Stokes<ScatteringPlane>>(grid.terms()[band], [&](std::size_t node) {
      return light[k * grid.nodes().size() + node];
    });
    const Stokes<ScatteringPlane> sum =
        more.value + Stokes<ScatteringPlane>{1, out.q, out.u, out.v} * direct;
    if (!(sum.i > 0))
      continue;
    out.radiance = static_cast<float>(sum.i);
    out.q = static_cast<float>(sum.q / sum.i);
    out.u = static_cast<float>(sum.u / sum.i);
    out.v = static_cast<float>(sum.v / sum.i);
    out.p = std::hypot(out.q, out.u);
  }
}

Result<void> check(const Scene &scene, const KeyFrameOptions &options,
                   std::span<const std::size_t> bands) {
  if (options.size < 1 || options.size > 4096 || options.samples < 1 || options.samples > 8)
    return fail(ErrorCode::BadInput,
                fmt::format("key frame of {} pixels with {} x {} rays each; the size must be 1 to "
                            "4096 and the rays 1 to 8",
                            options.size, options.samples, options.samples));
  for (const std::size_t band : bands)
    if (band >= scene.bands.size())
      return fail(ErrorCode::BadInput, fmt::format("key frame in band {}; the scene has {} bands",
                                                   band, scene.bands.size()));
  return {};
}

} // namespace

Result<KeyFrameRaster> trace_key_frame(const Scene &scene, const Occluder &occluder,
                                       const KeyFrameView &view, const KeyFrameOptions &options) {
  UMOV_ASSIGN(rasters,
              trace_key_frames(scene, occluder, view, options, std::span(&options.band, 1)));
  return std::move(rasters.front());
}

Result<std::vector<KeyFrameRaster>> trace_key_frames(const Scene &scene, const Occluder &occluder,
                                                     const KeyFrameView &view,
                                                     const KeyFrameOptions &options,
                                                     std::span<const std::size_t> bands,
                                                     const BetweenLight *between) {
  UMOV_TRY(check(scene, options, bands));
  const Vec3<Body> v = view.pose.observer;
  const Vec3<Body> across = view.up - v * dot(view.up, v);
  if (!(norm(across) > 1e-9 * norm(view.up)))
    return fail(ErrorCode::BadInput,
                "key frame: `up` lies along the line of sight; give another direction");
  Camera camera{scene, occluder, view, bounding_sphere(scene.mesh), {}, {}, 0, {}, {}, {}};
  camera.fresnel = fresnel_of(scene, dot(view.pose.sun, v));
  camera.up = normalized(across);
  camera.right = cross(camera.up, v);
  camera.half_width = options.half_width_m > 0 ? options.half_width_m : 1.04 * camera.sphere.radius;
  KeyFrameRaster out;
  out.side = options.size * options.samples;
  out.samples = options.samples;
  out.half_width_m = camera.half_width;
  const Vec3<Body> s =
      cross(v, view.pose.sun); // +Q of the scattering frame (v x l; docs/conventions.md)
  if (has_scattering_plane(view.pose))
    out.pa_scat_rad = std::atan2(dot(s, cross(v, camera.up)), dot(s, camera.up));
  out.materials = material_names(scene);
  for (const Surface &surface : scene.front)
    camera.front_material.push_back(material_at(out.materials, surface.material().name));
  for (const Surface &surface : scene.back)
    camera.back_material.push_back(material_at(out.materials, surface.material().name));
  const std::size_t side = out.side;
  std::vector<KeyFrameRaster> rasters(bands.size(), out);
  for (KeyFrameRaster &raster : rasters) // one by one: they take most of the memory
    raster.points.resize(side * side);
  parallel_for(side, options.threads, [&](std::size_t row) {
    if (is_stopped(options.cancel))
      return;
    std::vector<KeyFrameSample> dark(side); // what all bands share
    const std::vector<Seen> seen = look(camera, row, dark);
    const std::vector<Seen> lit = reached_by_sun(camera, seen);
    std::vector<Stokes<ScatteringPlane>> more;
    if (between != nullptr && options.bounces > 1) {
      std::vector<SurfacePoint> points;
      for (const Seen &point : seen)
        points.push_back(point.at);
      more = between->radiance(view.pose, points,
                               {options.bounces, options.paths, options.seed, options.cancel},
                               row * side);
    }
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const std::span<KeyFrameSample> line(rasters[b].points.data() + row * side, side);
      std::copy(dark.begin(), dark.end(), line.begin());
      light(camera, bands[b], lit, line);
      if (!more.empty())
        add_indirect(seen, more, scene.grid, bands[b], line);
    }
  });
  if (is_stopped(options.cancel))
    return fail(ErrorCode::Interrupted, "stopped by the user; nothing was written");
  return rasters;
}

KeyFrameStage::KeyFrameStage(const Scene &scene, std::vector<Joint> joints, std::size_t bounces,
                             const std::atomic<bool> *cancel)
    : scene_(scene), joints_(std::move(joints)), still_(scene.mesh, Occluder::Rays::Each, cancel) {
  if (bounces > 1)
    between_ = make_between_light(scene, cancel);
}

Result<std::vector<KeyFrameRaster>>
KeyFrameStage::trace(const KeyFrameView &view, const std::vector<double> &joint_angles_rad,
                     const KeyFrameOptions &options, std::span<const std::size_t> bands) const {
  return without_failures([&]() -> Result<std::vector<KeyFrameRaster>> {
    if (joint_angles_rad.empty())
      return trace_key_frames(scene_, still_, view, options, bands, between_.get());
    Scene turned = scene_;
    turned.mesh = posed(scene_.mesh, joints_, joint_angles_rad);
    std::unique_ptr<BetweenLight> between;
    if (between_)
      between = make_between_light(turned, options.cancel);
    const Occluder occluder(turned.mesh, Occluder::Rays::Each, options.cancel);
    return trace_key_frames(turned, occluder, view, options, bands, between.get());
  });
}

} // namespace umov
