#include <umov/inverse/direction_table.h>

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>

namespace umov {
namespace {

/// The direction of a point of the square [-1, 1]^2 that an octahedron is unfolded onto (Cigolle et
/// al. 2014, JCGT 3(2), "A Survey of Efficient Representations for Independent Unit Vectors").
Vec3<Body> direction_at(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y);
  Vec3<Body> out{x, y, z};
  if (z < 0) {
    out.x = (1 - std::abs(y)) * (x >= 0 ? 1 : -1);
    out.y = (1 - std::abs(x)) * (y >= 0 ? 1 : -1);
  }
  return normalized(out);
}

/// And back.
std::pair<double, double> square_of(Vec3<Body> v) {
  const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  const double x = v.x / sum, y = v.y / sum;
  if (v.z >= 0)
    return {x, y};
  return {(1 - std::abs(y)) * (x >= 0 ? 1 : -1), (1 - std::abs(x)) * (y >= 0 ? 1 : -1)};
}

} // namespace

DirectionTable::Corner DirectionTable::corner_of(Vec3<Body> direction) const {
  const auto [x, y] = square_of(direction);
  const auto n = static_cast<double>(cells_);
  const double a = std::clamp((x + 1) / 2 * n, 0.0, n), b = std::clamp((y + 1) / 2 * n, 0.0, n);
  const double i = std::min(std::floor(a), n - 1), j = std::min(std::floor(b), n - 1);
  const auto fx = static_cast<float>(a - i), fy = static_cast<float>(b - j);
  const std::size_t row = cells_ + 1;
  const std::size_t node = static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i);
  return {{node, node + 1, node + row, node + row + 1},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

std::shared_ptr<const DirectionTable> DirectionTable::make(const PoseLighting &light,
                                                           std::size_t cells, double sun_radius_rad,
                                                           unsigned threads) {
  auto out = std::make_shared<DirectionTable>();
  out->cells_ = cells;
  const std::size_t row = cells + 1, nodes = row * row;
  const auto at = [&](std::size_t step) {
    return 2 * static_cast<double>(step) / static_cast<double>(cells) - 1;
  };
  std::vector<Vec3<Body>> directions;
  for (std::size_t y = 0; y < row; ++y)
    for (std::size_t x = 0; x < row; ++x)
      directions.push_back(direction_at(at(x), at(y)));
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
    const std::size_t bands = table->bands_, nodes = (table->cells_ + 1) * (table->cells_ + 1);
    out.bands = bands; // only what a search reads is made ready
    out.i.resize(poses.size() * bands);
    out.q.resize(poses.size() * bands);
    out.u.resize(poses.size() * bands, 0);
    constexpr std::size_t chunk = 4096;
    parallel_for((poses.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
      for (std::size_t k = c * chunk; k < std::min(poses.size(), (c + 1) * chunk); ++k) {
        const Corner sun = table->corner_of(poses[k].sun);
        const Corner observer = table->corner_of(poses[k].observer);
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
