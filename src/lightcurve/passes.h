#pragma once
// Private: which epochs of a span are seen, and how they group into passes.

#include <umov/lightcurve/compute.h>
#include <vector>

namespace umov {

/// Geometry of one epoch of the grid, unless the orbit could not be had there.
struct EpochGeometry {
  bool is_there = false;
  ObservingGeometry geometry;
};

/// Propagates and observes one epoch.
EpochGeometry geometry_at(const LightCurveRequest &request, Epoch<Utc> time);

bool is_above(const EpochGeometry &epoch, const EpochFilter &only);
/// Above the altitude limit, and dark and sunlit as the filter asks.
bool is_kept(const EpochGeometry &epoch, const EpochFilter &only);

/// Consecutive epochs above the altitude limit, [first, last] into the grid.
struct GridPass {
  std::size_t first = 0, last = 0;
};
std::vector<GridPass> group_passes(const std::vector<EpochGeometry> &grid, const EpochFilter &only);

/// Name, culmination (refined between epochs to 1 ms) and limits of a pass.
Pass describe_pass(const GridPass &pass, const std::vector<EpochGeometry> &grid,
                   const LightCurveRequest &request);

} // namespace umov
