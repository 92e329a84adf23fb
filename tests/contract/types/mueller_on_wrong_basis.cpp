// refused: no match for 'operator*'
#include <umov/optics/stokes.h>

using namespace umov;

#ifndef BAD
Stokes<ScatteringPlane> light(const Mueller<ScatteringPlane, ScatteringPlane> &m,
                              Stokes<ScatteringPlane> s) {
  return m * s;
}
#else
Stokes<ScatteringPlane> light(const Mueller<ScatteringPlane, ScatteringPlane> &m,
                              Stokes<SkyNorth> s) {
  return m * s;
}
#endif
