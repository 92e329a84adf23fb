#include "shape/pairs.h"

#include "shape/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <umov/core/stop.h>

namespace umov {

FacePairs find_pairs(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                     const std::vector<bool> &skip, const std::atomic<bool> *cancel) {
  FacePairs out;
  out.partner.resize(mesh.triangles.size());
  out.is_opposite.assign(mesh.triangles.size(), false);
  struct Face {
    std::array<std::uint32_t, 3> corners; ///< sorted
    std::uint32_t triangle;
    bool forward;
  };
  std::vector<Face> faces;
  faces.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    leave_if_stopped(cancel, i);
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
    faces.push_back({key, i, forward});
  }
  std::size_t compared = 0;
  std::sort(faces.begin(), faces.end(), [&](const Face &a, const Face &b) {
    leave_if_stopped(cancel, compared++);
    return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
  });
  std::uint32_t first[2] = {no_index, no_index}; // of these corners, one for each winding
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const Face &face = faces[k];
    if (k == 0 || face.corners != faces[k - 1].corners)
      first[0] = first[1] = no_index;
    std::uint32_t &same = first[face.forward ? 1 : 0];
    const std::uint32_t other = first[face.forward ? 0 : 1];
    if (same == no_index && other != no_index)
      out.is_opposite[face.triangle] = true;
    if (same != no_index || other != no_index)
      out.partner[face.triangle] = same != no_index ? same : other;
    if (same == no_index)
      same = face.triangle;
  }
  return out;
}

namespace {

/// Sets of triangles that hang together by overlaps.
class Clusters {
public:
  explicit Clusters(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

private:
  std::vector<std::uint32_t> parent_;
};

using OverlapList = std::vector<const Overlap *>;

class Sorting {
public:
  Sorting(const Mesh &mesh, const std::vector<std::uint32_t> &welded, const std::vector<bool> &skip,
          const std::atomic<bool> *cancel)
      : mesh_(mesh), welded_(welded), near_(2 * weld_distance(mesh)) {
    const std::size_t count = mesh.triangles.size();
    out_.is_dropped.assign(count, false);
    out_.back.assign(count, no_index);
    pairs_ = find_pairs(mesh, welded, skip, cancel);
    std::vector<bool> leave_out = skip;
    for (std::uint32_t i = 0; i < count; ++i)
      if (pairs_.partner[i] != i && !pairs_.is_opposite[i]) {
        drop_duplicate(i, pairs_.partner[i]);
        leave_out[i] = true;
      }
    overlaps_ = find_overlaps(mesh, welded, leave_out, cancel);
    out_.not_searched = overlaps_.not_searched;
  }

  Coincidence run() {
    for_each_cluster(false, [&](const OverlapList &list) { drop_repeats(list); });
    for (std::uint32_t i = 0; i < out_.back.size(); ++i)
      if (pairs_.is_opposite[i] && !out_.is_dropped[i] && !out_.is_dropped[pairs_.partner[i]])
        add_back(pairs_.partner[i], i);
    for_each_cluster(true, [&](const OverlapList &list) { merge_sides(list); });
    tell_rest();
    return std::move(out_);
  }

private:
  void drop_duplicate(std::uint32_t i, std::uint32_t of) {
    out_.is_dropped[i] = true;
    ++out_.duplicates;
    out_.other_group += mesh_.triangles[i].front != mesh_.triangles[of].front ? 1u : 0u;
  }

  void add_back(std::uint32_t front, std::uint32_t back) {
    out_.back[front] = mesh_.triangles[back].front;
    out_.is_dropped[back] = true;
    ++out_.opposites;
  }

  [[nodiscard]] bool is_single(std::uint32_t i) const {
    return !out_.is_dropped[i] && out_.back[i] == no_index;
  }

  /// Calls take(overlaps) for each set of triangles that overlaps of one kind hold together, in
  /// order of the sets' first triangles.
  template <class Take> void for_each_cluster(bool opposite, Take take) {
    Clusters clusters(mesh_.triangles.size());
    OverlapList chosen;
    for (const Overlap &o : overlaps_.pairs)
      if (o.is_opposite == opposite && is_single(o.first) && is_single(o.second)) {
        clusters.join(o.first, o.second);
        chosen.push_back(&o);
      }
    std::map<std::uint32_t, std::size_t> place; // root, place in lists
    std::vector<OverlapList> lists;
    for (const Overlap *o : chosen) {
      const auto [at, is_new] = place.try_emplace(clusters.root(o->first), lists.size());
      if (is_new)
        lists.emplace_back();
      lists[at->second].push_back(o);
    }
    for (const OverlapList &list : lists)
      take(list);
  }

  struct Cover {
    double area = 0, sum = 0, slack = 0; ///< of the triangle; of what covers it; what may lack
    bool is_second = false;              ///< of the second layer
    std::uint32_t group = no_index;      ///< of what covers it, if one
    bool has_groups = false;             ///< several

    void add(double part, std::uint32_t of) {
      sum += part;
      has_groups = has_groups || (group != no_index && group != of);
      group = of;
    }
    [[nodiscard]] bool is_full(double times = 1) const {
      return std::abs(sum - times * area) <= times * slack;
    }
  };
  using Covers = std::map<std::uint32_t, Cover>;

