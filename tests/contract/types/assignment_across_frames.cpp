// refused: could not convert
#include <umov/core/vec3.h>

using namespace umov;

#ifndef BAD
Vec3<Gcrs> same(Vec3<Gcrs> a) { return a; }
#else
Vec3<Gcrs> same(Vec3<Teme> a) { return a; }
#endif
