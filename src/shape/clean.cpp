#include <umov/shape/topology.h>

#include "shape/pairs.h"
#include "shape/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <umov/core/text.h>

namespace umov {

FacePairs find_pairs(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                     const std::vector<bool> &skip) {
  FacePairs out;
  out.partner.resize(mesh.triangles.size());
  out.is_opposite.assign(mesh.triangles.size(), false);
  struct Seen {
    std::uint32_t forward = no_index, backward = no_index;
  };
  std::map<std::array<std::uint32_t, 3>, Seen> seen;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    out.partner[i] = i;
    if (skip[i])
      continue;
    std::array<std::uint32_t, 3> key{};
    for (std::size_t k = 0; k < 3; ++k)
      key[k] = welded[mesh.triangles[i].vertex[k]];
    // Even permutations of the sorted corners wind one way, odd ones the other.
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    const bool forward = key[1] < key[2];
    std::sort(key.begin(), key.end());
    Seen &entry = seen[key];
    std::uint32_t &same = forward ? entry.forward : entry.backward;
    const std::uint32_t other = forward ? entry.backward : entry.forward;
    if (same != no_index) {
      out.partner[i] = same;
      ++out.duplicates;
    } else if (other != no_index) {
      out.partner[i] = other;
      out.is_opposite[i] = true;
      ++out.opposites;
      same = i;
    } else {
      same = i;
    }
  }
  return out;
}

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

} // namespace

Result<Mesh> clean_mesh(const Mesh &mesh, Diagnostics &diagnostics, const std::string &file) {
  UMOV_TRY(check_numbers(mesh));
  const auto welded = weld(mesh, weld_distance(mesh));
  std::vector<bool> skip(mesh.triangles.size());
  std::size_t degenerate = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    skip[i] = is_degenerate(mesh, mesh.triangles[i], welded);
    degenerate += skip[i] ? 1u : 0u;
  }
  const FacePairs pairs = find_pairs(mesh, welded, skip);
  Mesh out;
  out.positions = mesh.positions;
  out.normals = mesh.normals;
  out.groups = mesh.groups;
  out.nodes = mesh.nodes;
  std::vector<std::uint32_t> place(mesh.triangles.size(), no_index);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (skip[i])
      continue;
    if (pairs.partner[i] == i) {
      place[i] = static_cast<std::uint32_t>(out.triangles.size());
      out.triangles.push_back(mesh.triangles[i]);
      if (!mesh.tangents.empty())
        out.tangents.push_back(mesh.tangents[i]);
    } else if (pairs.is_opposite[i]) {
      out.triangles[place[pairs.partner[i]]].back = mesh.triangles[i].front;
    }
  }
  warn_count(diagnostics, file, degenerate, "triangle without area was dropped",
             "triangles without area were dropped");
  warn_count(diagnostics, file, pairs.duplicates, "triangle that repeats another one was dropped",
             "triangles that repeat another one were dropped");
  warn_count(diagnostics, file, pairs.opposites,
             "pair of coincident opposite faces became one two-sided face",
             "pairs of coincident opposite faces became one two-sided face each");
  if (out.triangles.empty())
    return fail(ErrorCode::BadInput, "no face with an area; a mesh of triangles was expected",
                {file});
  return out;
}

} // namespace umov
