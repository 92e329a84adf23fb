#include "light/between/chain_level.h"

#include "light/between/beam_axes.h"
#include "light/fast/octahedron.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

static_assert(replicates == backend::lanes);

/// Fewer chains of one likeness than this per replicate share blocks with others.
constexpr std::size_t alone_from = 8;
/// Blocks that several poses are lit by in turn, while the cache has them.
constexpr std::size_t blocks_at_a_time = 64;
/// Directions this far below the horizon of an end are asked just above it, since interpolation
/// between directions needs them [sine].
constexpr double below_horizon = 0.12, above_horizon = 0.005;

using LikeChains = std::array<std::vector<const Chain *>, replicates>;

void put_vector(Vec3<Body> from, float (&to)[3][backend::lanes], std::size_t lane) {
  to[0][lane] = static_cast<float>(from.x);
  to[1][lane] = static_cast<float>(from.y);
  to[2][lane] = static_cast<float>(from.z);
}
void put_end(const ChainEnd &from, backend::ChainEnds &to, std::size_t lane) {
  put_vector(from.normal, to.normal, lane);
  put_vector(from.along, to.along, lane);
  put_vector(from.axis, to.axis, lane);
}

/// A direction of the ends' grid.
struct GridRay {
  std::size_t at;
  Vec3<Body> direction;
  Occluder::Point rounded;
};
Occluder::Point rounded(Vec3<Body> d) {
  return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}

/// In tiles of 4 x 4, the size of a packet of rays, that takes one way through the mesh.
std::vector<GridRay> grid_rays() {
  constexpr std::size_t edge = chain_mask_cells + 1;
  std::vector<GridRay> out;
  for (std::size_t k = 0; k < edge * edge; ++k) {
    const Vec3<Body> d = grid_direction(chain_mask_cells, k);
    out.push_back({k, d, rounded(d)});
  }
  std::sort(out.begin(), out.end(), [](const GridRay &a, const GridRay &b) {
    const auto tile = [](std::size_t k) { return std::array{k / edge / 4, k % edge / 4, k}; };
    return tile(a.at) < tile(b.at);
  });
  return out;
}

/// In which directions 16 ends are free.
class GridView {
public:
  GridView(const Occluder &occluder, const std::vector<GridRay> &rays)
      : occluder_(occluder), rays_(rays), words_(rays.size()) {}

  void add(Occluder::Point origin, Vec3<Body> face, std::size_t lane) {
    to_.clear(), which_.clear();
    for (const GridRay &ray : rays_) {
      const double up = dot(ray.direction, face);
      if (up < -below_horizon)
        continue;
      to_.push_back(up < above_horizon
                        ? rounded(normalized(ray.direction + face * (above_horizon - up)))
                        : ray.rounded);
      which_.push_back(ray.at);
    }
    from_.assign(to_.size(), origin);
    free_.resize(to_.size());
    occluder_.is_free(from_, to_, free_);
    for (std::size_t k = 0; k < which_.size(); ++k)
      words_[which_[k]] |= static_cast<std::uint16_t>(static_cast<unsigned>(free_[k]) << lane);
  }
  [[nodiscard]] std::uint16_t word(std::size_t at) const { return words_[at]; }

private:
  const Occluder &occluder_;
  const std::vector<GridRay> &rays_;
  std::vector<std::uint16_t> words_;
  std::vector<Occluder::Point> from_, to_;
  std::vector<std::size_t> which_;
  std::vector<unsigned char> free_;
};

} // namespace

backend::ChainPose chain_pose(const Pose &pose) {
  backend::ChainPose out;
  const auto put = [](Vec3<Body> from, float(&to)[3]) {
    to[0] = static_cast<float>(from.x);
    to[1] = static_cast<float>(from.y);
    to[2] = static_cast<float>(from.z);
  };
  put(pose.sun, out.sun);
  put(pose.observer, out.observer);
  put(plane_normal(pose.observer, pose.sun), out.plane);
  out.at_sun = look_around(chain_mask_cells, pose.sun);
  out.at_observer = look_around(chain_mask_cells, pose.observer);
  return out;
}

