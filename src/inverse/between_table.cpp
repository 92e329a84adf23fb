#include <umov/inverse/between_table.h>

#include "inverse/octahedron.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <umov/core/parallel.h>
#include <umov/optics/stokes.h>
#include <utility>

namespace umov {
using inverse::DirectionGrid;

namespace {

constexpr std::uint32_t unlit = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t parameters = 3, at_once = 512;

/// What lies between nodes may be off by so much of it (95 %; docs/theory/inverse.md, 6.1).
constexpr double between_nodes = 0.1;

/// From +Q of the scattering plane to a body axis as the observer sees it, about the beam. A plane
/// turns fast where Sun and observer are near each other; axes that stand in the body do not.
Angle turn_to(const Pose &pose, const Vec3<Body> &axis) {
  const Vec3<Body> &k = pose.observer, s = cross(k, pose.sun), t = axis - k * dot(axis, k);
  return Angle::radians(std::atan2(dot(t, cross(k, s)), dot(t, s)));
}

/// That body axis from which nobody about the observer's direction looks along it.
Vec3<Body> axis_across(const Vec3<Body> &observer) {
  const std::array along{std::abs(observer.x), std::abs(observer.y), std::abs(observer.z)};
  const auto least = std::ranges::min_element(along) - along.begin();
  return least == 0 ? Vec3<Body>{1, 0, 0} : least == 1 ? Vec3<Body>{0, 1, 0} : Vec3<Body>{0, 0, 1};
}

/// Calls `take(node, weight)` for the nodes about a pose.
template <class Take>
void for_each_node(const DirectionGrid &grid, const Pose &pose, const Take &take) {
  const DirectionGrid::Corner sun = grid.corner(pose.sun), observer = grid.corner(pose.observer);
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t o = 0; o < 4; ++o)
      if (const float w = sun.weight[s] * observer.weight[o]; w > 0)
        take(sun.node[s] * grid.nodes() + observer.node[o], static_cast<double>(w));
}

} // namespace

BetweenTable::BetweenTable(std::size_t cells, double sun_radius_rad)
    : cells_(cells), sun_radius_rad_(sun_radius_rad) {
  const std::size_t nodes = DirectionGrid{cells}.nodes();
  row_.assign(nodes * nodes, unlit);
}

std::size_t BetweenTable::lit() const {
  const std::shared_lock lock(mutex_);
  return rows_;
}

/// Directions of a node; where they leave no plane the Sun stands a little beside, so that Q and U
/// have a limit.
Pose BetweenTable::node(std::size_t number) const {
  const DirectionGrid grid{cells_};
  Pose out{grid.direction(number / grid.nodes()), grid.direction(number % grid.nodes()),
           sun_radius_rad_};
  constexpr double beside_rad = 1e-3;
  if (norm(cross(out.sun, out.observer)) < beside_rad)
    out.sun = normalized(out.sun + axis_across(out.sun) * (2 * beside_rad));
  return out;
}

std::vector<std::size_t> BetweenTable::missing(std::span<const Pose> poses) const {
  const DirectionGrid grid{cells_};
  std::vector<std::size_t> out;
  for (const Pose &pose : poses)
    for_each_node(grid, pose, [&](std::size_t number, double) {
      if (row_[number] == unlit)
        out.push_back(number);
    });
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Each by itself: what paths draw depends on a pose's place in a list.
bool BetweenTable::light_missing(std::span<const Pose> poses, const Lighting &lighting) {
  const std::unique_lock lock(mutex_);
  const std::vector<std::size_t> numbers = missing(poses);
  std::vector<StokesTable> lit(std::min(at_once, numbers.size()));
  for (std::size_t begin = 0; begin < numbers.size(); begin += at_once) {
    if (lighting.progress)
      lighting.progress(begin, numbers.size());
    const std::size_t count = std::min(at_once, numbers.size() - begin);
    std::atomic<bool> is_stopped = false;
    parallel_for(count, lighting.threads, [&](std::size_t k) {
      const Pose pose = node(numbers[begin + k]);
      if (!is_stopped && !lighting.whole({&pose, 1}, lit[k]))
        is_stopped = true;
    });
    if (is_stopped)
      return false;
    for (std::size_t k = 0; k < count; ++k) {
      bands_ = lit[k].bands;
      for (std::size_t b = 0; b < bands_; ++b) {
        const Stokes<ScatteringPlane> s =
            lit[k].indirect.empty() ? Stokes<ScatteringPlane>{} : lit[k].indirect[b];
        for (const double x : {s.i, s.q, s.u})
          light_.push_back(std::isfinite(s.i + s.q + s.u) ? static_cast<float>(x) : 0);
      }
      row_[numbers[begin + k]] = static_cast<std::uint32_t>(rows_++);
    }
  }
  if (lighting.progress && !numbers.empty())
    lighting.progress(numbers.size(), numbers.size());
  return true;
}

void BetweenTable::add_one(StokesTable &direct, std::size_t k, const Pose &pose) const {
  const bool has_widths = direct.i_err.size() == direct.i.size();
  const bool has_plane = has_scattering_plane(pose);
  const Vec3<Body> axis = axis_across(pose.observer);
  const double back = has_plane ? turn_to(pose, axis).radians() : 0;
  for_each_node(DirectionGrid{cells_}, pose, [&](std::size_t number, double w) {
    const Angle turn = Angle::radians(turn_to(node(number), axis).radians() - back);
    const float *from = light_.data() + row_[number] * bands_ * parameters;
    for (std::size_t b = 0; b < bands_; ++b, from += parameters) {
      const Stokes<ScatteringPlane> there{static_cast<double>(from[0]),
                                          static_cast<double>(from[1]),
                                          static_cast<double>(from[2]), 0};
      const Stokes<ScatteringPlane> here = rotate_to<ScatteringPlane>(there, turn) * w;
      const std::size_t at = k * direct.bands + b;
      direct.i[at] += here.i;
      if (has_plane) {
        direct.q[at] += here.q;
        direct.u[at] += here.u;
      }
      if (has_widths)
        direct.i_err[at] += between_nodes * here.i;
    }
  });
}

bool BetweenTable::add_to(StokesTable &direct, std::span<const Pose> poses,
                          const Lighting &lighting) {
  if (!light_missing(poses, lighting))
    return false;
  const std::shared_lock lock(mutex_);
  constexpr std::size_t chunk = 1024;
  parallel_for((poses.size() + chunk - 1) / chunk, lighting.threads, [&](std::size_t c) {
    for (std::size_t k = c * chunk; k < std::min(poses.size(), (c + 1) * chunk); ++k)
      add_one(direct, k, poses[k]);
  });
  return true;
}

PoseLighting BetweenTable::beside(PoseLighting direct, Lighting lighting,
                                  std::shared_ptr<BetweenTable> table) {
  return [direct = std::move(direct), lighting = std::move(lighting),
          table = std::move(table)](std::span<const Pose> poses, StokesTable &out) {
    return direct(poses, out) && table->add_to(out, poses, lighting);
  };
}

} // namespace umov
