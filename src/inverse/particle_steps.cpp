#include "inverse/particle_steps.h"

#include "inverse/posterior.h"

#include <algorithm>
#include <cmath>
#include <umov/core/random.h>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

/// Streams of a round: one for directions, others for lengths.
constexpr std::uint32_t lengths = 0x10000u;

} // namespace

Tried any_way(const std::vector<Particle> &draws, std::size_t k, const Round &round) {
  const auto z = normal_vector(round.seed, round.stream, k, 3);
  const double u = uniform4(round.seed, round.stream + lengths, k)[0];
  return {stepped(draws[k].turning, z * (round.scale * std::pow(10, 1.7 * u - 1.2)), 1)};
}

Tried along_others(const std::vector<Particle> &draws, std::size_t k, const Round &round) {
  const auto u = uniform4(round.seed, round.stream + lengths, k);
  const std::size_t other = 1 - k % 2, count = (draws.size() + 1 - other) / 2;
  const auto pick = [&](double at) {
    return 2 * std::min(static_cast<std::size_t>(at * static_cast<double>(count)), count - 1) +
           other;
  };
  const Vec3<Body> turn =
      turn_between(draws[pick(u[0])].turning.attitude, draws[pick(u[2])].turning.attitude);
  const auto z = normal_vector(round.seed, round.stream, k, 3);
  constexpr double beside = 0.03; // of the distances: to every side a little
  return {stepped(draws[k].turning,
                  Eigen::Vector3d(turn.x, turn.y, turn.z) * u[3] + z * (beside * round.scale), 1)};
}

Tried local_step(const LocalSteps &around, double width, const Turning &from, std::size_t k,
                 const Round &round) {
  const auto z = normal_vector(round.seed, round.stream, k, 3);
  const double u = uniform4(round.seed, round.stream + lengths, k)[0];
  const double times = width * std::pow(10, 1.4 * u - 1);
  const auto root = around.root_at(from.attitude, times);
  const Vec3<Body> step = LocalSteps::step(root, {z[0], z[1], z[2]});
  Tried out{{turned(from.attitude, step), from.rate_rad_s}};
  out.back = LocalSteps::log_density(around.root_at(out.to.attitude, times), step) -
             LocalSteps::log_density(root, step);
  return out;
}

} // namespace umov::inverse
