#include <umov/lightcurve/periodogram.h>

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Rows of one kind of tests/data/periodogram/astropy.csv: two numbers each.
std::vector<std::pair<double, double>> rows_of(const std::string &kind) {
  std::ifstream file(std::string(UMOV_SOURCE_DIR) + "/tests/data/periodogram/astropy.csv");
  std::vector<std::pair<double, double>> out;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string name;
    double first = 0, second = 0;
    char comma = 0;
    if (std::getline(cells, name, ',') && name == kind && cells >> first >> comma >> second)
      out.emplace_back(first, second);
  }
  return out;
}

struct Series {
  std::vector<double> seconds, magnitudes;
};

Series sine(double period_s, double step_s, std::size_t count) {
  Series out;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = step_s * static_cast<double>(k);
    out.seconds.push_back(t);
    out.magnitudes.push_back(8 - 0.002 * t + 0.4 * std::sin(2 * pi * t / period_s));
  }
  return out;
}

TEST(Periodogram, AgreesWithAstropy) {
  Series series;
  for (const auto &[time, magnitude] : rows_of("series")) {
    series.seconds.push_back(time);
    series.magnitudes.push_back(magnitude);
  }
  const Periodogram found = periodogram(series.seconds, series.magnitudes);
  const auto expected = rows_of("power");
  ASSERT_EQ(expected.size(), 25U);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    ASSERT_GT(found.power.size(), 8 * k);
    EXPECT_NEAR(found.period_s[8 * k], expected[k].first, 1e-9 * expected[k].first);
    // Twelve digits are printed; two fits of a parabola differ by less.
    EXPECT_NEAR(found.power[8 * k], expected[k].second, 1e-10) << found.period_s[8 * k];
  }
  // The series was made with 11.7 s; noise of .2 under an amplitude of .6 moves a peak by
  // sqrt(6 / N) / (pi T) noise / amplitude in frequency (Montgomery & O'Donoghue 1999), .01 s here.
  EXPECT_NEAR(found.best_s, 11.7, 0.04);
}

TEST(Periodogram, FindsThePeriodOfASine) {
  const Series series = sine(23.7, 1, 420);
  const Periodogram found = periodogram(series.seconds, series.magnitudes);
  // 420 s hold 17.7 turns: the parabola takes a little of the last one.
  EXPECT_NEAR(found.best_s, 23.7, 0.03);
  EXPECT_NEAR(found.period_s.front(), 419.0 / 2, 1e-9);
  EXPECT_GT(found.period_s.back(), 2 - 1e-9); // twice the step
}

TEST(Periodogram, TooLittleGivesNothing) {
  EXPECT_TRUE(periodogram({}, {}).power.empty());
  const Series few = sine(5, 1, 11), many = sine(5, 1, 30);
  EXPECT_TRUE(periodogram(few.seconds, few.magnitudes).power.empty());
  const std::vector<double> flat(30, 7.0);
  EXPECT_TRUE(periodogram(many.seconds, flat).power.empty());
}

TEST(Periodogram, ThinningKeepsThePeaks) {
  const Series series = sine(4.1, 0.5, 3000);
  const Periodogram full = periodogram(series.seconds, series.magnitudes);
  const Periodogram thin = with_fewer_values(full, 200);
  ASSERT_EQ(thin.power.size(), 200U);
  EXPECT_EQ(*std::max_element(thin.power.begin(), thin.power.end()),
            *std::max_element(full.power.begin(), full.power.end()));
  EXPECT_EQ(thin.best_s, full.best_s);
}

} // namespace
} // namespace umov
