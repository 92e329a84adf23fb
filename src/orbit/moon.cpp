#include <umov/orbit/moon.h>

#include <erfa.h>
#include <umov/core/constants.h>

namespace umov {

Vec3<Gcrs> moon_km(Epoch<Utc> time) {
  const Epoch<Tt> tt = tt_from(time);
  double state[2][3];
  eraMoon98(tt.jd1, tt.jd2, state);
  return Vec3<Gcrs>{state[0][0], state[0][1], state[0][2]} * constants::au_km;
}

} // namespace umov
