// One text for every number type: float, lanes and duals give what double gives.

#include "kernel/tests/dual.h"
#include "kernel/tests/lanes_probe.h"
#include "kernel/tests/probes.inl.h"

#include <gtest/gtest.h>

namespace umov {
namespace {

using test::Dual;

constexpr int steps = 61; ///< x = k/64, 2 <= k < 63: not the ends

std::vector<double> in_double(std::size_t family, double x) {
  std::vector<double> out;
  kernel::probe<double, double>(family, x, [&](double value) { out.push_back(value); });
  return out;
}
std::vector<double> in_float(std::size_t family, float x) {
  std::vector<double> out;
  kernel::probe<float, float>(family, x,
                              [&](float value) { out.push_back(static_cast<double>(value)); });
  return out;
}
std::vector<Dual> in_dual(std::size_t family, double x) {
  std::vector<Dual> out;
  kernel::probe<Dual, double>(family, Dual(x, 1), [&](Dual value) { out.push_back(value); });
  return out;
}

void expect_near(const std::vector<double> &found, const std::vector<double> &wanted,
                 std::size_t family, double x, const char *type) {
  const auto [name, tolerance] = kernel::probe_family(family);
  ASSERT_EQ(found.size(), wanted.size()) << name << ", " << type;
  for (std::size_t k = 0; k < wanted.size(); ++k)
    EXPECT_NEAR(found[k], wanted[k], tolerance * (1 + std::abs(wanted[k])))
        << name << " number " << k << " at " << x << ", " << type;
}

TEST(KernelContract, FloatGivesWhatDoubleGives) {
  for (std::size_t family = 0; family < kernel::probe_families; ++family)
    for (int k = 2; k < 2 + steps; ++k)
      expect_near(in_float(family, static_cast<float>(k) / 64), in_double(family, k / 64.0), family,
                  k / 64.0, "float");
}

TEST(KernelContract, LanesGiveWhatDoubleGives) {
  test::for_each_instruction_set(
      [](const char *name, void *) {
        for (std::size_t family = 0; family < kernel::probe_families; ++family)
          for (int k = 2; k < 2 + steps; ++k)
            expect_near(test::lane_values(family, static_cast<float>(k) / 64),
                        in_double(family, k / 64.0), family, k / 64.0, name);
      },
      nullptr);
}

TEST(KernelContract, DualsGiveTheValueAndItsSlope) {
  constexpr double h = 1e-6; // leaves 1e-10 / h of rounding and h^2 of the third derivative
  for (std::size_t family = 0; family < kernel::probe_families; ++family)
    for (int k = 2; k < 2 + steps; ++k) {
      const double x = k / 64.0 + 1.0 / 1024; // no kink is there
      const auto found = in_dual(family, x);
      const auto wanted = in_double(family, x), after = in_double(family, x + h),
                 before = in_double(family, x - h);
      ASSERT_EQ(found.size(), wanted.size());
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double slope = (after[i] - before[i]) / (2 * h);
        EXPECT_NEAR(found[i].value, wanted[i], 1e-14 * (1 + std::abs(wanted[i])));
        EXPECT_NEAR(found[i].slope, slope, 1e-6 * (1 + std::abs(slope)))
            << kernel::probe_family(family).name << " number " << i << " at " << x;
      }
    }
}

/// Limits that a branch used to guard: every type takes both sides of a select.
template <class R> void expect_finite_limits() {
  const auto is_finite = [](R x) { return x - x == R(0); };
  for (const R c : {R(0), R(1)}) {
    EXPECT_TRUE(is_finite(kernel::beckmann_beyond(c, R(0.001))));
    EXPECT_TRUE(is_finite(kernel::ggx_beyond(c, R(1))));
    EXPECT_TRUE(is_finite(kernel::beckmann_masking(c, R(0.5))));
    EXPECT_TRUE(is_finite(kernel::fresnel(c, kernel::Complex<R>{R(1.5), R(0)}).s.re));
    EXPECT_TRUE(is_finite(kernel::fresnel(c, kernel::Complex<R>{R(1), R(0)}).p.re));
    EXPECT_TRUE(is_finite(kernel::cos_azimuth(c, R(1), c)));
    EXPECT_TRUE(is_finite(kernel::log2_of_one_minus(c)));
  }
}
TEST(KernelContract, LimitsAreFinite) {
  expect_finite_limits<float>();
  expect_finite_limits<double>();
  expect_finite_limits<Dual>();
}

} // namespace
} // namespace umov
