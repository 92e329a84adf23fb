#include "light/between/chain_level.h"

#include "light/fast/octahedron.h"

#include <algorithm>
#include <numeric>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

/// Blocks that several poses are lit by in turn, while the cache has them.
constexpr std::size_t blocks_at_a_time = 64;
/// Directions this far below the horizon of an end are asked just above it, since interpolation
/// between directions needs them [sine].
constexpr double below_horizon = 0.12, above_horizon = 0.005;

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

ChainLevel::ChainLevel(const ChainRays &rays, const ChainSurfaces &surfaces,
                       const Occluder &occluder, const Occluder &grids, std::size_t bands,
                       const ChainCount &count, std::uint64_t seed, unsigned threads,
                       const std::atomic<bool> *cancel)
    : ChainSet(surfaces, occluder, bands) {
  const Drawn drawn = draw(rays, count, threads, cancel);
  if (is_stopped(cancel))
    return;
  set_thresholds(seed, count.first);
  trace(drawn.placed, grids, threads, cancel);
  view_ = {block_, matrix_, surfaces_.fast(), {blocks_, free_p_, free_q_}, bands_, {}};
}

void ChainLevel::trace(const std::vector<Placed> &placed, const Occluder &grids, unsigned threads,
                       const std::atomic<bool> *cancel) {
  const std::vector<GridRay> rays = grid_rays();
  free_p_.assign(rays.size() * blocks_, 0);
  free_q_.assign(rays.size() * blocks_, 0);
  std::vector<std::vector<const Placed *>> of_block(blocks_);
  for (const Placed &one : placed)
    of_block[one.block].push_back(&one);
  parallel_for(blocks_, threads, [&](std::size_t block) {
    if (is_stopped(cancel))
      return;
    const auto look = [&](ChainEnd Chain::*end, std::vector<std::uint16_t> &out,
                          const std::vector<Occluder::Point> &points) {
      GridView view(grids, rays);
      for (const Placed *one : of_block[block]) {
        const ChainEnd &from = one->chain->*end;
        view.add(points[block * replicates + one->lane], from.face, one->lane);
      }
      for (const GridRay &ray : rays)
        out[ray.at * blocks_ + block] = view.word(ray.at);
    };
    look(&Chain::p, free_p_, point_p_);
    look(&Chain::q, free_q_, point_q_);
  });
}

namespace {

/// I in the first band so far.
double light_of(const backend::ChainSums &sums) {
  return std::accumulate(std::begin(sums.bands[0].i), std::end(sums.bands[0].i), 0.0);
}

} // namespace

void ChainLevel::add(std::span<const backend::ChainPose> poses,
                     std::span<backend::ChainSums> sums) const {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const backend::ChainRun &run = runs_[r];
    if (run.is_without_lobes || !surfaces_.is_narrow(run.kind_p) ||
        !surfaces_.is_narrow(run.kind_q)) {
      add_run(r, poses, sums);
      continue;
    }
    // Counted apart: where the many chains of wide light hide them nobody would see that they are
    // few.
    std::vector<double> light, squares;
    for (const backend::ChainSums &sum : sums) {
      light.push_back(light_of(sum));
      squares.push_back(sum.squares);
    }
    add_run(r, poses, sums);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      sums[k].narrow_i += light_of(sums[k]) - light[k];
      sums[k].narrow_squares += sums[k].squares - squares[k];
    }
  }
}

void ChainLevel::add_run(std::size_t number, std::span<const backend::ChainPose> poses,
                         std::span<backend::ChainSums> sums) const {
  const backend::ChainRun &run = runs_[number];
  if (is_general_[number] != 0) {
    for (std::size_t k = 0; k < poses.size(); ++k)
      add_general(run, poses[k], sums[k]);
    return;
  }
  for (std::size_t begin = 0; begin < run.count; begin += blocks_at_a_time) {
    const std::size_t count = std::min<std::size_t>(blocks_at_a_time, run.count - begin);
    for (std::size_t k = 0; k < poses.size(); ++k)
      for (std::size_t band = 0; band < bands_; band += backend::chain_bands_max)
        backend::sum_chains(view_, run, begin, count, band, poses[k], sums[k]);
  }
}

} // namespace umov
