#include <umov/inverse/direction_table.h>

#include "inverse/octahedron.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>

namespace umov {
using inverse::DirectionGrid;

std::shared_ptr<const DirectionTable> DirectionTable::make(const PoseLighting &light,
                                                           std::size_t cells, double sun_radius_rad,
                                                           unsigned threads) {
  auto out = std::make_shared<DirectionTable>();
  out->cells_ = cells;
  const DirectionGrid grid{cells};
  const std::size_t nodes = grid.nodes();
  std::vector<Vec3<Body>> directions;
  for (std::size_t n = 0; n < nodes; ++n)
    directions.push_back(grid.direction(n));
  StokesTable lit;
  std::vector<Pose> poses;
  constexpr std::size_t at_once = 64; // directions of the Sun whose light is held at a time
  for (std::size_t begin = 0; begin < nodes; begin += at_once) {
    const std::size_t end = std::min(begin + at_once, nodes);
    poses.clear();
    for (std::size_t s = begin; s < end; ++s)
      for (std::size_t o = s; o < nodes; ++o)
        poses.push_back({directions[s], directions[o], sun_radius_rad});
    if (!light(poses, lit))
      return nullptr;
    out->bands_ = lit.bands;
    out->light_.resize(nodes * nodes * lit.bands * 2);
    std::vector<std::size_t> first(end - begin + 1, 0);
    for (std::size_t s = begin; s < end; ++s)
      first[s - begin + 1] = first[s - begin] + nodes - s;
    parallel_for(end - begin, threads, [&](std::size_t k) {
      const std::size_t s = begin + k;
      for (std::size_t o = s; o < nodes; ++o)
        for (std::size_t b = 0; b < lit.bands; ++b) {
          const std::size_t from = (first[k] + o - s) * lit.bands + b;
          const bool is_lit = std::isfinite(lit.i[from]) && std::isfinite(lit.q[from]);
          const float i = is_lit ? static_cast<float>(lit.i[from]) : 0;
          const float q = is_lit ? static_cast<float>(lit.q[from]) : 0;
          for (const std::size_t pair : {s * nodes + o, o * nodes + s}) {
            out->light_[(pair * lit.bands + b) * 2] = i;
            out->light_[(pair * lit.bands + b) * 2 + 1] = q;
          }
        }
    });
  }
  return out;
}

PoseLighting DirectionTable::lighting(std::shared_ptr<const DirectionTable> table,
                                      unsigned threads) {
  return [table, threads](std::span<const Pose> poses, StokesTable &out) {
    const DirectionGrid grid{table->cells_};
    const std::size_t bands = table->bands_, nodes = grid.nodes();
    out.bands = bands; // only what a search reads is made ready
    out.i.resize(poses.size() * bands);
    out.q.resize(poses.size() * bands);
    out.u.resize(poses.size() * bands, 0);
    constexpr std::size_t chunk = 4096;
    parallel_for((poses.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
      for (std::size_t k = c * chunk; k < std::min(poses.size(), (c + 1) * chunk); ++k) {
        const DirectionGrid::Corner sun = grid.corner(poses[k].sun);
        const DirectionGrid::Corner observer = grid.corner(poses[k].observer);
        for (std::size_t b = 0; b < bands; ++b) {
          float i = 0, q = 0;
          for (std::size_t s = 0; s < 4; ++s)
            for (std::size_t o = 0; o < 4; ++o) {
              const float w = sun.weight[s] * observer.weight[o];
              const float *const at =
                  &table->light_[((sun.node[s] * nodes + observer.node[o]) * bands + b) * 2];
              i += w * at[0];
              q += w * at[1];
            }
          out.i[k * bands + b] = static_cast<double>(i);
          out.q[k * bands + b] = static_cast<double>(q);
        }
      }
    });
    return true;
  };
}

} // namespace umov
