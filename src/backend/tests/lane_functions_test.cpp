// Range and greatest error of each function of lanes, on every instruction set: the numbers of the
// comments in lanes.inl.h.

#include "backend/scene_data.h"
#include "backend/tests/lane_functions.h"

#include <cmath>
#include <gtest/gtest.h>

namespace umov {
namespace {

using backend::InstructionSet;
using test::LaneFunction;

struct Row {
  const char *name;
  LaneFunction function;
  double (*exact)(double);
  float low, high;
  bool is_logarithmic;       ///< steps of equal ratio: for ranges over many powers of ten
  double absolute, relative; ///< error <= absolute + relative |value|
};

double exact_log2(double y) { return std::log1p(-y) / std::log(2.0); }

const Row rows[] = {
    {"exp2", LaneFunction::Exp2, std::exp2, -125.99F, 126.99F, false, 0, 3e-7},
    {"exp", LaneFunction::Exp, std::exp, -10, 10, false, 0, 1.2e-6},
    {"log2(1 - y)", LaneFunction::Log2OfOneMinus, exact_log2, 0, 0.99999F, false, 2e-7, 2e-7},
    {"log2(1 - y), tiny", LaneFunction::Log2OfOneMinus, exact_log2, 1e-30F, 0.1F, true, 0, 4e-7},
    {"log", LaneFunction::Log, std::log, 1e-37F, 1e37F, true, 2e-7, 2e-7},
    {"acos", LaneFunction::Acos, std::acos, -1, 1, false, 7e-5, 0},
    {"1/sqrt", LaneFunction::InverseSqrt, [](double x) { return 1 / std::sqrt(x); }, 1e-36F, 1e37F,
     true, 0, 3e-7},
    {"sqrt", LaneFunction::Sqrt, std::sqrt, 1e-35F, 1e37F, true, 0, 4e-7},
    {"1/x", LaneFunction::Reciprocal, [](double x) { return 1 / x; }, 1e-36F, 1e36F, true, 0, 3e-7},
    {"sin", LaneFunction::Sin, std::sin, -1e4F, 1e4F, false, 2e-7, 0},
    {"cos", LaneFunction::Cos, std::cos, -1e4F, 1e4F, false, 2e-7, 0},
    {"atan", LaneFunction::Atan, std::atan, -40, 40, false, 4e-7, 0},
    {"atan, tiny and large", LaneFunction::Atan, std::atan, 1e-30F, 1e30F, true, 4e-7, 0},
    {"erfc", LaneFunction::Erfc, std::erfc, -3, 3, false, 0, 4e-6},
};

std::vector<float> samples(const Row &row) {
  constexpr int count = 200'000;
  std::vector<float> out;
  for (int k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / count;
    const double x = row.is_logarithmic ? row.low * std::pow(double{row.high} / row.low, t)
                                        : row.low + t * (double{row.high} - row.low);
    out.push_back(static_cast<float>(x));
  }
  return out;
}

TEST(LaneFunctions, KeepTheirRangesAndErrors) {
  for (const auto set : {InstructionSet::Baseline, InstructionSet::Sse4, InstructionSet::Avx2,
                         InstructionSet::Avx512}) {
    if (!backend::choose_instruction_set(set))
      continue; // this machine lacks it
    for (const Row &row : rows) {
      const std::vector<float> x = samples(row), found = test::apply(row.function, x);
      double worst = 0, at = 0; // of the error in parts of what is allowed
      for (std::size_t k = 0; k < x.size(); ++k) {
        const double wanted = row.exact(x[k]);
        const double error =
            std::abs(found[k] - wanted) / (row.absolute + row.relative * std::abs(wanted));
        if (!(error <= worst)) {
          worst = error;
          at = x[k];
        }
      }
      EXPECT_LE(worst, 1) << row.name << " at " << at << ", " << backend::instruction_set_name();
      std::printf("%-8s %-22s %.2f\n", backend::instruction_set_name(), row.name, worst);
    }
  }
  backend::choose_instruction_set(InstructionSet::Best);
}

TEST(LaneFunctions, EndsOfTheirRanges) {
  for (const auto set : {InstructionSet::Baseline, InstructionSet::Sse4, InstructionSet::Avx2,
                         InstructionSet::Avx512}) {
    if (!backend::choose_instruction_set(set))
      continue;
    EXPECT_EQ(test::apply(LaneFunction::Exp2, {-127, -1000, -1e30F}),
              (std::vector<float>{0, 0, 0}));
    EXPECT_EQ(test::apply(LaneFunction::Exp2, {0})[0], 1.0F + 1.1920929e-7F); // the fit's c[0]
    EXPECT_EQ(test::apply(LaneFunction::Sqrt, {0})[0], 0);
    EXPECT_NEAR(test::apply(LaneFunction::Log2OfOneMinus, {1})[0], -99.66F, 0.01F);
    EXPECT_EQ(test::apply(LaneFunction::Log2OfOneMinus, {0})[0], 0);
    EXPECT_EQ(test::apply(LaneFunction::Sin, {0})[0], 0);
    EXPECT_EQ(test::apply(LaneFunction::Atan, {0})[0], 0);
  }
  backend::choose_instruction_set(InstructionSet::Best);
}

} // namespace
} // namespace umov
