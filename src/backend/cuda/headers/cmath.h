// Of <cmath>, what the kernels use: the compiler of cards at run time knows the functions, but has
// no standard library.
#pragma once
namespace std {
using ::abs;
using ::acos;
using ::atan;
using ::atan2;
using ::copysign;
using ::cos;
using ::erfc;
using ::exp;
using ::exp2;
using ::fabs;
using ::log;
using ::log1p;
using ::sin;
using ::sqrt;
} // namespace std
