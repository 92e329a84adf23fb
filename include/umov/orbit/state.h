#pragma once
// A state of an object in the frame that it is known in: nothing is turned that nobody asked for.

#include <umov/core/vec3.h>
#include <umov/time/epoch.h>
#include <variant>

namespace umov {

/// Position and velocity as SGP4 gives them.
struct TemeState {
  Vec3<Teme> position_km;
  Vec3<Teme> velocity_km_s;
};
/// Inertial, as numerical integration and precise orbits give them.
struct GcrsState {
  Vec3<Gcrs> position_km;
  Vec3<Gcrs> velocity_km_s;
};
/// Fixed to the Earth; the velocity is relative to the turning Earth.
struct ItrsState {
  Vec3<Itrs> position_km;
  Vec3<Itrs> velocity_km_s;
};

/// A state in one of these frames.
using OrbitState = std::variant<TemeState, GcrsState, ItrsState>;

/// The same state in TEME (GMST82 and polar motion, as `itrs_from_teme`) at its time.
TemeState teme_state(const OrbitState &state, Epoch<Utc> time);
/// The same state in GCRS (IAU 2006/2000A, as `itrs_from_gcrs`).
GcrsState gcrs_state(const OrbitState &state, Epoch<Utc> time);
/// The same position in ITRS.
Vec3<Itrs> itrs_position_km(const OrbitState &state, Epoch<Utc> time);

} // namespace umov
