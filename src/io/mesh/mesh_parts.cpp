#include "io/mesh/mesh_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/shape/triangulate.h>
#include <unordered_map>

namespace umov::mesh_io {
namespace {

namespace fs = std::filesystem;

struct Unit {
  const char *name;
  double metres;
};

constexpr Unit units[] = {{"m", 1},     {"cm", 0.01},   {"mm", 0.001},
                          {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}};

Vec3<Body> turned(Vec3<Body> v, const std::string &up) {
  if (up == "+Y")
    return {v.x, -v.z, v.y};
  if (up == "+X")
    return {v.y, v.z, v.x};
  if (up == "-Z")
    return {v.x, -v.y, -v.z};
  if (up == "-Y")
    return {v.x, v.z, -v.y};
  if (up == "-X")
    return {-v.y, v.z, -v.x};
  return v;
}

/// What is missing, with the size of the box to guess it from.
std::string box_text(const Mesh &mesh, const char *key, bool is_of_command) {
  Vec3<Body> low{INFINITY, INFINITY, INFINITY}, high = -1 * low;
  for (const Vec3<Body> p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3<Body> size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  const auto length = [](double m) {
    return m >= 1000  ? fmt::format("{:.4g} km", m / 1000)
           : m < 0.01 ? fmt::format("{:.4g} mm", m * 1000)
                      : fmt::format("{:.4g} m", m);
  };
  const std::string unit = longest > 200 ? "mm" : "m";
  return fmt::format(
      "no {}. The bounding box is {:.6g} x {:.6g} x {:.6g}: in mm that is {}, in m it "
      "is {}. {} (or cm, km, in, ft) and {} (the axis of the file that is up).",
      key, size.x, size.y, size.z, length(longest / 1000), length(longest),
      is_of_command ? "Give --unit " + unit : "Set unit = \"" + unit + "\"",
      is_of_command ? "--up +Z" : "up = \"+Z\"");
}

Result<double> metres_of(const Mesh &mesh, const MeshFileOptions &options, const Where &file) {
  if (options.unit.empty())
    return fail(ErrorCode::BadInput, box_text(mesh, "unit", options.is_of_command), file);
  const auto *unit = std::find_if(std::begin(units), std::end(units),
                                  [&](const Unit &u) { return options.unit == u.name; });
  if (unit == std::end(units))
    return fail(ErrorCode::BadInput,
                "unit = \"" + options.unit + "\"; m, cm, mm, km, in or ft was expected", file);
  if (options.up.empty())
    return fail(ErrorCode::BadInput, box_text(mesh, "up axis", options.is_of_command), file);
  if (options.up.size() != 2 || (options.up[0] != '+' && options.up[0] != '-') ||
      options.up[1] < 'X' || options.up[1] > 'Z')
    return fail(ErrorCode::BadInput, "up = \"" + options.up + "\"; \"+X\" to \"-Z\" was expected",
                file);
  return unit->metres;
}

/// Unit normals, and none where one says nothing.
void turn_normals(Mesh &mesh, const std::string &up) {
  for (Vec3<Body> &n : mesh.normals) {
    const Vec3<Body> t = turned(n, up);
    const double length = norm(t);
    // Already unit to the last bits: left alone, so that writing and reading change nothing.
    n = std::abs(length - 1) < 1e-12 || !(length > 0) ? t : t / length;
  }
  for (Triangle &t : mesh.triangles)
    for (const std::uint32_t n : t.normal)
      if (n != no_index && !(norm(mesh.normals[n]) > 0))
        t.normal = {no_index, no_index, no_index};
}

struct BitsHash {
  std::size_t operator()(const std::array<std::uint64_t, 3> &b) const {
    std::uint64_t h = 0;
    for (const std::uint64_t v : b) // the finalizer of MurmurHash3 (Appleby)
      h = (h ^ v ^ (v >> 33)) * 0xff51afd7ed558ccdULL + (h >> 29);
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

/// Shared numbers for the values that are used, and these values once each.
class Joined {
public:
  explicit Joined(const std::vector<Vec3<Body>> &all) : all_(all), place_(all.size(), no_index) {}

  std::uint32_t of(std::uint32_t i) {
    if (i == no_index || place_[i] != no_index)
      return i == no_index ? i : place_[i];
    const Vec3<Body> v = all_[i] + Vec3<Body>{}; // -0 becomes 0
    const auto [entry, is_new] = known_.emplace(std::array{std::bit_cast<std::uint64_t>(v.x),
                                                           std::bit_cast<std::uint64_t>(v.y),
                                                           std::bit_cast<std::uint64_t>(v.z)},
                                                static_cast<std::uint32_t>(kept.size()));
    if (is_new)
      kept.push_back(v);
    return place_[i] = entry->second;
  }

  std::vector<Vec3<Body>> kept;

private:
  const std::vector<Vec3<Body>> &all_;
  std::vector<std::uint32_t> place_;
  std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, BitsHash> known_;
};

} // namespace

bool is_out_of_reach(Vec3<Body> v) {
  return !(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= farthest) ||
         std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z);
}

std::string point_text(Vec3<Body> v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

bool leaves_folder(const std::string &name) {
  const fs::path path(name);
  return path.is_absolute() || name.find('\\') != std::string::npos ||
         std::find(path.begin(), path.end(), fs::path("..")) != path.end();
}

std::string clean_name(std::string_view name) {
  constexpr std::size_t longest = 200;
  std::string out(trimmed(name.substr(0, longest)));
  for (char &c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      c = '_';
  return out;
}

std::string joined_path(const std::string &parent, const std::string &name) {
  return parent.empty() ? name : fmt::format("{}/{}", parent, name);
}

std::uint32_t GroupIndex::of(const std::string &name) {
  const auto [entry, is_new] = known_.emplace(std::pair{name, std::string()},
                                              static_cast<std::uint32_t>(mesh_.groups.size()));
  if (is_new)
    mesh_.groups.push_back(name);
  return entry->second;
}

std::uint32_t GroupIndex::of(const std::string &name, const std::string &node) {
  const auto [entry, is_new] =
      known_.emplace(std::pair{name, node}, static_cast<std::uint32_t>(mesh_.groups.size()));
  if (is_new) {
    mesh_.groups.push_back(name);
    mesh_.nodes.push_back(node);
  }
  return entry->second;
}

Vec3<Body> texture_tangent(const std::array<Vec3<Body>, 3> &at,
                           const std::array<std::array<double, 2>, 3> &uv) {
  const Vec3<Body> a = at[1] - at[0], b = at[2] - at[0];
  const double du1 = uv[1][0] - uv[0][0], dv1 = uv[1][1] - uv[0][1];
  const double du2 = uv[2][0] - uv[0][0], dv2 = uv[2][1] - uv[0][1];
  const double area = du1 * dv2 - du2 * dv1;
  const Vec3<Body> along = std::copysign(1.0, area) * (dv2 * a - dv1 * b);
  return area != 0 && norm(along) > 0 ? normalized(along) : Vec3<Body>{};
}

tl::unexpected<Error> too_many_triangles(std::size_t max_triangles, Where where) {
  return fail(ErrorCode::BadInput,
              fmt::format("more than {} triangles; simplify the mesh", max_triangles),
              std::move(where));
}

Vec3<Body> PolygonMaker::tangent(const std::array<Corner, 3> &c) const {
  std::array<Vec3<Body>, 3> at;
  std::array<std::array<double, 2>, 3> uv{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (c[k].texture == no_index)
      return {};
    at[k] = mesh_.positions[c[k].vertex];
    uv[k] = textures[c[k].texture];
  }
  return texture_tangent(at, uv);
}

Result<void> PolygonMaker::add(std::span<const Corner> corners, std::uint32_t group,
                               const Where &where) {
  leave_if_stopped(cancel_, added_++);
  if (corners.size() < 3) {
    ++short_faces_;
    return {};
  }
  if (corners.size() > corners_max)
    return fail(
        ErrorCode::BadInput,
        fmt::format("a polygon of more than {} corners; split it into smaller ones", corners_max),
        where);
  if (mesh_.triangles.size() + corners.size() - 2 > max_triangles_)
    return too_many_triangles(max_triangles_, where);
  std::vector<Vec3<Body>> points;
  for (const Corner &one : corners)
    points.push_back(mesh_.positions[one.vertex]);
  const bool has_normals = std::all_of(corners.begin(), corners.end(),
                                       [](const Corner &c) { return c.normal != no_index; });
  const Triangulation split = triangulate(points);
  concave_ += split.is_simple && !split.is_convex ? 1u : 0u;
  crossed_ += split.is_simple ? 0u : 1u;
  bent_ += split.is_planar ? 0u : 1u;
  for (const auto &t : split.triangles) {
    Triangle triangle;
    triangle.front = triangle.back = group;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = corners[t[k]].vertex;
      triangle.normal[k] = has_normals ? corners[t[k]].normal : no_index;
    }
    mesh_.triangles.push_back(triangle);
    mesh_.tangents.push_back(tangent({corners[t[0]], corners[t[1]], corners[t[2]]}));
  }
  return {};
}

void PolygonMaker::warn(Diagnostics &diagnostics, const Where &file) const {
  const auto tell = [&](std::size_t count, const char *one, const char *more) {
    if (count > 0)
      diagnostics.warn(count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, more),
                       file);
  };
  tell(short_faces_, "face with fewer than three corners was skipped",
       "faces with fewer than three corners were skipped");
  tell(concave_, "polygon is concave; it was split by cutting ears",
       "polygons are concave; they were split by cutting ears");
  tell(crossed_, "polygon crosses itself; it was split as a fan",
       "polygons cross themselves; they were split as fans");
  tell(bent_, "polygon is not flat; it was split as it lies",
       "polygons are not flat; they were split as they lie");
}

void PolygonMaker::finish() {
  if (textures.empty())
    mesh_.tangents.clear();
}

bool has_area(const Mesh &mesh) {
  return std::ranges::any_of(mesh.triangles, [&](const Triangle &t) {
    const Vec3<Body> a = mesh.positions[t.vertex[0]];
    return norm(cross(mesh.positions[t.vertex[1]] - a, mesh.positions[t.vertex[2]] - a)) > 0;
  });
}

/// Warns of sizes that no satellite has: the largest, a space station, is 109 m long.
void warn_of_size(const Mesh &mesh, const MeshFileOptions &options, const std::string &file,
                  Diagnostics &diagnostics) {
  Vec3<Body> low = mesh.positions.front(), high = low;
  for (const Vec3<Body> p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3<Body> size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  if (!has_area(mesh)) {
    diagnostics.warn(longest > 0 ? "the mesh has no area: the corners of each face lie on a line"
                                 : "the mesh has no area: all corners are one point. Is a scale in "
                                   "the file 0?",
                     {file});
    if (!(longest > 0))
      return; // in whatever unit
  }
  if (longest >= 0.01 && longest <= 120)
    return;
  const bool is_long = longest > 120;
  diagnostics.warn(fmt::format("the mesh is {:.3g} m long, {} than any satellite; is unit = \"{}\" "
                               "right? With one a thousand times {} it is {:.3g} m",
                               longest, is_long ? "longer" : "shorter",
                               options.unit.empty() ? "m" : options.unit,
                               is_long ? "smaller" : "larger", longest * (is_long ? 1e-3 : 1e3)),
                   {file});
}

Result<void> to_body_frame(MeshFile &read, const MeshFileOptions &options, const std::string &file,
                           Diagnostics &diagnostics) {
  Mesh &mesh = read.mesh;
  if (mesh.triangles.empty())
    return fail(ErrorCode::BadInput, "no face; a mesh of polygons was expected", {file});
  UMOV_ASSIGN(metres, metres_of(mesh, options, {file}));
  for (Vec3<Body> &p : mesh.positions)
    p = turned(p * metres, options.up);
  for (Vec3<Body> &t : mesh.tangents)
    t = turned(t, options.up);
  for (MeshNode &node : read.nodes)
    node.origin_m = turned(node.origin_m * metres, options.up) + Vec3<Body>{}; // -0 becomes 0
  turn_normals(mesh, options.up);
  warn_of_size(mesh, options, file, diagnostics);
  return {};
}

void join_equal(Mesh &mesh, const std::atomic<bool> *cancel) {
  Joined positions(mesh.positions), normals(mesh.normals);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    leave_if_stopped(cancel, i);
    Triangle &t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      t.vertex[k] = positions.of(t.vertex[k]);
      t.normal[k] = normals.of(t.normal[k]);
    }
  }
  mesh.positions = std::move(positions.kept);
  mesh.normals = std::move(normals.kept);
}

} // namespace umov::mesh_io