ChainLevel::ChainLevel(const ChainRays &rays, const ChainSurfaces &surfaces,
                       const Occluder &occluder, const Occluder &grids, std::size_t bands,
                       std::size_t first, std::size_t rays_per_replicate, std::size_t count,
                       std::uint64_t seed, unsigned threads, const std::atomic<bool> *cancel)
    : surfaces_(surfaces), occluder_(occluder), bands_(bands) {
  std::vector<ChainList> lists(replicates);
  parallel_for(replicates, threads, [&](std::size_t r) {
    lists[r] = rays.thinned(rays.draw(r, first, rays_per_replicate, cancel), r, first,
                            count / replicates, cancel);
  });
  if (is_stopped(cancel))
    return;
  const std::vector<Placed> placed = arrange(lists);
  fill(placed, lists);
  set_thresholds(seed, first);
  trace(placed, grids, threads, cancel);
  view_ = {block_, matrix_, surfaces_.fast(), {blocks_, free_p_, free_q_}, bands_};
}

std::vector<ChainLevel::Placed> ChainLevel::arrange(const std::vector<ChainList> &lists) {
  // Chains between the same two flat sides stand together; few ones with others of their surfaces.
  constexpr unsigned surfaces_from = 26; // of the bits of `likeness`
  std::map<std::uint64_t, LikeChains> exact, groups;
  for (std::size_t r = 0; r < replicates; ++r)
    for (const Chain &c : lists[r].chains)
      exact[likeness(c) >> 8U][r].push_back(&c);
  for (const auto &[key, like] : exact) {
    std::size_t sum = 0;
    for (const auto &of_one : like)
      sum += of_one.size();
    const bool is_alone = sum >= alone_from * replicates;
    const std::uint64_t surfaces = (key << 8U) >> surfaces_from << surfaces_from;
    LikeChains &to = groups[is_alone ? (key << 8U) + 1 : surfaces];
    for (std::size_t r = 0; r < replicates; ++r)
      to[r].insert(to[r].end(), like[r].begin(), like[r].end());
  }
  std::vector<Placed> out;
  for (auto &[key, like] : groups) {
    std::size_t longest = 0;
    const Chain *any = nullptr;
    for (auto &of_one : like) {
      std::stable_sort(of_one.begin(), of_one.end(),
                       [](const Chain *a, const Chain *b) { return likeness(*a) < likeness(*b); });
      longest = std::max(longest, of_one.size());
      any = of_one.empty() ? any : of_one.front();
    }
    backend::ChainRun run;
    run.first = static_cast<std::uint32_t>(blocks_);
    run.count = static_cast<std::uint32_t>(longest);
    run.kind_p = any->p.kind;
    run.kind_q = any->q.kind;
    run.is_straight = any->is_straight;
    run.is_without_lobes = surfaces_.part(run.kind_p, run.kind_q) == ChainPart::WithoutLobes;
    for (std::size_t r = 0; r < replicates; ++r)
      for (std::size_t k = 0; k < like[r].size(); ++k)
        out.push_back({blocks_ + k, r, like[r][k]});
    if (!run.is_straight) {
      run.matrix = static_cast<std::uint32_t>(matrix_.size());
      matrix_.resize(matrix_.size() + longest * bands_);
    }
    runs_.push_back(run);
    is_general_.push_back(surfaces_.is_fast(run.kind_p) && surfaces_.is_fast(run.kind_q) ? 0 : 1);
    blocks_ += longest;
  }
  chains_ = out.size();
  return out;
}

