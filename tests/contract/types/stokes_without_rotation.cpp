// refused: could not convert
#include <umov/optics/stokes.h>

using namespace umov;

#ifndef BAD
Stokes<SkyNorth> north(const Stokes<ScatteringPlane> &s) {
  return rotate_to<SkyNorth>(s, Angle::degrees(30));
}
#else
Stokes<SkyNorth> north(const Stokes<ScatteringPlane> &s) { return s; }
#endif
