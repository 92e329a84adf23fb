#include "atmosphere/tests/anchor.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/atmosphere/scintillation.h>

namespace umov {
namespace {

TEST(Scintillation, FollowsOsborn) { // nine digits
  EXPECT_NEAR(scintillation_sd({3058, 1.5}, .2794, 1, 1.5), of("scintillation_c11"), 1e-10);
  EXPECT_NEAR(scintillation_sd({3058, 1.63}, 1, .1, 1), of("scintillation_metre"), 1e-10);
  EXPECT_NEAR(scintillation_sd({2030, 1.5}, .071, .1, 1), of("scintillation_lens"), 1e-10);
}

TEST(Scintillation, ShortExposuresSeeTheAirStandStill) { // eight digits of a constant
  EXPECT_NEAR(wind_crossing_s(.2794), of("wind_crossing_c11"), 1e-10);
  for (const double seconds : {1e-5, .004})
    EXPECT_NEAR(scintillation_sd({3058, 1.5}, .2794, seconds, 1.5), of("scintillation_still"),
                1e-9);
  // No slewing makes a pupil that sees still air see less of it.
  EXPECT_EQ(slewing_scintillation_sd({0, 1.5}, 1, 1e-4, 1, .01),
            scintillation_sd({0, 1.5}, 1, 1e-4, 1));
  EXPECT_NEAR(std::pow(slewing_scintillation_sd({0, 1.5}, 1, 1, 1, .01) /
                           scintillation_sd({0, 1.5}, 1, 1, 1),
                       2),
              slewing_variance_factor(.01, 1), 1e-12);
}

TEST(Scintillation, SlewingOutrunsTheWind) {
  constexpr double degree = 3.14159265358979 / 180;
  EXPECT_NEAR(slewing_variance_factor(.5 * degree, 1.5), of("slewing_factor"), 1e-9);
  EXPECT_EQ(slewing_variance_factor(0, 1.5), 1);
}

} // namespace
} // namespace umov
