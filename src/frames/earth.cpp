#include <umov/frames/earth.h>

#include <erfa.h>
#include <umov/time/earth_orientation.h>

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
  double m[3][3];
  eraC2t06a(tt.jd1, tt.jd2, ut1.a, ut1.b, eo.x_p_rad, eo.y_p_rad, m);
  return from_rows<Itrs, Gcrs>(m);
}

} // namespace umov
