// refused: no match for 'operator+'
#include <umov/core/vec3.h>

using namespace umov;

#ifndef BAD
Vec3<Teme> sum(Vec3<Teme> a, Vec3<Teme> b) { return a + b; }
#else
Vec3<Teme> sum(Vec3<Teme> a, Vec3<Itrs> b) { return a + b; }
#endif
