#pragma once
// Private: microfacet lobes as constants of the facet kernels.

#include "backend/scene_data.h"

#include <optional>
#include <umov/surface/distribution.h>
#include <umov/surface/material.h>

namespace umov {

/// Empty if the kernels do not know its form, or no polynomial stands for its masking.
std::optional<kernel::LobeConstants<double>> fit_lobe(const Distribution &normals,
                                                      Shadowing shadowing);

/// Lobes that differ in the m of Blinn-Phong alone, with nodes for their shadowing; empty if they
/// differ in more, or if six nodes do not bring it to 1e-4.
std::optional<backend::LobeFamily<double>>
fit_family(const std::vector<kernel::LobeConstants<double>> &lobes, Shadowing shadowing);

} // namespace umov
