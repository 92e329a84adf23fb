// refused: no matching function for call to 'dot
#include <umov/core/vec3.h>

using namespace umov;

#ifndef BAD
double angle(Vec3<Gcrs> a, Vec3<Gcrs> b) { return dot(a, b); }
#else
double angle(Vec3<Gcrs> a, Vec3<Body> b) { return dot(a, b); }
#endif
