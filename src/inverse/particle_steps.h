#pragma once
// Private: attitudes that are followed to a posterior, and the steps that they try.

#include "inverse/local_steps.h"
#include "inverse/turning_fit.h"

#include <cstdint>

namespace umov::inverse {

/// One attitude that is followed.
struct Particle {
  Turning turning;
  Comparison quick, last; ///< of the light for the way, and of that of the last steps
  double start = 0;       ///< -2 ln of the density that particles begin with
};

/// What one round of steps is drawn with.
struct Round {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;
  double scale = 0; ///< of the particles' own distances [rad]
};

/// A step to be tried.
struct Tried {
  Turning to;
  double back = 0; ///< ln of how much more often the step back is tried from there
};

/// A step in any direction, of a length over two decades about the particles' own distances: sheets
/// and peaks are followed by it, and a line as far as it is thick.
Tried any_way(const std::vector<Particle> &draws, std::size_t k, const Round &round);

/// A step by a part of what turns one particle into another (differential evolution: ter Braak
/// 2006). A glint holds two directions to minutes of arc and leaves the turn about the flat's
/// normal free: all such attitudes are a ring, two of which differ by a turn about that normal, and
/// the same turn keeps every other on it. The two are of those that stand still meanwhile, every
/// other particle, so that the steps are exact.
Tried along_others(const std::vector<Particle> &draws, std::size_t k, const Round &round);

/// A step of the shape of what lies around, `width` times as long and a decade and a half of
/// lengths about that: there are spikes on sheets.
Tried local_step(const LocalSteps &around, double width, const Turning &from, std::size_t k,
                 const Round &round);

} // namespace umov::inverse
