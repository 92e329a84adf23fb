// refused: could not convert
#include <umov/time/epoch.h>

using namespace umov;

#ifndef BAD
double length(Epoch<Utc> a, Epoch<Utc> b) { return seconds_between(a, b); }
#else
double length(Epoch<Utc> a, Epoch<Tt> b) { return seconds_between(a, b); }
#endif
