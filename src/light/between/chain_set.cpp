#include "light/between/chain_set.h"

#include "light/between/beam_axes.h"
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

Occluder::Point point_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

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

ChainSet::Drawn ChainSet::draw(const ChainRays &rays, const ChainCount &count, unsigned threads,
                               const std::atomic<bool> *cancel) {
  Drawn out;
  out.lists.resize(replicates);
  parallel_for(replicates, threads, [&](std::size_t r) {
    out.lists[r] = rays.thinned(rays.draw(r, count.first, count.rays_per_replicate, cancel), r,
                                count.first, count.chains / replicates, cancel);
  });
  if (is_stopped(cancel))
    return {};
  out.placed = arrange(out.lists);
  fill(out.placed, out.lists);
  return out;
}

std::vector<ChainSet::Placed> ChainSet::arrange(const std::vector<ChainList> &lists) {
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

void ChainSet::fill(const std::vector<Placed> &placed, const std::vector<ChainList> &lists) {
  block_.assign(blocks_, {});
  if (std::find(is_general_.begin(), is_general_.end(), 1) != is_general_.end()) {
    field_p_.resize(blocks_ * replicates);
    field_q_.resize(blocks_ * replicates);
  }
  run_of_.resize(blocks_);
  for (std::size_t r = 0; r < runs_.size(); ++r)
    std::fill_n(run_of_.begin() + runs_[r].first, runs_[r].count, static_cast<std::uint32_t>(r));
  point_p_.resize(blocks_ * replicates);
  point_q_.resize(blocks_ * replicates);
  for (const Placed &at : placed) {
    const Chain &c = *at.chain;
    backend::ChainBlock &to = block_[at.block];
    point_p_[at.block * replicates + at.lane] = occluder_.to_point(c.p.point);
    point_q_[at.block * replicates + at.lane] = occluder_.to_point(c.q.point);
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

bool ChainSet::is_free(const OneChain &one, const backend::ChainPose &pose) const {
  const auto &seen = one.is_reversed ? point_q_ : point_p_,
             &lit = one.is_reversed ? point_p_ : point_q_;
  const Occluder::Point from[2] = {seen[one.at()], lit[one.at()]},
                        to[2] = {point_of(pose.observer), point_of(pose.sun)};
  for (std::size_t k = 0; k < 2; ++k) {
    unsigned char free = 0;
    occluder_.is_free(std::span(&from[k], 1), std::span(&to[k], 1), std::span(&free, 1));
    if (free == 0)
      return false;
  }
  return true;
}

} // namespace umov
