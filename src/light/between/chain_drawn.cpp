#include "light/between/chain_drawn.h"

#include "light/fast/octahedron.h"

#include <algorithm>
#include <map>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

static_assert(replicates == backend::lanes);

/// Fewer chains of one likeness than this per replicate share blocks with others.
constexpr std::size_t alone_from = 8;
/// Rays for each chain that stays: most meet nothing, or do not matter.
constexpr std::size_t rays_per_chain = 24;
/// Chains of the reserve, and rays for each of them: it is for light that few chains meet, of which
/// little is to be thinned away.
constexpr std::size_t reserve_chains = 1'048'576, reserve_rays_per_chain = 6;

using LikeChains = std::array<std::vector<const Chain *>, replicates>;

struct Placed {
  std::size_t block, lane;
  const Chain *chain;
  [[nodiscard]] std::size_t at() const { return block * replicates + lane; }
};

void put_vector(const float (&from)[3], float (&to)[3][backend::lanes], std::size_t lane) {
  for (std::size_t k = 0; k < 3; ++k)
    to[k][lane] = from[k];
}
void put_end(const ChainEnd &from, backend::ChainEnds &to, std::size_t lane) {
  put_vector(from.normal, to.normal, lane);
  put_vector(from.along, to.along, lane);
  put_vector(from.axis, to.axis, lane);
}

/// Chains between the same two flat sides, by their likeness; few ones with others of their
/// surfaces.
std::map<std::uint64_t, LikeChains> alike(const std::vector<ChainList> &lists) {
  constexpr unsigned surfaces_from = 26; // of the bits of `likeness`
  std::map<std::uint64_t, LikeChains> exact, out;
  for (std::size_t r = 0; r < replicates; ++r)
    for (const Chain &c : lists[r].chains)
      exact[likeness(c) >> 8U][r].push_back(&c);
  for (const auto &[key, like] : exact) {
    std::size_t sum = 0;
    for (const auto &of_one : like)
      sum += of_one.size();
    const bool is_alone = sum >= alone_from * replicates;
    const std::uint64_t surfaces = (key << 8U) >> surfaces_from << surfaces_from;
    LikeChains &to = out[is_alone ? (key << 8U) + 1 : surfaces];
    for (std::size_t r = 0; r < replicates; ++r)
      to[r].insert(to[r].end(), like[r].begin(), like[r].end());
  }
  return out;
}

std::vector<Placed> arrange(const std::vector<ChainList> &lists, ChainDrawn &to) {
  std::vector<Placed> out;
  for (auto &[key, like] : alike(lists)) {
    std::size_t longest = 0;
    const Chain *any = nullptr;
    for (auto &of_one : like) {
      std::stable_sort(of_one.begin(), of_one.end(),
                       [](const Chain *a, const Chain *b) { return likeness(*a) < likeness(*b); });
      longest = std::max(longest, of_one.size());
      any = of_one.empty() ? any : of_one.front();
    }
    for (std::size_t r = 0; r < replicates; ++r)
      for (std::size_t k = 0; k < like[r].size(); ++k)
        out.push_back({to.blocks + k, r, like[r][k]});
    to.runs.push_back({static_cast<std::uint32_t>(to.blocks), static_cast<std::uint32_t>(longest),
                       any->p.kind, any->q.kind, any->count == 0});
    to.blocks += longest;
  }
  to.chains = out.size();
  return out;
}

void fill(const std::vector<Placed> &placed, ChainDrawn &to) {
  to.block.assign(to.blocks, {});
  to.run_of.resize(to.blocks);
  for (std::size_t r = 0; r < to.runs.size(); ++r)
    std::fill_n(to.run_of.begin() + to.runs[r].first, to.runs[r].count,
                static_cast<std::uint32_t>(r));
  const std::size_t places = to.blocks * replicates;
  to.point_p.resize(places), to.point_q.resize(places);
  to.triangle_p.resize(places), to.triangle_q.resize(places);
  for (const Placed &at : placed) {
    const Chain &c = *at.chain;
    backend::ChainBlock &block = to.block[at.block];
    to.point_p[at.at()] = c.p.point;
    to.point_q[at.at()] = c.q.point;
    to.triangle_p[at.at()] = c.p.triangle;
    to.triangle_q[at.at()] = c.q.triangle;
    put_end(c.p, block.p, at.lane);
    put_end(c.q, block.q, at.lane);
    // Each chain serves from both ends: half of either.
    block.from_p[at.lane] = static_cast<float>(c.from_p / 2);
    block.from_q[at.lane] = static_cast<float>(c.from_q / 2);
  }
}

