// refused: no match for 'operator*'
#include <umov/core/rotation.h>

using namespace umov;

#ifndef BAD
Vec3<Body> turn(const Rotation<Body, Gcrs> &body_from_gcrs, Vec3<Gcrs> a) {
  return body_from_gcrs * a;
}
#else
Vec3<Body> turn(const Rotation<Body, Gcrs> &body_from_gcrs, Vec3<Body> a) {
  return body_from_gcrs * a;
}
#endif
