#include <umov/inverse/signature.h>

#include "inverse/light_codes.h"
#include "inverse/octahedron.h"

#include <algorithm>
#include <cmath>
#include <umov/core/parallel.h>
#include <umov/light/poses.h>

namespace umov {

using inverse::DirectionGrid;
using inverse::LightCodes;

namespace {

constexpr double decades = 9; // below the brightest that have codes

} // namespace

std::size_t signature_pairs(std::size_t cells) {
  const std::size_t nodes = DirectionGrid{cells}.nodes();
  return nodes * (nodes + 1) / 2;
}

std::vector<Pose> signature_poses(std::size_t cells, std::size_t begin, std::size_t end,
                                  double sun_radius_rad) {
  const DirectionGrid grid{cells};
  const std::size_t nodes = grid.nodes();
  std::vector<Pose> out;
  std::size_t s = 0;
  while (s + 1 < nodes && inverse::pair_of(s + 1, s + 1, nodes) <= begin)
    ++s;
  std::size_t o = s + begin - inverse::pair_of(s, s, nodes);
  for (std::size_t pair = begin; pair < end; ++pair) {
    out.push_back({grid.direction(s), grid.direction(o), sun_radius_rad});
    if (++o == nodes)
      o = ++s;
  }
  return out;
}

PackedLight pack_light(const StokesTable &light) {
  PackedLight out;
  double most = 0;
  for (const double i : light.i)
    most = std::isfinite(i) ? std::max(most, i) : most;
  // Far off the glints of mirrors a float's least numbers are the brightest there is.
  if (most < 2 * std::exp(-signature_ln_widest + decades * std::log(10.0)))
    most = 0;
  const double least = most * std::pow(10, -decades);
  constexpr double codes = 65'534;
  out.ln_least = most > 0 ? std::log(least) : 0;
  out.ln_step = decades * std::log(10.0) / codes;
  out.code.assign(2 * light.i.size(), 0);
  for (std::size_t k = 0; k < light.i.size(); ++k) {
    const double i = light.i[k], q = light.q[k];
    const bool is_lit = std::isfinite(i) && std::isfinite(q) && most > 0 && i > 0 && i >= least;
    const double at = is_lit ? 1 + (std::log(i) - out.ln_least) / out.ln_step : 0;
    out.code[2 * k] = static_cast<std::uint16_t>(std::lround(std::min(at, codes + 1)));
    const double part = is_lit ? std::clamp(q / i, -1.0, 1.0) : 0;
    out.code[2 * k + 1] = LightCodes::of_q(part);
  }
  return out;
}

PoseLighting lighting_of(const Signature &signature, unsigned threads) {
  const LightCodes codes(signature);
  return [&signature, threads, codes](std::span<const Pose> poses, StokesTable &out) {
    const DirectionGrid grid{signature.cells};
    const std::size_t bands = signature.bands, nodes = grid.nodes();
    out.bands = bands; // only what a search reads is made ready
    out.i.assign(poses.size() * bands, 0);
    out.q.assign(poses.size() * bands, 0);
    out.u.assign(poses.size() * bands, 0);
    constexpr std::size_t chunk = 4096;
    parallel_for((poses.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
      for (std::size_t k = c * chunk; k < std::min(poses.size(), (c + 1) * chunk); ++k) {
        const auto sun = grid.corner(poses[k].sun), observer = grid.corner(poses[k].observer);
        for (std::size_t s = 0; s < 4; ++s)
          for (std::size_t o = 0; o < 4; ++o) {
            const std::size_t pair = inverse::pair_of(sun.node[s], observer.node[o], nodes);
            const float weight = sun.weight[s] * observer.weight[o];
            const std::uint16_t *at = &signature.code[pair * bands * 2];
            for (std::size_t b = 0; b < bands; ++b, at += 2) {
              if (at[0] == 0)
                continue;
              const auto i = static_cast<double>(weight * codes.i(at[0]));
              out.i[k * bands + b] += i;
              out.q[k * bands + b] += i * at[1];
            }
          }
        for (std::size_t b = k * bands; b < (k + 1) * bands; ++b)
          out.q[b] = LightCodes::q(out.q[b], out.i[b]);
      }
    });
    return true;
  };
}

double interpolation_error(const Signature &signature, const PoseLighting &light,
                           std::uint64_t seed) {
  constexpr std::size_t trials = 600;
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < trials; ++k)
    poses.push_back(
        random_pose(seed, k, Angle::degrees(20 + 130 * static_cast<double>(k) / trials)));
  StokesTable truth, looked_up;
  if (!light(poses, truth) || !lighting_of(signature, 1)(poses, looked_up))
    return 0;
  std::vector<double> off, bright;
  for (const double i : truth.i)
    bright.push_back(std::isfinite(i) ? i : 0);
  std::nth_element(bright.begin(), bright.begin() + static_cast<std::ptrdiff_t>(bright.size() / 2),
                   bright.end());
  const double least = 0.05 * bright[bright.size() / 2]; // what is darker is hardly seen
  for (std::size_t k = 0; k < truth.i.size(); ++k)
    if (truth.i[k] > least)
      off.push_back(std::abs(looked_up.i[k] / truth.i[k] - 1));
  if (off.empty())
    return 0;
  const auto third = off.begin() + static_cast<std::ptrdiff_t>(off.size() * 2 / 3);
  std::nth_element(off.begin(), third, off.end());
  return std::min(*third, signature_error_most);
}

} // namespace umov
