#include "light/between/mirror_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace umov {
namespace {

/// rms slope of a lobe: GGX of alpha 0.1.
constexpr double narrow = 0.07;
/// Cosine between normals of one part, at least: half the step of a tube of 48 sides.
constexpr double alike = 0.995;
/// A path looks at all of them: of more, the largest.
constexpr std::size_t most = 1024;

/// As long-tailed as the surface's own, or Beckmann's.
NormalSampler widened(const Distribution &normals, double width) {
  const auto form = normals.kernel_form();
  const bool is_ggx = form && form->kind == LobeKind::Ggx;
  return {KernelForm{is_ggx ? LobeKind::Ggx : LobeKind::Beckmann, std::numbers::sqrt2 * width}};
}

std::size_t end_of_part(const BounceScene &scene, std::size_t begin) {
  const std::vector<Triangle> &all = scene.scene().mesh.triangles;
  const auto normal = [&](std::size_t t) { return scene.normal(static_cast<std::uint32_t>(t)); };
  std::size_t end = begin + 1;
  while (end < all.size() && all[end].front == all[begin].front &&
         all[end].back == all[begin].back && dot(normal(end), normal(begin)) >= alike)
    ++end;
  return end;
}

/// Triangles in turn, one side of them.
struct Run {
  std::size_t begin, end;
  double area_m2;
  bool is_front;
};

double area_of(const BounceScene &scene, std::size_t begin, std::size_t end) {
  return std::accumulate(scene.areas().begin() + static_cast<std::ptrdiff_t>(begin),
                         scene.areas().begin() + static_cast<std::ptrdiff_t>(end), 0.0);
}

/// Some of it, which has an area.
bool is_seen(const BounceScene &scene, std::size_t begin, std::size_t end, bool is_front) {
  for (std::size_t t = begin; t < end; ++t)
    if (scene.areas()[begin] > 0 && (is_front ? scene.sides()[t].front : scene.sides()[t].back))
      return true;
  return false;
}

/// The rectangle in the plane of a normal, along the longest edge, that holds triangles.
void fit_rectangle(const Mesh &mesh, std::size_t begin, std::size_t end, Vec3<Body> plane,
                   MirrorPart &out) {
  double longest = 0;
  Vec3<Body> corner{};
  for (std::size_t t = begin; t < end; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &vertex = mesh.triangles[t].vertex;
      corner = mesh.positions[vertex[k]];
      const Vec3<Body> edge = mesh.positions[vertex[(k + 1) % 3]] - corner;
      const Vec3<Body> flat = edge - plane * dot(edge, plane);
      if (norm(flat) > longest) {
        longest = norm(flat);
        out.along = flat / longest;
      }
    }
  out.across = cross(plane, out.along);
  constexpr double far = std::numeric_limits<double>::infinity();
  double low[3] = {far, far, far}, high[3] = {-far, -far, -far};
  for (std::size_t t = begin; t < end; ++t)
    for (const std::uint32_t v : mesh.triangles[t].vertex) {
      const Vec3<Body> at = mesh.positions[v];
      const double place[3] = {dot(at, out.along), dot(at, out.across), dot(at, plane)};
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], place[k]);
        high[k] = std::max(high[k], place[k]);
      }
    }
  out.half_along_m = (high[0] - low[0]) / 2;
  out.half_across_m = (high[1] - low[1]) / 2;
  out.centre = out.along * ((low[0] + high[0]) / 2) + out.across * ((low[1] + high[1]) / 2) +
               plane * ((low[2] + high[2]) / 2);
}

/// The mean shading normal of one side, and the mean square of slopes from it: normals that turn
/// evenly from edge to edge are a third as far from the middle, in the mean square, as those of the
/// edges.
double bend_of(const BounceScene &scene, std::size_t begin, std::size_t end, double side,
               Vec3<Body> &mean) {
  const Mesh &mesh = scene.scene().mesh;
  std::vector<Vec3<Body>> normals;
  for (std::size_t t = begin; t < end; ++t)
    for (const std::uint32_t n : mesh.triangles[t].normal) {
      const Vec3<Body> flat = side * scene.normal(static_cast<std::uint32_t>(t));
      const bool is_smooth = scene.scene().normals == NormalMode::Smooth && n != no_index;
      const Vec3<Body> bent = is_smooth ? mesh.normals[n] : flat;
      normals.push_back(normalized(dot(bent, flat) < 0 ? -bent : bent));
      mean += normals.back();
    }
  mean = normalized(mean);
  double squares = 0;
  for (const Vec3<Body> n : normals)
    squares += std::max(0.0, 1 - dot(n, mean) * dot(n, mean));
  return squares / static_cast<double>(normals.size()) / 3;
}

} // namespace

bool MirrorParts::is_narrow(const Surface &surface) {
  return !surface.has_mirror() && !surface.material().measured && surface.normals(0) != nullptr &&
         surface.width() < narrow;
}

MirrorParts::MirrorParts(const BounceScene &scene) {
  const Mesh &mesh = scene.scene().mesh;
  of_.assign(2 * mesh.triangles.size(), none);
  std::vector<Run> runs;
  for (std::size_t begin = 0, end = 0; begin < mesh.triangles.size(); begin = end) {
    end = end_of_part(scene, begin);
    for (const bool is_front : {true, false})
      if (is_seen(scene, begin, end, is_front) &&
          is_narrow(surface_of_side(scene.scene(), mesh.triangles[begin], is_front)))
        runs.push_back({begin, end, area_of(scene, begin, end), is_front});
  }
  if (runs.size() > most) {
    std::stable_sort(runs.begin(), runs.end(),
                     [](const Run &a, const Run &b) { return a.area_m2 > b.area_m2; });
    runs.resize(most);
  }
  for (const Run &run : runs)
    add(scene, run.begin, run.end, run.is_front);
}

void MirrorParts::add(const BounceScene &scene, std::size_t begin, std::size_t end, bool is_front) {
  const Mesh &mesh = scene.scene().mesh;
  const Surface &surface = surface_of_side(scene.scene(), mesh.triangles[begin], is_front);
  MirrorPart part;
  fit_rectangle(mesh, begin, end, scene.normal(static_cast<std::uint32_t>(begin)), part);
  const double bend = bend_of(scene, begin, end, is_front ? 1 : -1, part.normal);
  part.width = std::sqrt(surface.width() * surface.width() + bend);
  part.normals = widened(*surface.normals(0), part.width);
  for (std::size_t t = begin; t < end; ++t)
    of_[2 * t + (is_front ? 0 : 1)] = static_cast<std::uint32_t>(parts_.size());
  parts_.push_back(part);
}

} // namespace umov