void ChainLevel::fill(const std::vector<Placed> &placed, const std::vector<ChainList> &lists) {
  block_.assign(blocks_, {});
  if (std::find(is_general_.begin(), is_general_.end(), 1) != is_general_.end()) {
    field_p_.resize(blocks_ * replicates);
    field_q_.resize(blocks_ * replicates);
  }
  run_of_.resize(blocks_);
  for (std::size_t r = 0; r < runs_.size(); ++r)
    std::fill_n(run_of_.begin() + runs_[r].first, runs_[r].count, static_cast<std::uint32_t>(r));
  for (const Placed &at : placed) {
    const Chain &c = *at.chain;
    backend::ChainBlock &to = block_[at.block];
    put_end(c.p, to.p, at.lane);
    put_end(c.q, to.q, at.lane);
    // Each chain serves from both ends: half of either.
    to.from_p[at.lane] = static_cast<float>(c.from_p / 2);
    to.from_q[at.lane] = static_cast<float>(c.from_q / 2);
    if (!field_p_.empty()) {
      field_p_[at.block * replicates + at.lane] = c.p.field;
      field_q_[at.block * replicates + at.lane] = c.q.field;
    }
    if (c.is_straight)
      continue;
    const backend::ChainRun &run = runs_[run_of_[at.block]];
    for (std::size_t b = 0; b < bands_; ++b) {
      backend::ChainMatrix &m = matrix_[run.matrix + (at.block - run.first) * bands_ + b];
      for (std::size_t k = 0; k < 16; ++k)
        m.m[k][at.lane] = lists[at.lane].between[(c.matrix * bands_ + b) * 16 + k];
    }
  }
}

void ChainLevel::trace(const std::vector<Placed> &placed, const Occluder &grids, unsigned threads,
                       const std::atomic<bool> *cancel) {
  const std::vector<GridRay> rays = grid_rays();
  free_p_.assign(rays.size() * blocks_, 0);
  free_q_.assign(rays.size() * blocks_, 0);
  std::vector<std::vector<const Placed *>> of_block(blocks_);
  for (const Placed &one : placed)
    of_block[one.block].push_back(&one);
  point_p_.resize(blocks_ * replicates);
  point_q_.resize(blocks_ * replicates);
  parallel_for(blocks_, threads, [&](std::size_t block) {
    if (is_stopped(cancel))
      return;
    const auto look = [&](ChainEnd Chain::*end, std::vector<std::uint16_t> &out,
                          std::vector<Occluder::Point> &points) {
      GridView view(grids, rays);
      for (const Placed *one : of_block[block]) {
        const ChainEnd &from = one->chain->*end;
        const Occluder::Point origin = grids.to_point(from.point);
        points[block * replicates + one->lane] = origin;
        view.add(origin, from.face, one->lane);
      }
      for (const GridRay &ray : rays)
        out[ray.at * blocks_ + block] = view.word(ray.at);
    };
    look(&Chain::p, free_p_, point_p_);
    look(&Chain::q, free_q_, point_q_);
  });
}

void ChainLevel::add(std::span<const backend::ChainPose> poses,
                     std::span<backend::ChainSums> sums) const {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const backend::ChainRun &run = runs_[r];
    if (is_general_[r] != 0) {
      for (std::size_t k = 0; k < poses.size(); ++k)
        add_general(run, poses[k], sums[k]);
      continue;
    }
    for (std::size_t begin = 0; begin < run.count; begin += blocks_at_a_time) {
      const std::size_t count = std::min<std::size_t>(blocks_at_a_time, run.count - begin);
      for (std::size_t k = 0; k < poses.size(); ++k)
        for (std::size_t band = 0; band < bands_; band += backend::chain_bands_max)
          backend::sum_chains(view_, run, begin, count, band, poses[k], sums[k]);
    }
  }
}

std::size_t ChainLevel::bytes() const {
  return block_.size() * sizeof(block_[0]) + matrix_.size() * sizeof(backend::ChainMatrix) +
         (free_p_.size() + free_q_.size()) * sizeof(std::uint16_t) +
         (field_p_.size() + field_q_.size()) * sizeof(Vec3<Body>) +
         run_of_.size() * sizeof(run_of_[0]) +
         (point_p_.size() + point_q_.size()) * sizeof(Occluder::Point);
}

} // namespace umov
