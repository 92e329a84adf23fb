#pragma once
// Private: a state between those of an ephemeris.

#include <umov/orbit/trajectory.h>

namespace umov {

/// Position and velocity in the segment's frame; `time` is within its states.
EphemerisState interpolate(const EphemerisSegment &segment, Epoch<Utc> time);

} // namespace umov
