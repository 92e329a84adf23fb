#pragma once
#include "core/tests/anchors.h"

namespace umov {

/// A number of tests/data/anchors/observing_air.csv: nine digits.
inline double of(const std::string &name) { return anchor(name, "observing_air"); }

} // namespace umov
