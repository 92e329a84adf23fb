#include "light/between/chain_set.h"

#include "light/between/beam_axes.h"
#include "light/between/chain_matrices.h"
#include "light/fast/octahedron.h"
#include "light/reference/elements.h"

#include <algorithm>
#include <umov/core/parallel.h>
#include <umov/core/stop.h>

namespace umov {
namespace {

Occluder::Point point_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

} // namespace

backend::ChainPose chain_pose(const Pose &pose) {
  backend::ChainPose out;
  put_floats(pose.sun, out.sun);
  put_floats(pose.observer, out.observer);
  put_floats(plane_normal(pose.observer, pose.sun), out.plane);
  out.at_sun = look_around(chain_mask_cells, pose.sun);
  out.at_observer = look_around(chain_mask_cells, pose.observer);
  return out;
}

ChainSet::ChainSet(const ChainDrawn &drawn, const ChainMaterials &materials, unsigned threads,
                   const std::atomic<bool> *cancel)
    : drawn_(drawn), surfaces_(materials.surfaces), occluder_(materials.drawing.occluder()),
      bands_(materials.scene.grid.nodes().size()), mesh_(materials.scene.mesh) {
  put_runs(materials.drawing.cover(), materials.scene);
  fill(materials.scene, threads, cancel);
}

void ChainSet::put_runs(const ChainCover &cover, const Scene &scene) {
  const auto kind_of = [&](std::uint32_t kind) {
    return surfaces_.kind_of(&surface_of_slot(scene, cover.slots()[kind]));
  };
  std::size_t matrices = 0;
  for (const ChainDrawn::Run &from : drawn_.runs) {
    backend::ChainRun &run = runs_.emplace_back();
    run.first = from.first;
    run.count = from.count;
    run.kind_p = kind_of(from.kind_p);
    run.kind_q = kind_of(from.kind_q);
    run.is_straight = from.is_straight;
    const ChainPart part = surfaces_.part(run.kind_p, run.kind_q);
    run.is_without_lobes = part == ChainPart::WithoutLobes;
    is_left_.push_back(part == ChainPart::Nothing ? 1 : 0);
    is_general_.push_back(surfaces_.is_fast(run.kind_p) && surfaces_.is_fast(run.kind_q) ? 0 : 1);
    if (run.is_straight || part == ChainPart::Nothing)
      continue;
    run.matrix = static_cast<std::uint32_t>(matrices);
    matrices += run.count * bands_;
  }
  matrix_.resize(matrices);
}

void ChainSet::fill(const Scene &scene, unsigned threads, const std::atomic<bool> *cancel) {
  transmitted_.assign(drawn_.blocks * replicates, 1);
  parallel_for(drawn_.blocks, threads, [&](std::size_t block) {
    const backend::ChainRun &run = run_at(block);
    if (run.is_straight || is_left_[drawn_.run_of[block]] != 0 || is_stopped(cancel))
      return;
    ChainMatrices of(scene, mesh_);
    const backend::ChainBlock &ends = drawn_.block[block];
    for (std::size_t lane = 0; lane < replicates; ++lane) {
      const std::size_t at = block * replicates + lane;
      const std::uint32_t first = drawn_.first_between[at], end = drawn_.first_between[at + 1];
      if (first == end)
        continue; // nobody's place
      of.start(vector_of(ends.p.axis, lane), vector_of(ends.p.along, lane));
      for (std::uint32_t k = first; k < end; ++k)
        of.pass(drawn_.between[k]);
      transmitted_[at] = static_cast<float>(of.transmitted());
      for (std::size_t b = 0; b < bands_; ++b) {
        const ChainMatrices::Matrix matrix = of.from(vector_of(ends.q.axis, lane), b);
        float(&to)[16][backend::lanes] = matrix_[run.matrix + (block - run.first) * bands_ + b].m;
        for (std::size_t k = 0; k < 16; ++k)
          to[k][lane] = static_cast<float>(matrix.m[k / 4][k % 4]);
      }
    }
  });
}

Vec3<Body> ChainSet::field_of(std::uint32_t kind, std::uint32_t triangle) const {
  return direction_field(mesh_, surfaces_.surface(kind), triangle);
}

bool ChainSet::is_free(const OneChain &one, const backend::ChainPose &pose) const {
  const auto &seen = one.is_reversed ? drawn_.point_q : drawn_.point_p,
             &lit = one.is_reversed ? drawn_.point_p : drawn_.point_q;
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
