#pragma once
// Private: a state in Earth-fixed axes, from whichever frame it is known in.

#include <umov/core/rotation.h>
#include <umov/orbit/state.h>

namespace umov {

/// The velocity is inertial, in axes of the moment.
struct EarthAxes {
  Vec3<Itrs> position_km, inertial_km_s;
};
EarthAxes earth_axes(const OrbitState &state, Epoch<Utc> time);
/// The same where `itrs_from_gcrs(time)` is at hand.
EarthAxes earth_axes(const OrbitState &state, Epoch<Utc> time,
                     const Rotation<Itrs, Gcrs> &gcrs_to_itrs);

/// What the Earth's turning adds to a velocity relative to it.
Vec3<Itrs> carried_km_s(Vec3<Itrs> position_km);

} // namespace umov