  [[nodiscard]] Covers members(const OverlapList &list) const {
    bool is_flat = true;
    for (const Overlap *o : list)
      is_flat = is_flat && o->apart_m <= near_;
    Covers out;
    for (const Overlap *o : list)
      for (const std::uint32_t i : {o->first, o->second})
        out[i];
    for (auto &[i, cover] : out) {
      const auto &v = mesh_.triangles[i].vertex;
      double round = 0;
      for (std::size_t k = 0; k < 3; ++k)
        round += norm(mesh_.positions[v[(k + 1) % 3]] - mesh_.positions[v[k]]);
      cover.area = norm(area_vector_doubled(mesh_, mesh_.triangles[i])) / 2;
      cover.slack = 3 * near_ * round + (is_flat ? 1e-9 : 3e-3) * cover.area;
    }
    return out;
  }

  /// Triangles that only nearly lie in one plane must at least have the same outline: what bounds
  /// the one layer bounds the other one too, corner by corner. `turn`: -1 for layers that face the
  /// same way.
  [[nodiscard]] bool has_one_outline(const OverlapList &list, const Covers &covers,
                                     int turn) const {
    if (std::all_of(list.begin(), list.end(),
                    [&](const Overlap *o) { return o->apart_m <= near_; }))
      return true;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto &[i, cover] : covers)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = welded_[mesh_.triangles[i].vertex[k]];
        const std::uint32_t b = welded_[mesh_.triangles[i].vertex[(k + 1) % 3]];
        edges[std::minmax(a, b)] += (a < b ? 1 : -1) * (cover.is_second ? turn : 1);
      }
    return std::all_of(edges.begin(), edges.end(), [](const auto &e) { return e.second == 0; });
  }

  /// Layers that face the same way: all but the first in the file, if each covers it exactly.
  void drop_repeats(const OverlapList &list) {
    Covers covers = members(list);
    std::map<std::uint32_t, std::vector<std::uint32_t>> touching;
    for (const Overlap *o : list)
      touching[o->second].push_back(o->first);
    for (auto &[i, cover] : covers)
      for (const std::uint32_t earlier : touching[i])
        cover.is_second = cover.is_second || !covers[earlier].is_second;
    for (const Overlap *o : list)
      if (covers[o->first].is_second != covers[o->second].is_second) {
        covers[o->first].add(o->area_m2, mesh_.triangles[o->second].front);
        covers[o->second].add(o->area_m2, mesh_.triangles[o->first].front);
      }
    for (const auto &[i, cover] : covers)
      if (!cover.is_full(cover.is_second ? 1 : std::max(1.0, std::round(cover.sum / cover.area))))
        return;
    if (!has_one_outline(list, covers, -1))
      return;
    for (const auto &[i, cover] : covers)
      if (cover.is_second) {
        out_.is_dropped[i] = true;
        ++out_.duplicates;
        out_.other_group += cover.has_groups || cover.group != mesh_.triangles[i].front ? 1u : 0u;
      }
  }

  /// Two layers that face opposite ways: one of them with both materials, if they cover each other
  /// exactly. The first in the file stays unless its back would want several materials in one face.
  void merge_sides(const OverlapList &list) {
    Covers covers = members(list);
    const auto direction = [&](std::uint32_t i) {
      return area_vector_doubled(mesh_, mesh_.triangles[i]);
    };
    const Vec3<Body> front = direction(covers.begin()->first);
    for (auto &[i, cover] : covers)
      cover.is_second = dot(direction(i), front) < 0;
    for (const Overlap *o : list) {
      covers[o->first].add(o->area_m2, mesh_.triangles[o->second].front);
      covers[o->second].add(o->area_m2, mesh_.triangles[o->first].front);
    }
    bool can_stay[2] = {true, true};
    for (const auto &[i, cover] : covers) {
      if (!cover.is_full())
        return;
      if (cover.has_groups)
        can_stay[cover.is_second ? 1 : 0] = false;
    }
    if ((!can_stay[0] && !can_stay[1]) || !has_one_outline(list, covers, 1))
      return;
    for (const auto &[i, cover] : covers)
      if (cover.is_second == !can_stay[0]) {
        out_.back[i] = cover.group;
        ++out_.opposites;
      } else {
        out_.is_dropped[i] = true;
      }
  }

  void tell_rest() {
    std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, double> area;
    for (const Overlap &o : overlaps_.pairs) {
      if (out_.is_dropped[o.first] || out_.is_dropped[o.second] || o.apart_m > near_)
        continue;
      const auto [low, high] =
          std::minmax(mesh_.triangles[o.first].front, mesh_.triangles[o.second].front);
      area[{low, high, o.is_opposite}] += o.area_m2;
    }
    for (const auto &[key, sum] : area)
      out_.rest.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), sum});
    std::stable_sort(out_.rest.begin(), out_.rest.end(),
                     [](const Coincidence::Rest &a, const Coincidence::Rest &b) {
                       return a.area_m2 > b.area_m2;
                     });
  }

  const Mesh &mesh_;
  const std::vector<std::uint32_t> &welded_;
  double near_;
  FacePairs pairs_;
  Overlaps overlaps_;
  Coincidence out_;
};

} // namespace

Coincidence find_coincidence(const Mesh &mesh, const std::vector<std::uint32_t> &welded,
                             const std::vector<bool> &skip, const std::atomic<bool> *cancel) {
  return Sorting(mesh, welded, skip, cancel).run();
}

} // namespace umov
