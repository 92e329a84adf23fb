#include <umov/frames/earth.h>

#include <array>
#include <erfa.h>
#include <umov/time/earth_orientation.h>
#include <umov/time/hourly.h>

namespace umov {
namespace {

struct Ut1Date {
  double a, b;
};

Ut1Date ut1_of(Epoch<Utc> time, double dut1_s) {
  Ut1Date out{};
  eraUtcut1(time.jd1, time.jd2, dut1_s, &out.a, &out.b);
  return out;
}

/// Celestial intermediate pole and origin: X, Y and s of IAU 2006/2000A [rad].
std::array<double, 3> celestial_pole(double tt1, double tt2) {
  std::array<double, 3> out{};
  eraXys06a(tt1, tt2, &out[0], &out[1], &out[2]);
  return out;
}

template <class To, class From> Rotation<To, From> from_rows(const double m[3][3]) {
  return {Vec3<From>{m[0][0], m[0][1], m[0][2]}, Vec3<From>{m[1][0], m[1][1], m[1][2]},
          Vec3<From>{m[2][0], m[2][1], m[2][2]}};
}

} // namespace

Rotation<Itrs, Teme> itrs_from_teme(Epoch<Utc> time) {
  const EarthOrientation eo = earth_orientation(time);
  const Ut1Date ut1 = ut1_of(time, eo.dut1_s);
  double sidereal[3][3], pole[3][3], both[3][3];
  eraIr(sidereal);
  eraRz(eraGmst82(ut1.a, ut1.b), sidereal);
  // s' is below 0.1 mas in this century: 3 mm on the ground.
  eraPom00(eo.x_p_rad, eo.y_p_rad, 0, pole);
  eraRxr(pole, sidereal, both);
  return from_rows<Itrs, Teme>(both);
}

Rotation<Itrs, Gcrs> itrs_from_gcrs(Epoch<Utc> time) {
  const EarthOrientation eo = earth_orientation(time);
  const Ut1Date ut1 = ut1_of(time, eo.dut1_s);
  const Epoch<Tt> tt = tt_from(time);
  // As eraC2t06a, but for the pole, which is known from its place on whole hours.
  thread_local Hourly<3> pole_of_date(celestial_pole);
  const auto [x, y, s] = pole_of_date(tt);
  double intermediate[3][3], motion[3][3], m[3][3];
  eraC2ixys(x, y, s, intermediate);
  eraPom00(eo.x_p_rad, eo.y_p_rad, eraSp00(tt.jd1, tt.jd2), motion);
  eraC2tcio(intermediate, eraEra00(ut1.a, ut1.b), motion, m);
  return from_rows<Itrs, Gcrs>(m);
}

} // namespace umov
