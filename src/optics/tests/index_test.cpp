#include <cmath>
#include <gtest/gtest.h>
#include <umov/optics/index.h>

namespace umov {
namespace {

IndexTable formula(int number, std::vector<double> c) {
  IndexTable out;
  out.name = "test";
  out.n = DispersionFormula{number, std::move(c), 300, 2000};
  return out;
}

double n_at(const IndexTable &table, double nm) {
  return index_at(table, Wavelength::nm(nm))->real();
}

TEST(Index, SellmeierOfSchottGlassAtTheHeliumLine) {
  // N-BK7 at 587.6 nm: n = 1.5168 (Schott catalogue), formula 2.
  const auto bk7 =
      formula(2, {0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653});
  EXPECT_NEAR(n_at(bk7, 587.5618), 1.5168, 5e-6);
  // The same glass in formula 1 has the roots of the poles.
  const auto same = formula(1, {0, 1.03961212, std::sqrt(0.00600069867), 0.231792344,
                                std::sqrt(0.0200179144), 1.01046945, std::sqrt(103.560653)});
  EXPECT_NEAR(n_at(same, 700), n_at(bk7, 700), 1e-14);
}

TEST(Index, EveryFormulaAgainstItsOwnArithmetic) {
  // x = 0.5 um; each right side is the formula of refractiveindex.info written out by hand.
  const double x = 0.5, x2 = 0.25;
  EXPECT_NEAR(n_at(formula(3, {2, 0.01, 2, 0.02, -2}), 500), std::sqrt(2 + 0.0025 + 0.08), 1e-14);
  EXPECT_NEAR(n_at(formula(4, {2, 0.3, 1, 0.1, 2, 0.2, 0, 0.1, 1, 0.05, 2}), 500),
              std::sqrt(2 + 0.3 * x / (x2 - 0.01) + 0.2 / (x2 - 0.1) + 0.05 * x2), 1e-14);
  EXPECT_NEAR(n_at(formula(5, {1.5, 0.004, -2}), 500), 1.5 + 0.016, 1e-14);
  EXPECT_NEAR(n_at(formula(6, {0, 0.05792105, 238.0185, 0.00167917, 57.362}), 589.3), 1.000277,
              5e-7); // air, Ciddor 1996: n - 1 = 2.77e-4
  const double l = 1 / (x2 - 0.028);
  EXPECT_NEAR(n_at(formula(7, {1.4, 0.01, 0.001, 0.02, 0.003, 0.0004}), 500),
              1.4 + 0.01 * l + 0.001 * l * l + 0.02 * x2 + 0.003 * x2 * x2 + 0.0004 * x2 * x2 * x2,
              1e-14);
  const double f = 0.2 + 0.1 * x2 / (x2 - 0.01) + 0.03 * x2;
  EXPECT_NEAR(n_at(formula(8, {0.2, 0.1, 0.01, 0.03}), 500), std::sqrt((1 + 2 * f) / (1 - f)),
              1e-14);
  EXPECT_NEAR(n_at(formula(9, {2, 0.01, 0.02, 0.03, 0.4, 0.05}), 500),
              std::sqrt(2 + 0.01 / (x2 - 0.02) + 0.03 * (x - 0.4) / (0.01 + 0.05)), 1e-14);
}

TEST(Index, EndsWhereNOrKEnds) {
  IndexTable table = tabulated_index("t", {400, 500, 700}, {{1.5, 0}, {1.4, 0.1}, {1.3, 0.2}});
  table.k = {{450, 600}, {0.1, 0.4}};
  EXPECT_FALSE(index_at(table, Wavelength::nm(420)));
  EXPECT_FALSE(index_at(table, Wavelength::nm(650)));
  const auto eta = *index_at(table, Wavelength::nm(600));
  EXPECT_NEAR(eta.real(), 1.35, 1e-15);
  EXPECT_NEAR(eta.imag(), 0.4, 1e-15);
  EXPECT_EQ(range_of(table).first_nm, 450);
}

TEST(Index, RefusesWhatIsNoTable) {
  const auto says = [](const IndexTable &table, const char *word) {
    const auto done = check_index(table);
    return !done && done.error().message.find(word) != std::string::npos;
  };
  EXPECT_TRUE(says(tabulated_index("t", {500, 400}, {{1, 0}, {1, 0}}), "increasing"));
  EXPECT_TRUE(says(tabulated_index("t", {400, 400}, {{1, 0}, {1, 0}}), "repeated"));
  EXPECT_TRUE(says(tabulated_index("t", {0.4, 0.5}, {{1, 0}, {1, 0}}), "um"));
  EXPECT_TRUE(says(tabulated_index("t", {400, 500}, {{1, -1}, {1, 0}}), "k = -1"));
  EXPECT_TRUE(says(tabulated_index("t", {400, 500}, {{0, 0}, {1, 0}}), "n = 0"));
  EXPECT_TRUE(says(constant_index({std::nan(""), 0}), "finite"));
  EXPECT_TRUE(says(formula(10, {1}), "formula 10"));
  EXPECT_TRUE(says(formula(7, {1, 2, 3, 4, 5, 6, 7}), "coefficients"));
}

} // namespace
} // namespace umov
