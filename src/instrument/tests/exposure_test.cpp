#include "instrument/tests/anchor.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <umov/instrument/exposure.h>

namespace umov {
namespace {

/// Worst error for a Gaussian flash of unit width at any phase, over its largest mean.
double worst_error(double exposure, double feature) {
  const double s = 1 / std::sqrt(8 * std::log(2.)), root = s * std::sqrt(2.);
  const auto nodes = exposure_nodes(exposure, feature);
  double worst = 0, largest = 0;
  for (int k = 0; k <= 4000; ++k) {
    const double at = (exposure / 2 + 2) * (k / 2000. - 1);
    const double exact =
        s * std::sqrt(2 * 3.14159265358979) / 2 / exposure *
        (std::erf((exposure / 2 - at) / root) + std::erf((exposure / 2 + at) / root));
    double found = 0;
    for (const ExposureNode &node : nodes)
      found += node.weight * std::exp(-std::pow((node.offset_s - at) / s, 2) / 2);
    worst = std::max(worst, std::abs(found - exact));
    largest = std::max(largest, exact);
  }
  return worst / largest;
}

TEST(ExposureNodes, ErrorOfAFlashIsThatOfTheRule) {
  for (const char *exposure : {"0.5", "1", "2", "5"}) { // four digits
    const double length = AnchorRow::number(exposure);
    EXPECT_NEAR(worst_error(length, 1) / of(std::string("panel_") + exposure), 1, 1e-3);
    EXPECT_NEAR(worst_error(length, .5) / of(std::string("half_panel_") + exposure), 1, 1e-3);
  }
}

TEST(ExposureNodes, WeightsAddUpToOne) {
  for (const double feature : {0., .01, .3, 10.}) {
    double sum = 0, first = 0;
    for (const ExposureNode &node : exposure_nodes(1, feature)) {
      sum += node.weight;
      first += node.weight * node.offset_s;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(first, 0, 1e-12);
  }
}

} // namespace
} // namespace umov