void put_between(const std::vector<Placed> &placed, const std::vector<ChainList> &lists,
                 ChainDrawn &to) {
  to.first_between.assign(to.blocks * replicates + 1, 0);
  std::uint32_t sum = 0;
  for (const Placed &at : placed)
    to.first_between[at.at()] = at.chain->count;
  for (std::uint32_t &first : to.first_between) {
    const std::uint32_t count = first;
    first = sum;
    sum += count;
  }
  to.between.resize(sum);
  for (const Placed &at : placed)
    std::copy_n(lists[at.lane].between.begin() + at.chain->first, at.chain->count,
                to.between.begin() + to.first_between[at.at()]);
}

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

void trace(const std::vector<Placed> &placed, const Occluder &grids, ChainDrawn &to,
           unsigned threads, const std::atomic<bool> *cancel) {
  const std::vector<GridRay> rays = grid_rays();
  to.free_p.assign(rays.size() * to.blocks, 0);
  to.free_q.assign(rays.size() * to.blocks, 0);
  std::vector<std::vector<const Placed *>> of_block(to.blocks);
  for (const Placed &one : placed)
    of_block[one.block].push_back(&one);
  parallel_for(to.blocks, threads, [&](std::size_t block) {
    if (is_stopped(cancel))
      return;
    const auto look = [&](ChainEnd Chain::*end, std::vector<std::uint16_t> &out,
                          const std::vector<Occluder::Point> &points) {
      GridView view(grids, rays);
      for (const Placed *one : of_block[block]) {
        const ChainEnd &from = one->chain->*end;
        view.add(points[one->at()], vector_of(from.face), one->lane);
      }
      for (const GridRay &ray : rays)
        out[ray.at * to.blocks + block] = view.word(ray.at);
    };
    look(&Chain::p, to.free_p, to.point_p);
    look(&Chain::q, to.free_q, to.point_q);
  });
}

} // namespace

ChainDrawn draw_chains(const ChainRays &rays, const Occluder *grids, const ChainCount &count,
                       unsigned threads, const std::atomic<bool> *cancel) {
  std::vector<ChainList> lists(replicates);
  parallel_for(replicates, threads, [&](std::size_t r) {
    lists[r] = rays.thinned(rays.draw(r, count.first, count.rays_per_replicate, cancel), r,
                            count.first, count.chains / replicates, cancel);
  });
  ChainDrawn out;
  if (is_stopped(cancel))
    return out;
  const std::vector<Placed> placed = arrange(lists, out);
  fill(placed, out);
  put_between(placed, lists, out);
  if (grids != nullptr)
    trace(placed, *grids, out, threads, cancel);
  return out;
}

ChainDrawing::ChainDrawing(const BounceScene &scene, const Occluder &occluder, ChainCover cover,
                           std::size_t bounces, std::uint64_t seed, const std::atomic<bool> *cancel)
    : cover_(std::move(cover)), rays_(scene, occluder, cover_, bounces, seed), occluder_(occluder),
      grids_(scene.scene().mesh, Occluder::Rays::Grid, cancel), seed_(seed) {}

ChainCount ChainDrawing::count_of(std::size_t level) {
  const auto rays_of = [](std::size_t k) {
    return (k < levels ? chains_of[k] * rays_per_chain : reserve_chains * reserve_rays_per_chain) /
           replicates;
  };
  ChainCount out{0, rays_of(level), level < levels ? chains_of[level] : reserve_chains};
  for (std::size_t k = 0; k < level; ++k)
    out.first += rays_of(k);
  return out;
}

const ChainDrawn *ChainDrawing::drawn(std::size_t level, unsigned threads,
                                      const std::atomic<bool> *cancel) const {
  return drawn_[level].get(cancel, [&] {
    const Occluder *grids = level < levels ? &grids_ : nullptr; // the reserve's ends ask rays
    return std::make_unique<const ChainDrawn>(
        draw_chains(rays_, grids, count_of(level), threads, cancel));
  });
}

bool ChainDrawing::serves(const Scene &scene, const ChainSurfaces &surfaces,
                          const std::atomic<bool> *cancel) const {
  const ChainTrial *trial = trial_.get(cancel, [&] {
    return std::make_unique<const ChainTrial>(rays_, cover_, count_of(levels + 1).first, cancel);
  });
  if (trial == nullptr)
    leave_stopped();
  return trial->serves(scene, surfaces, cancel);
}

} // namespace umov
