#pragma once
#include <vector>

namespace umov {

/// A time within an exposure, from its middle, and its part of the mean.
struct ExposureNode {
  double offset_s = 0, weight = 1;
};

/// Mean over an exposure of a light that has features of `feature_s` full width in time: three
/// Gauss points on panels no longer than that. A Gaussian flash of any phase is then within 1.5e-3
/// of the largest mean that it can give; half the panel, 2e-5. 0 or less: the light is smooth, one
/// panel.
std::vector<ExposureNode> exposure_nodes(double exposure_s, double feature_s);

} // namespace umov
