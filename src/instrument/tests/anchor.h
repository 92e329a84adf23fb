#pragma once
#include "core/tests/anchors.h"

namespace umov {

/// A number of tests/data/anchors/observing_instrument.csv: nine digits.
inline double of(const std::string &name) {
  static const Anchors table("observing_instrument");
  return table.row({name.c_str()})["value"];
}

} // namespace umov
