#include <umov/orbit/state.h>

#include "orbit/earth_axes.h"

#include <umov/core/constants.h>
#include <umov/frames/earth.h>

namespace umov {

Vec3<Itrs> carried_km_s(Vec3<Itrs> position_km) {
  // The Earth turns about its own axis, which polar motion tilts by microradians only.
  return cross(Vec3<Itrs>{0, 0, constants::earth_rate_rad_s}, position_km);
}

EarthAxes earth_axes(const OrbitState &state, Epoch<Utc> time,
                     const Rotation<Itrs, Gcrs> &gcrs_to_itrs) {
  if (const auto *s = std::get_if<GcrsState>(&state))
    return {gcrs_to_itrs * s->position_km, gcrs_to_itrs * s->velocity_km_s};
  if (const auto *s = std::get_if<ItrsState>(&state))
    return {s->position_km, s->velocity_km_s + carried_km_s(s->position_km)};
  const auto &s = std::get<TemeState>(state);
  const auto teme_to_itrs = itrs_from_teme(time);
  return {teme_to_itrs * s.position_km, teme_to_itrs * s.velocity_km_s};
}

EarthAxes earth_axes(const OrbitState &state, Epoch<Utc> time) {
  return earth_axes(state, time,
                    std::holds_alternative<GcrsState>(state) ? itrs_from_gcrs(time)
                                                             : Rotation<Itrs, Gcrs>{});
}

TemeState teme_state(const OrbitState &state, Epoch<Utc> time) {
  if (const auto *own = std::get_if<TemeState>(&state))
    return *own;
  const EarthAxes earth = earth_axes(state, time);
  const auto teme_from_itrs = itrs_from_teme(time).inverse();
  return {teme_from_itrs * earth.position_km, teme_from_itrs * earth.inertial_km_s};
}

GcrsState gcrs_state(const OrbitState &state, Epoch<Utc> time) {
  if (const auto *own = std::get_if<GcrsState>(&state))
    return *own;
  const EarthAxes earth = earth_axes(state, time);
  const auto gcrs_from_itrs = itrs_from_gcrs(time).inverse();
  return {gcrs_from_itrs * earth.position_km, gcrs_from_itrs * earth.inertial_km_s};
}

Vec3<Itrs> itrs_position_km(const OrbitState &state, Epoch<Utc> time) {
  return earth_axes(state, time).position_km;
}

} // namespace umov
