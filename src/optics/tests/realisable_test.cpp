#include <cmath>
#include <gtest/gtest.h>
#include <umov/optics/interface.h>
#include <umov/optics/realisable.h>

namespace umov {
namespace {

TEST(Cloude, DeterministicAndDepolarizingMatrices) {
  const auto mirror = Interface({.359, 2.69}).reflection(.4).matrix().m; // one Jones matrix: rank 1
  const auto one = cloude_eigenvalues(mirror);
  EXPECT_NEAR(one[3], mirror[0][0], 1e-12);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(one[k], 0, 1e-12);
  const auto ideal = cloude_eigenvalues({{{1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}});
  for (const double value : ideal) // the ideal depolarizer: four equal ones
    EXPECT_NEAR(value, .25, 1e-15);
}

TEST(Cloude, WhatCannotHappenHasANegativeOne) {
  // Perfect polarization kept for linear light while circular light comes back amplified in V.
  const auto bad = cloude_eigenvalues({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, -1}}});
  EXPECT_LT(bad[0], -0.1);
}

} // namespace
} // namespace umov
