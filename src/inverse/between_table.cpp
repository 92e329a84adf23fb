#include <umov/inverse/between_table.h>

#include "inverse/octahedron.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <umov/core/parallel.h>
#include <utility>

namespace umov {
using inverse::DirectionGrid;

namespace {

constexpr std::uint32_t unlit = std::numeric_limits<std::uint32_t>::max(), asked = unlit - 1;
constexpr std::size_t parameters = 3;

/// What lies between nodes may be off by so much of it (95 %; docs/theory/inverse.md).
constexpr double between_nodes = 0.1;

/// Poses of one call that follow each other closely may share their light (Integrator::evaluate),
/// which would make a node's depend on what else was asked with it. Turns of Sun and observer [rad]
/// from which on they do not.
constexpr double apart_rad = 0.6;

/// In an order in which neighbours of the grid stand far from each other.
std::uint64_t scattered(std::size_t number) { return number * 0x9E3779B97F4A7C15ULL; }

double turn_between(const Pose &a, const Pose &b) {
  return angle_between(a.sun, b.sun) + angle_between(a.observer, b.observer);
}

} // namespace

BetweenTable::BetweenTable(std::size_t cells, double sun_radius_rad, bool is_reciprocal)
    : cells_(cells), sun_radius_rad_(sun_radius_rad), is_reciprocal_(is_reciprocal) {
  const std::size_t nodes = DirectionGrid{cells}.nodes();
  row_.assign(is_reciprocal ? nodes * (nodes + 1) / 2 : nodes * nodes, unlit);
}

std::size_t BetweenTable::lit() const {
  const std::shared_lock lock(mutex_);
  return rows_;
}

std::size_t BetweenTable::number_of(std::size_t sun, std::size_t observer) const {
  const std::size_t nodes = DirectionGrid{cells_}.nodes();
  return is_reciprocal_ ? inverse::pair_of(sun, observer, nodes) : sun * nodes + observer;
}

/// Pairs about the poses that have no light yet; they count as asked for.
std::vector<std::size_t> BetweenTable::take_missing(std::span<const Pose> poses) {
  const DirectionGrid grid{cells_};
  std::vector<std::size_t> out;
  for (const Pose &pose : poses) {
    const DirectionGrid::Corner sun = grid.corner(pose.sun), observer = grid.corner(pose.observer);
    for (std::size_t s = 0; s < 4; ++s)
      for (std::size_t o = 0; o < 4; ++o) {
        if (!(sun.weight[s] * observer.weight[o] > 0))
          continue;
        const std::size_t number = number_of(sun.node[s], observer.node[o]);
        if (row_[number] != unlit)
          continue;
        row_[number] = asked;
        out.push_back(number);
      }
  }
  std::ranges::sort(out, {}, scattered);
  return out;
}

Pose BetweenTable::node(std::size_t number) const {
  const DirectionGrid grid{cells_};
  const std::size_t nodes = grid.nodes();
  std::size_t sun = number / nodes, observer = number % nodes;
  if (is_reciprocal_) { // the last row that does not begin after it
    const auto first = [nodes](std::size_t low) { return inverse::pair_of(low, low, nodes); };
    std::size_t end = nodes;
    for (sun = 0; sun + 1 < end;) {
      const std::size_t middle = (sun + end) / 2;
      (first(middle) <= number ? sun : end) = middle;
    }
    observer = sun + (number - first(sun));
  }
  return {grid.direction(sun), grid.direction(observer), sun_radius_rad_};
}

bool BetweenTable::light_missing(std::span<const Pose> poses, const PoseLighting &whole) {
  const std::unique_lock lock(mutex_);
  std::vector<std::size_t> missing = take_missing(poses), later;
  StokesTable lit;
  std::vector<Pose> at;
  std::vector<std::size_t> now;
  for (; !missing.empty(); std::swap(missing, later), later.clear()) {
    at.clear();
    now.clear();
    for (const std::size_t number : missing) {
      const Pose pose = node(number);
      if (!at.empty() && turn_between(at.back(), pose) < apart_rad) {
        later.push_back(number);
        continue;
      }
      at.push_back(pose);
      now.push_back(number);
    }
    if (!whole(at, lit)) {
      for (const std::size_t number : missing)
        row_[number] = unlit;
      return false;
    }
    bands_ = lit.bands;
    for (std::size_t k = 0; k < now.size(); ++k) {
      row_[now[k]] = static_cast<std::uint32_t>(rows_++);
      for (std::size_t b = 0; b < bands_; ++b) {
        const Stokes<ScatteringPlane> s =
            lit.indirect.empty() ? Stokes<ScatteringPlane>{} : lit.indirect[k * bands_ + b];
        for (const double x : {s.i, s.q, s.u})
          light_.push_back(std::isfinite(s.i + s.q + s.u) ? static_cast<float>(x) : 0);
      }
    }
  }
  return true;
}

void BetweenTable::add_one(StokesTable &direct, std::size_t k, const Pose &pose) const {
  const DirectionGrid grid{cells_};
  const DirectionGrid::Corner sun = grid.corner(pose.sun), observer = grid.corner(pose.observer);
  const bool has_widths = direct.i_err.size() == direct.i.size();
  for (std::size_t s = 0; s < 4; ++s)
    for (std::size_t o = 0; o < 4; ++o) {
      const double w = static_cast<double>(sun.weight[s] * observer.weight[o]);
      if (!(w > 0))
        continue;
      const bool is_swapped = is_reciprocal_ && sun.node[s] > observer.node[o];
      const float *from =
          light_.data() + row_[number_of(sun.node[s], observer.node[o])] * bands_ * parameters;
      for (std::size_t b = 0; b < bands_; ++b, from += parameters) {
        const std::size_t at = k * direct.bands + b;
        const double i = w * static_cast<double>(from[0]);
        direct.i[at] += i;
        direct.q[at] += w * static_cast<double>(from[1]);
        direct.u[at] += (is_swapped ? -w : w) * static_cast<double>(from[2]);
        if (has_widths)
          direct.i_err[at] += between_nodes * i;
      }
    }
}

bool BetweenTable::add_to(StokesTable &direct, std::span<const Pose> poses,
                          const PoseLighting &whole, unsigned threads) {
  if (!light_missing(poses, whole))
    return false;
  const std::shared_lock lock(mutex_);
  constexpr std::size_t chunk = 1024;
  parallel_for((poses.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
    for (std::size_t k = c * chunk; k < std::min(poses.size(), (c + 1) * chunk); ++k)
      add_one(direct, k, poses[k]);
  });
  return true;
}

PoseLighting BetweenTable::lighting(PoseLighting direct, PoseLighting whole,
                                    std::shared_ptr<BetweenTable> table, unsigned threads) {
  return [direct = std::move(direct), whole = std::move(whole), table = std::move(table),
          threads](std::span<const Pose> poses, StokesTable &out) {
    return direct(poses, out) && table->add_to(out, poses, whole, threads);
  };
}

} // namespace umov
