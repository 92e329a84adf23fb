#include <umov/orbit/state_vector.h>

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <fmt/format.h>
#include <umov/frames/earth.h>
#include <umov/orbit/ephemeris.h>
#include <umov/orbit/moon.h>

namespace umov {
namespace {

using Phase = std::array<double, 6>; ///< position [km] and velocity [km/s], GCRS

// EGM96 (Lemoine et al. 1998); Sun and Moon: DE421.
constexpr double earth_gm = 398600.4418, sun_gm = 132712440041.0, moon_gm = 4902.800076; // km3/s2
constexpr double earth_radius_km = 6378.1363;
constexpr double j2 = 1.08262668355e-3, j3 = -2.53265648533e-6, j4 = -1.61962159137e-6;

Vec3<Gcrs> position(const Phase &p) { return {p[0], p[1], p[2]}; }

/// Pull of a distant body, less that on the Earth itself (Battin 1999, Eq. 8.61 without the form
/// for nearby bodies).
Vec3<Gcrs> third_body(double gm, Vec3<Gcrs> body, Vec3<Gcrs> r) {
  const Vec3<Gcrs> to = body - r;
  const double d = norm(to), b = norm(body);
  return to * (gm / (d * d * d)) - body * (gm / (b * b * b));
}

/// Zonal terms (Vallado 2013, Eqs. 8-30 to 8-32) about `pole`.
Vec3<Gcrs> zonal(Vec3<Gcrs> r, Vec3<Gcrs> pole) {
  const double d = norm(r), z = dot(r, pole) / d, z2 = z * z;
  const double q = earth_radius_km / d, scale = earth_gm / (d * d);
  const Vec3<Gcrs> u = r / d;
  const double a2 = 1.5 * j2 * q * q, a3 = 0.5 * j3 * q * q * q, a4 = 0.625 * j4 * q * q * q * q;
  // Along the radius, and along the pole.
  const double radial =
      a2 * (5 * z2 - 1) + a3 * 5 * (7 * z2 - 3) * z + a4 * (3 - 42 * z2 + 63 * z2 * z2);
  const double axial = -2 * a2 * z - a3 * (15 * z2 - 3) + a4 * (12 - 28 * z2) * z;
  return (u * radial + pole * axial) * scale;
}

class Forces {
public:
  explicit Forces(Epoch<Utc> start) : start_(start), pole_(itrs_from_gcrs(start).row(2)) {}

  void operator()(const Phase &p, Phase &rate, double seconds) const {
    const Epoch<Utc> time = plus_seconds(start_, seconds);
    const Vec3<Gcrs> r = position(p);
    const double d = norm(r);
    const Vec3<Gcrs> pull = r * (-earth_gm / (d * d * d)) + zonal(r, pole_) +
                            third_body(sun_gm, apparent_sun_km(time), r) +
                            third_body(moon_gm, moon_km(time), r);
    rate = {p[3], p[4], p[5], pull.x, pull.y, pull.z};
  }

private:
  Epoch<Utc> start_;
  Vec3<Gcrs> pole_;
};

Phase start_phase(const StateVector &s) {
  const GcrsState state = gcrs_state(state_in(s.state, s.frame), s.state.time);
  const Vec3<Gcrs> r = state.position_km, v = state.velocity_km_s;
  return {r.x, r.y, r.z, v.x, v.y, v.z};
}

constexpr double node_step_s = 60;

/// States every minute from the start to `seconds`, which may be negative.
Result<std::vector<EphemerisState>> states_to(const StateVector &start, const Phase &phase,
                                              double seconds) {
  namespace ode = boost::numeric::odeint;
  const auto steps = static_cast<std::size_t>(std::ceil(std::abs(seconds) / node_step_s));
  const double step = seconds < 0 ? -node_step_s : node_step_s;
  auto stepper = ode::make_controlled(1e-12, 1e-12, ode::runge_kutta_fehlberg78<Phase>());
  const Forces forces(start.state.time);
  Phase p = phase;
  std::vector<EphemerisState> out;
  for (std::size_t k = 1; k <= steps; ++k) {
    const double from = step * static_cast<double>(k - 1);
    ode::integrate_adaptive(stepper, forces, p, from, from + step, step / 2);
    const Epoch<Utc> time = plus_seconds(start.state.time, from + step);
    if (!(norm(position(p)) > 6356)) // the polar radius
      return fail(ErrorCode::Physics,
                  fmt::format("{}: the orbit meets the Earth's surface at {}. Shorten the span.",
                              start.name, to_iso(time)));
    out.push_back({time, {p[0], p[1], p[2]}, {p[3], p[4], p[5]}});
  }
  return out;
}

} // namespace

Result<OrbitEphemeris> integrate_orbit(const StateVector &start, Epoch<Utc> first,
                                       Epoch<Utc> last) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(start.state.position_km[axis]) ||
        !std::isfinite(start.state.velocity_km_s[axis]))
      return fail(ErrorCode::BadInput, "the state vector is not finite");
  const Phase phase = start_phase(start);
  if (!(norm(position(phase)) > 6356))
    return fail(ErrorCode::BadInput,
                fmt::format("the state vector lies {:.0f} km from the Earth's centre, below its "
                            "surface; positions are in km",
                            norm(position(phase))));
  constexpr double limit_s = 30 * 86400.0;
  const double back = std::min(0.0, seconds_between(first, start.state.time)),
               ahead = std::max(0.0, seconds_between(last, start.state.time));
  if (-back > limit_s || ahead > limit_s)
    return fail(ErrorCode::BadInput,
                fmt::format("the span is {:.1f} d from the state vector; 30 d is the limit",
                            std::max(-back, ahead) / 86400));
  UMOV_ASSIGN(before, states_to(start, phase, back - node_step_s));
  UMOV_ASSIGN(after, states_to(start, phase, ahead + node_step_s));
  OrbitEphemeris out{start.name, start.object_id, start.norad_cat_id, {}};
  EphemerisSegment segment;
  std::reverse(before.begin(), before.end());
  segment.states = std::move(before);
  segment.states.push_back(
      {start.state.time, {phase[0], phase[1], phase[2]}, {phase[3], phase[4], phase[5]}});
  segment.states.insert(segment.states.end(), after.begin(), after.end());
  segment.first = segment.states.front().time;
  segment.last = segment.states.back().time;
  out.segments.push_back(std::move(segment));
  return out;
}

} // namespace umov
