#pragma once
#include "core/tests/anchors.h"

namespace umov {

/// A number of tests/data/anchors/observing_air.csv: nine digits.
inline double of(const std::string &name) {
  static const Anchors table("observing_air");
  return table.row({name.c_str()})["value"];
}

} // namespace umov
