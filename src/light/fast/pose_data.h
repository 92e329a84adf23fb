#pragma once
// Private: a pose made ready for the facet loops.

#include "light/fast/stores.h"

#include <umov/light/integrator.h>

namespace umov {

/// Directions and, for each lobe, what the Sun's size makes of it. Grid directions are filled in
/// where there are masks.
void prepare_pose(const Pose &pose, double cos_phase,
                  const std::vector<kernel::LobeConstants<double>> &lobes, bool has_polarized_body,
                  const backend::Masks *masks, PoseStore<double> &out);
/// The same constants in single precision.
void round_pose(const backend::PoseData<double> &from, PoseStore<float> &to);

} // namespace umov
