#include "lightcurve/passes.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace umov {
namespace {

/// "20180121T051155Z" of "2018-01-21T05:11:55.123Z".
std::string compact(Epoch<Utc> time) {
  std::string out;
  for (const char c : to_iso(time).substr(0, 19))
    if (c != '-' && c != ':')
      out += c;
  return out + "Z";
}

} // namespace

EpochGeometry geometry_at(const LightCurveRequest &request, Epoch<Utc> time) {
  const auto state = request.orbit.at(time);
  if (!state)
    return {};
  return {true, observe(*state, time, request.site, request.shadow)};
}

bool is_above(const EpochGeometry &epoch, const EpochFilter &only) {
  return epoch.is_there && epoch.geometry.altitude.radians() >= only.altitude_min.radians();
}

bool is_kept(const EpochGeometry &epoch, const EpochFilter &only) {
  if (!is_above(epoch, only))
    return false;
  if (only.sun_altitude_max &&
      epoch.geometry.sun_altitude.radians() > only.sun_altitude_max->radians())
    return false;
  return !only.sunlit || epoch.geometry.sunlit > 0;
}

std::vector<GridPass> group_passes(const std::vector<EpochGeometry> &grid,
                                   const EpochFilter &only) {
  std::vector<GridPass> passes;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (!is_above(grid[i], only))
      continue;
    if (i > 0 && is_above(grid[i - 1], only))
      passes.back().last = i;
    else
      passes.push_back({i, i});
  }
  return passes;
}

namespace {

/// Highest point of a passage: seconds after `from`, where the altitude is greatest near [low,
/// high].
struct Summit {
  double seconds, altitude_rad;
};

class Climb {
public:
  Climb(const LightCurveRequest &request, Epoch<Utc> origin) : request_(request), origin_(origin) {}

  /// Walks on while the altitude grows; returns where it no longer does.
  [[nodiscard]] double walk(double from, double step) const {
    constexpr double longest_s = 21'600; // what still climbs after that hardly moves: no summit
    double best = from, highest = altitude(from);
    for (double next; (next = altitude(best + step)) > highest; highest = next)
      if (std::abs((best += step) - from) > longest_s)
        return from;
    return best;
  }
  /// Golden section, so that the name of a pass does not depend on the step.
  [[nodiscard]] Summit refine(double low, double high) const {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    while (high - low > 1e-3) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      if (altitude(a) < altitude(b))
        low = a;
      else
        high = b;
    }
    return {(low + high) / 2, altitude((low + high) / 2)};
  }

private:
  [[nodiscard]] double altitude(double seconds) const {
    const EpochGeometry at = geometry_at(request_, plus_seconds(origin_, seconds));
    return at.is_there ? at.geometry.altitude.radians() : -pi;
  }
  const LightCurveRequest &request_;
  Epoch<Utc> origin_;
};

} // namespace

Pass describe_pass(const GridPass &pass, const std::vector<EpochGeometry> &grid,
                   const LightCurveRequest &request) {
  std::size_t top = pass.first;
  for (std::size_t i = pass.first; i <= pass.last; ++i)
    if (grid[i].geometry.altitude.radians() > grid[top].geometry.altitude.radians())
      top = i;
  Pass out;
  out.rise = grid[pass.first].geometry.time;
  out.set = grid[pass.last].geometry.time;
  out.is_open_at_start = pass.first == 0;
  out.is_open_at_end = pass.last + 1 == grid.size();
  const Epoch<Utc> origin = grid[top].geometry.time;
  const Climb climb(request, origin);
  constexpr double stride_s = 10; // shorter than any passage above the horizon
  double low = -stride_s, high = stride_s;
  if (top > pass.first)
    low = seconds_between(grid[top - 1].geometry.time, origin);
  else if (const double summit = climb.walk(0, -stride_s); summit < 0) {
    low = summit - stride_s; // the span cuts the pass: it keeps the name that it has as a whole
    high = summit + stride_s;
  }
  if (top < pass.last)
    high = seconds_between(grid[top + 1].geometry.time, origin);
  else if (const double summit = climb.walk(0, stride_s); summit > 0) {
    low = summit - stride_s;
    high = summit + stride_s;
  }
  const Summit summit = climb.refine(low, high);
  out.culmination = plus_seconds(origin, summit.seconds);
  out.culmination_altitude = Angle::radians(summit.altitude_rad);
  out.id = request.orbit.id() + "-" + compact(out.culmination);
  return out;
}

} // namespace umov
