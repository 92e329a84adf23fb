#pragma once
// Private: light that has touched more than one surface before it reaches the observer, for one
// pose or for a series of them, which tell about each other.

#include "light/between/bounce_scene.h"
#include "light/between/chain_surfaces.h"

#include <atomic>
#include <span>
#include <umov/core/stop.h>
#include <umov/light/integrator.h>
#include <umov/light/thermal.h>
#include <umov/shape/occluder.h>

namespace umov {

/// Light by paths of 2 to options.bounces surfaces for each of a number of poses, drawn until the
/// half-width of I falls below options.accuracy times the whole, direct_i[pose * bands + band]
/// included, or options.max_points paths are spent on a pose. Poses that follow each other closely
/// in direction share their paths: a value is that of a parabola through its neighbours' as far as
/// these agree with it (docs/theory/bounces.md). With `emission` it is the
/// light that the surfaces emit, by way of up to as many, what comes straight from them included.
/// With `chains` it is only what these leave out.
/// The result depends on the poses and the seed, not on the number of threads. Empty if `cancel`,
/// which may be null, became true.
std::vector<IndirectLight>
indirect_light(const BounceScene &scene, const Occluder &occluder, std::span<const Pose> poses,
               const IntegrationOptions &options, std::span<const double> direct_i,
               unsigned threads, const std::atomic<bool> *cancel,
               const ThermalEmission *emission = nullptr, const ChainSurfaces *chains = nullptr);

} // namespace umov
