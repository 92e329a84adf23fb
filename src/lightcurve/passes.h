#pragma once
// Private: which epochs of a span are seen, and how they group into passes.

#include <umov/lightcurve/compute.h>
#include <vector>

namespace umov {

/// Geometry of one epoch of the grid, or the code with which SGP4 failed there.
struct EpochGeometry {
  Sgp4Code code = Sgp4Code::Ok;
  ObservingGeometry geometry;
};

/// Propagates and observes one epoch.
EpochGeometry geometry_at(const Sgp4 &model, const LightCurveRequest &request, Epoch<Utc> time);

bool is_above(const EpochGeometry &epoch, const EpochFilter &only);
/// Above the altitude limit, and dark and sunlit as the filter asks.
bool is_kept(const EpochGeometry &epoch, const EpochFilter &only);

/// Consecutive epochs above the altitude limit, [first, last] into the grid.
struct GridPass {
  std::size_t first = 0, last = 0;
};
std::vector<GridPass> group_passes(const std::vector<EpochGeometry> &grid, const EpochFilter &only);

/// Name, culmination (refined between epochs to 1 ms) and limits of a pass.
Pass describe_pass(const GridPass &pass, const std::vector<EpochGeometry> &grid, const Sgp4 &model,
                   const LightCurveRequest &request);

} // namespace umov
