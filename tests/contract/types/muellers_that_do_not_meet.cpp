// refused: no match for 'operator*'
#include <umov/optics/stokes.h>

using namespace umov;

#ifndef BAD
Mueller<SkyNorth, ScatteringPlane> train(const Mueller<SkyNorth, SkyNorth> &a,
                                         const Mueller<SkyNorth, ScatteringPlane> &b) {
  return a * b;
}
#else
Mueller<SkyNorth, ScatteringPlane> train(const Mueller<SkyNorth, SkyNorth> &a,
                                         const Mueller<ScatteringPlane, SkyNorth> &b) {
  return a * b;
}
#endif
