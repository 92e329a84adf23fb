// refused: could not convert
#include <umov/core/rotation.h>

using namespace umov;

#ifndef BAD
Rotation<Gcrs, Body> back(const Rotation<Body, Gcrs> &a) { return a.inverse(); }
#else
Rotation<Body, Gcrs> back(const Rotation<Body, Gcrs> &a) { return a.inverse(); }
#endif
