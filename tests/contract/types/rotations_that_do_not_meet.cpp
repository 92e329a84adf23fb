// refused: no match for 'operator*'
#include <umov/core/rotation.h>

using namespace umov;

#ifndef BAD
Rotation<Enu, Gcrs> chain(const Rotation<Enu, Itrs> &a, const Rotation<Itrs, Gcrs> &b) {
  return a * b;
}
#else
Rotation<Enu, Gcrs> chain(const Rotation<Enu, Itrs> &a, const Rotation<Gcrs, Itrs> &b) {
  return a * b;
}
#endif
