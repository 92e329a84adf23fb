// refused: could not convert
#include <umov/core/quantity.h>

using namespace umov;

#ifndef BAD
Angle right() { return Angle::degrees(90); }
#else
Angle right() { return 90.0; }
#endif
