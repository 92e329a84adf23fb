#include "core/tests/anchors.h"

#include <gtest/gtest.h>
#include <umov/atmosphere/scintillation.h>

namespace umov {
namespace {

double of(const char *name) { return Anchors("observing_air").row({name})["value"]; }

TEST(Scintillation, FollowsOsborn) { // nine digits
  EXPECT_NEAR(scintillation_sd({3058, 1.5}, .2794, 1, 1.5), of("scintillation_c11"), 1e-10);
  EXPECT_NEAR(scintillation_sd({3058, 1.63}, 1, .1, 1), of("scintillation_metre"), 1e-10);
  EXPECT_NEAR(scintillation_sd({2030, 1.5}, .071, .1, 1), of("scintillation_lens"), 1e-10);
}

TEST(Scintillation, SlewingOutrunsTheWind) {
  constexpr double degree = 3.14159265358979 / 180;
  EXPECT_NEAR(slewing_variance_factor(.5 * degree, 1.5), of("slewing_factor"), 1e-9);
  EXPECT_EQ(slewing_variance_factor(0, 1.5), 1);
}

} // namespace
} // namespace umov
