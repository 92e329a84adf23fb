#pragma once
// Functions of lanes over lists of numbers, with the instruction set in use.

#include <cstddef>
#include <vector>

namespace umov::test {

enum class LaneFunction {
  Exp2,
  Exp,
  Log2OfOneMinus,
  Log,
  Acos,
  InverseSqrt,
  Sqrt,
  Reciprocal,
  Sin,
  Cos,
  Atan,
  Erfc
};

std::vector<float> apply(LaneFunction function, const std::vector<float> &x);

} // namespace umov::test
