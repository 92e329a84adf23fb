#include <umov/shape/topology.h>

#include "shape/pairs.h"
#include "shape/weld.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov {

namespace {

Result<void> check_numbers(const Mesh &mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (const auto p = mesh.positions[i];
        !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return fail(ErrorCode::BadInput,
                  fmt::format("vertex {} is ({}, {}, {}); finite numbers were expected", i + 1, p.x,
                              p.y, p.z));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle &t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k)
      if (t.vertex[k] >= mesh.positions.size() ||
          (t.normal[k] != no_index && t.normal[k] >= mesh.normals.size()))
        return fail(ErrorCode::BadInput,
                    fmt::format("triangle {} names a vertex or normal that is not there", i + 1));
    if (t.front >= mesh.groups.size() || t.back >= mesh.groups.size())
      return fail(ErrorCode::BadInput,
                  fmt::format("triangle {} names a material that is not there", i + 1));
  }
  return {};
}

void warn_count(Diagnostics &diagnostics, const std::string &file, std::size_t count,
                const char *singular, const char *plural) {
  if (count > 0)
    diagnostics.warn(counted(count, singular, plural), {file});
}

/// Overlaps that have no clear meaning, by their materials.
void warn_of_rest(const Mesh &mesh, const Coincidence &found, Diagnostics &diagnostics,
                  const std::string &file) {
  constexpr std::size_t most = 5;
  for (std::size_t k = 0; k < std::min(most, found.rest.size()); ++k) {
    const Coincidence::Rest &r = found.rest[k];
    const std::string &a = mesh.groups[r.first_group], &b = mesh.groups[r.second_group];
    const std::string of = r.first_group == r.second_group
                               ? fmt::format("faces of \"{}\"", a)
                               : fmt::format("faces of \"{}\" and \"{}\"", a, b);
    diagnostics.warn(
        fmt::format("{} lie upon each other in one plane over {:.4g} m2, {}: their light may count "
                    "twice there. {}.",
                    of, r.area_m2, r.is_opposite ? "facing opposite ways" : "facing the same way",
                    r.is_opposite ? "Give both the same outline (they become one two-sided face) "
                                    "or cut one of them away"
                                  : "Cut the one out of the other or take it away"),
        {file});
  }
  if (found.rest.size() > most)
    diagnostics.warn(fmt::format("faces of {} overlap in one plane too",
                                 counted(found.rest.size() - most, "other pair of materials",
                                         "other pairs of materials")),
                     {file});
  warn_count(diagnostics, file, found.not_searched,
             "triangle lies in too dense a crowd to look for faces that lie upon it",
             "triangles lie in too dense a crowd to look for faces that lie upon them");
}

} // namespace

Result<Mesh> clean_mesh(const Mesh &mesh, Diagnostics &diagnostics, const std::string &file,
                        const std::atomic<bool> *cancel) {
  UMOV_TRY(check_numbers(mesh));
  const auto welded = weld(mesh, weld_distance(mesh), cancel);
  std::vector<bool> skip(mesh.triangles.size());
  std::size_t degenerate = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    skip[i] = is_degenerate(mesh, mesh.triangles[i], welded);
    degenerate += skip[i] ? 1u : 0u;
  }
  const Coincidence found = find_coincidence(mesh, welded, skip, cancel);
  Mesh out;
  out.positions = mesh.positions;
  out.normals = mesh.normals;
  out.groups = mesh.groups;
  out.nodes = mesh.nodes;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (skip[i] || found.is_dropped[i])
      continue;
    out.triangles.push_back(mesh.triangles[i]);
    if (found.back[i] != no_index)
      out.triangles.back().back = found.back[i];
    if (!mesh.tangents.empty())
      out.tangents.push_back(mesh.tangents[i]);
  }
  warn_count(diagnostics, file, degenerate, "triangle without area was dropped",
             "triangles without area were dropped");
  warn_count(diagnostics, file, found.duplicates, "triangle that repeats another one was dropped",
             "triangles that repeat another one were dropped");
  warn_count(diagnostics, file, found.other_group,
             "dropped triangle was of another material than what it repeats, which stays",
             "dropped triangles were of another material than what they repeat, which stays");
  warn_count(diagnostics, file, found.opposites,
             "pair of coincident opposite faces became one two-sided face",
             "pairs of coincident opposite faces became one two-sided face each");
  warn_of_rest(mesh, found, diagnostics, file);
  if (out.triangles.empty())
    return fail(ErrorCode::BadInput, "no face with an area; a mesh of triangles was expected",
                {file});
  return out;
}

} // namespace umov
