// refused: no match for 'operator+'
#include <umov/optics/stokes.h>

using namespace umov;

#ifndef BAD
Stokes<SkyNorth> sum(Stokes<SkyNorth> a, Stokes<SkyNorth> b) { return a + b; }
#else
Stokes<SkyNorth> sum(Stokes<SkyNorth> a, Stokes<ScatteringPlane> b) { return a + b; }
#endif
