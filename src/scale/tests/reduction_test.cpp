// What is kept of rows: counted by hand, and the same however they come.

#include <umov/scale/reduction.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <span>

namespace umov::scale {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Table rows(std::vector<double> values, std::vector<std::string> bands) {
  std::vector<std::int64_t> numbers;
  for (std::size_t k = 0; k < values.size(); ++k)
    numbers.push_back(static_cast<std::int64_t>(k));
  Table out;
  out.note("frame", "body");
  out.add("pose", "", "number", std::move(numbers));
  out.add("band", "", "band", std::move(bands));
  out.add("intensity", "m2 / sr", "light", std::move(values));
  return out;
}
Table some_rows() {
  return rows({0.5, 3, 1, nan, 10, 2, -1, 4, 1, 3},
              {"B", "V", "B", "V", "B", "V", "B", "V", "B", "V"});
}

template <class T> std::vector<T> cells(const Table &table, const char *name) {
  return std::get<std::vector<T>>(table.find(name)->cells);
}

/// What two that had the rows before and behind a cut keep together.
std::unique_ptr<Reducer> joined(const std::string &text, const Table &all, std::size_t cut,
                                std::span<const double> order = {}) {
  const auto one = make_reducer(text), other = make_reducer(text);
  auto both = make_reducer(text);
  const std::size_t ordered = std::min(cut, order.size());
  EXPECT_TRUE((*one)->take(all.part(0, cut), order.first(ordered)));
  EXPECT_TRUE((*other)->take(all.part(cut, all.rows() - cut), order.subspan(ordered)));
  EXPECT_TRUE((*both)->join((*one)->kept()));
  EXPECT_TRUE((*both)->join((*other)->kept()));
  return std::move(*both);
}
Table kept(const std::string &text, const Table &all, std::size_t cut) {
  return joined(text, all, cut)->table();
}

TEST(Reductions, CountRowsInBinsOfEachBand) {
  // Bins [1, 2), [2, 3), [3, 4); below, from 4 on, without a value.
  const std::vector<std::int64_t> expected{2, 0, 0, 2, 1, 0, /* V */ 0, 1, 2, 0, 1, 1};
  for (const std::size_t cut : {0, 3, 10}) {
    const Table table = kept("histogram:intensity:1:4:3", some_rows(), cut);
    EXPECT_EQ(cells<std::int64_t>(table, "count"), expected);
    EXPECT_EQ(table.text("band", 0), "B");
    EXPECT_EQ(table.text("band", 11), "V");
    EXPECT_EQ(table.find("low")->unit, "m2 / sr");
    EXPECT_EQ(table.number("low", 2), 3);
    EXPECT_EQ(table.number("high", 3), 1); // those below
    EXPECT_TRUE(std::isnan(table.number("low", 3)) && std::isnan(table.number("high", 4)));
    EXPECT_EQ(std::ranges::count(table.notes(), std::string("reduction"),
                                 &std::pair<std::string, std::string>::first),
              1);
  }
}

TEST(Reductions, PutValuesOnAnEdgeIntoTheBinThatItBegins) {
  const auto reducer = make_reducer("log-histogram:intensity:1e-3:1e3:6");
  const Table powers = rows({1e-3, 1e-2, 1e-1, 1, 10, 100, 1e3}, std::vector<std::string>(7, "V"));
  ASSERT_TRUE((*reducer)->take(powers));
  const Table table = (*reducer)->table();
  const auto edges = cells<double>(table, "low");
  // pow() need not give powers of ten to the last digit: what counts are the edges that are told.
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(edges[k], std::pow(10, static_cast<double>(k) - 3), 1e-12 * edges[k]);
  const auto again = make_reducer("log-histogram:intensity:1e-3:1e3:6");
  ASSERT_TRUE(
      (*again)->take(rows({edges.begin(), edges.begin() + 6}, std::vector<std::string>(6, "V"))));
  const auto counts = cells<std::int64_t>((*again)->table(), "count");
  EXPECT_EQ(std::vector<std::int64_t>(counts.begin(), counts.begin() + 6),
            std::vector<std::int64_t>(6, 1));
}

TEST(Reductions, KeepTheMostAndTheLeastWithEarlierRowsFirst) {
  for (const std::size_t cut : {0, 1, 5, 9, 10}) {
    const Table most = kept("most:intensity:2", some_rows(), cut);
    EXPECT_EQ(cells<double>(most, "intensity"), (std::vector<double>{10, 1, 4, 3}));
    EXPECT_EQ(cells<std::int64_t>(most, "pose"), (std::vector<std::int64_t>{4, 2, 7, 1}));
    const Table least = kept("least:intensity:3:pose+band", some_rows(), cut);
    EXPECT_EQ(least.rows(), 9u); // one of each pose; that without a value is none
  }
}

/// Rows of three that are made one after the other, and what puts all of them in order.
struct Made {
  Table rows;
  std::vector<double> order;
};
Made made_by_three() {
  return {rows({7, 7, 5, 7, 5, 7, nan}, {"A", "A", "B", "C", "C", "B", "A"}),
          {30, 10, 20, 5, 10, 5, 1}};
}

TEST(Reductions, TakeWhatIsTheSameInTheOrderOfTheWholeTable) {
  // In order: pose 6 (A, nothing), 3 (C), 5 (B), 1 (A), 4 (C), 2 (B), 0 (A).
  const Made all = made_by_three();
  for (std::size_t cut = 0; cut <= 7; ++cut)
    for (const auto &[text, poses] :
         {std::pair<std::string, std::vector<std::int64_t>>{"most:intensity:1:band", {3, 5, 1}},
          {"least:intensity:2:band", {4, 3, 2, 5, 1, 0}}}) {
      const auto both = joined(text, all.rows, cut, all.order);
      EXPECT_EQ(cells<std::int64_t>(both->table(), "pose"), poses) << text << " cut at " << cut;
      EXPECT_EQ(both->table().columns().size(), 3u);
      EXPECT_EQ(both->rows(), 7u);
    }
}

TEST(Reductions, CountGroupsInTheOrderOfTheWholeTable) {
  const Made all = made_by_three();
  const std::string text = "histogram:intensity:0:6:1:band";
  for (std::size_t cut = 0; cut <= 7; ++cut) {
    const auto both = joined(text, all.rows, cut, all.order);
    const Table table = both->table();
    EXPECT_EQ(
        cells<std::string>(table, "band"),
        (std::vector<std::string>{"A", "A", "A", "A", "C", "C", "C", "C", "B", "B", "B", "B"}));
    // In the bin, below, above, without a value.
    EXPECT_EQ(cells<std::int64_t>(table, "count"),
              (std::vector<std::int64_t>{0, 0, 2, 1, 1, 0, 1, 0, 1, 0, 1, 0}));
    EXPECT_EQ(table.columns().size(), 4u);
  }
}

TEST(Reductions, OfManyRowsAreWhatSortingThemGives) {
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 20'000; ++k)
    values.push_back(static_cast<double>((k * 2'654'435'761U) % 1009));
  const Table all = rows(values, std::vector<std::string>(values.size(), "V"));
  const auto reducer = make_reducer("most:intensity:50");
  for (std::size_t at = 0; at < values.size(); at += 700)
    ASSERT_TRUE((*reducer)->take(all.part(at, std::min<std::size_t>(700, values.size() - at))));
  std::vector<std::size_t> order(values.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  const auto poses = cells<std::int64_t>((*reducer)->table(), "pose");
  ASSERT_EQ(poses.size(), 50u);
  for (std::size_t k = 0; k < 50; ++k)
    EXPECT_EQ(poses[k], static_cast<std::int64_t>(order[k]));
}

TEST(Reductions, AreOfAnyNumberOfValuesInTimeThatGrowsWithIt) {
  // 200,000 values of pose, in an order in which none follows that before it: by comparing each
  // with each, 2e10 comparisons; by now .2 s.
  const std::clock_t begin = std::clock();
  constexpr std::size_t count = 200'000;
  std::vector<double> values(count, 1);
  std::vector<std::string> bands(count, "V");
  Table all = rows(values, bands);
  const auto reducer = make_reducer("histogram:intensity:0:2:1:pose");
  ASSERT_TRUE((*reducer)->take(all));
  Table turned;
  auto poses = cells<std::int64_t>(all, "pose");
  for (std::size_t k = 0; k < count; ++k)
    poses[k] = static_cast<std::int64_t>(k * 77'777 % count);
  turned.add("pose", "", "number", std::move(poses));
  turned.add("intensity", "m2 / sr", "light", std::move(values));
  ASSERT_TRUE((*reducer)->take(turned));
  const auto counts = cells<std::int64_t>((*reducer)->table(), "count");
  ASSERT_EQ(counts.size(), 4 * count);
  EXPECT_EQ(counts[0], 2);
  EXPECT_EQ(counts[4 * (count - 1)], 2);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10);
}

/// log of the mean of normal densities, and (sum w)^2 / sum w^2, by the long way.
std::pair<double, double> likelihood_of(const std::vector<double> &values, double value,
                                        double error) {
  std::vector<long double> logs;
  for (const double one : values)
    if (!std::isnan(one))
      logs.push_back(-std::pow((static_cast<long double>(one) - value) / error, 2) / 2);
  const long double most = *std::ranges::max_element(logs);
  long double sum = 0, squares = 0;
  for (const long double one : logs) {
    sum += std::exp(one - most);
    squares += std::exp(2 * (one - most));
  }
  const long double area = error * std::sqrt(2 * std::acos(-1.0L));
  return {
      static_cast<double>(std::log(sum / static_cast<long double>(values.size()) / area) + most),
      static_cast<double>(sum * sum / squares)};
}

TEST(Reductions, SumLikelihoodsExactlyHoweverTheRowsAreCut) {
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 6000; ++k)
    values.push_back(k % 100 == 7 ? nan : static_cast<double>((k * 2'654'435'761U) % 10'007) / 1e4);
  const Table all = rows(values, std::vector<std::string>(values.size(), "V"));
  // In the middle of the values, at their edge, and so far away that no density is a double.
  for (const auto &[value, error] : {std::pair{0.3, 0.002}, {1.01, 0.01}, {400.0, 0.5}}) {
    const std::string text =
        "likelihood:intensity:" + std::to_string(value) + ":" + std::to_string(error);
    const auto [log_likelihood, effective] = likelihood_of(values, value, error);
    const std::string whole = to_ecsv(kept(text, all, 0));
    for (const std::size_t cut : {1, 777, 3000, 6000}) {
      const Table table = kept(text, all, cut);
      EXPECT_EQ(to_ecsv(table), whole) << text << " cut at " << cut;
      EXPECT_EQ(table.columns().size(), 4u);
      EXPECT_EQ(table.number("count", 0), 6000);
      // 1e-12: exponents up to 3.2e5 are rounded to 1e-16 of themselves before exp takes them.
      EXPECT_NEAR(table.number("log_likelihood", 0), log_likelihood,
                  1e-12 * std::abs(log_likelihood));
      EXPECT_NEAR(table.number("effective_rows", 0), effective, 1e-9 * effective);
    }
  }
}

TEST(Reductions, OfTwoMeasuredValuesAreOfBothInARow) {
  Table two = rows({1, 2, nan}, {"V", "V", "V"});
  two.add("q", "", "", std::vector<double>{0.1, 0.3, 0.1});
  const Table table = kept("likelihood:intensity+q:1+0.1:1+0.1", two, 1);
  // Of three rows: the values themselves, one and two standard deviations beside them, none.
  const double area = 0.1 * 2 * std::acos(-1);
  EXPECT_NEAR(table.number("log_likelihood", 0), std::log((1 + std::exp(-0.5 - 2.0)) / 3 / area),
              1e-14);
  EXPECT_EQ(reduced_name("likelihood:intensity+q:1+0.1:1+0.1"), "likelihood_intensity_q");
  const Table none = kept("likelihood:intensity:1:1", rows({nan}, {"V"}), 1);
  EXPECT_TRUE(std::isnan(none.number("log_likelihood", 0)));
}

TEST(Reductions, OfRowsThatAreAllTooFarOffAreMinusInfinity) {
  // Two rows 5 million standard deviations off, one without a value; with a near one it alone.
  const std::string text = "likelihood:intensity:6:1e-6";
  const std::vector<std::string> bands(4, "V");
  for (const std::size_t cut : {0, 1, 2, 3}) {
    const Table far = kept(text, rows({1, nan, 1}, {"V", "V", "V"}), std::min<std::size_t>(cut, 3));
    EXPECT_EQ(far.number("log_likelihood", 0), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(far.number("effective_rows", 0)));
    EXPECT_EQ(far.number("count", 0), 3);
    const Table near = kept(text, rows({1, 6, nan, 1}, bands), cut);
    // 1e-14: the logarithms of a quarter and of the area are rounded.
    EXPECT_NEAR(near.number("log_likelihood", 0),
                -std::log(4 * 1e-6 * std::sqrt(2 * std::acos(-1))), 1e-14);
    EXPECT_EQ(near.number("effective_rows", 0), 1);
  }
}

TEST(Reductions, RestOnRowsUpToAMillionStandardDeviationsOff) {
  // Both rows alike: two, however far they are, as long as they count at all (exponent -7.2e11,
  // whose square has twice that).
  const Table table = kept("likelihood:intensity:1:1", rows({1'200'001, 1'200'001}, {"V", "V"}), 1);
  EXPECT_NEAR(table.number("log_likelihood", 0), -7.2e11, 1);
  // 1e-3: such exponents are doubles to 1e-4.
  EXPECT_NEAR(table.number("effective_rows", 0), 2, 1e-3);
}

TEST(Reductions, ThatWouldBeOfTooManyGroupsSayOfHowMany) {
  constexpr std::size_t count = 100'001;
  const auto done =
      (*make_reducer("likelihood:intensity:1:1:pose"))
          ->take(rows(std::vector<double>(count, 1), std::vector<std::string>(count, "V")));
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("more than 100000 rows"), std::string::npos)
      << done.error().message;
}

TEST(Reductions, HaveExponentsWithASign) {
  Table two = rows({12, 20}, {"V", "V"});
  two.add("q", "", "", std::vector<double>{0.1, 0.3});
  EXPECT_EQ(kept("likelihood:intensity+q:1e+1+-1E+0:2e+0+1", two, 1).number("log_likelihood", 0),
            kept("likelihood:intensity+q:10+-1:2+1", two, 1).number("log_likelihood", 0));
  EXPECT_TRUE(make_reducer("likelihood:intensity:1e+1:1e+0"));
  EXPECT_FALSE(make_reducer("likelihood:intensity:1e+:1"));
}

TEST(Reductions, OfWhatNoShardKeptAreRefused) {
  const std::string text = "likelihood:intensity:1:1";
  const auto reducer = make_reducer(text);
  EXPECT_FALSE((*reducer)->join(some_rows()));
  const auto other = make_reducer("histogram:intensity:0:1:2");
  ASSERT_TRUE((*other)->take(some_rows()));
  EXPECT_FALSE((*reducer)->join((*other)->kept()));
  for (const char *sums : {"0 0", "a 0 1;", "0 0 18014398509481984;", "0 -1 1;", "0 0 0;",
                           "9223372036854775807 0 1;", "-1 0 1;", "0 9007199254740993 0;"}) {
    const auto kept_by = make_reducer(text);
    ASSERT_TRUE((*kept_by)->take(some_rows()));
    Table bad = (*kept_by)->kept();
    bad.remove("_sum");
    bad.add("_sum", "", "", std::vector<std::string>(2, sums));
    EXPECT_FALSE((*reducer)->join(bad)) << sums;
  }
}

TEST(Reductions, ThatWouldFillTheMemoryAreRefusedByName) {
  const Table ten = rows(std::vector<double>(11, 1), std::vector<std::string>(11, "V"));
  const auto histogram = make_reducer("histogram:intensity:0:2:1000000:pose");
  const auto done = (*histogram)->take(ten);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::BadInput);
  EXPECT_NE(done.error().message.find("histogram:intensity:0:2:1000000:pose"), std::string::npos);
  EXPECT_NE(done.error().message.find("10000000 rows"), std::string::npos);
}

TEST(Reductions, WhoseNumbersAreNoneAreRefused) {
  for (const char *text :
       {"histogram:x:-1e308:1e308:4", "log-histogram:x:1e-300:1e300:4",
        "histogram:x:1:1.0000000000000002:4", "log-histogram:x:1:1.000000000000001:100",
        "histogram:x:0:inf:4", "histogram:x:0:nan:4", "likelihood:x:1:0", "likelihood:x:1",
        "likelihood:x+y:1:1", "likelihood:x:nan:1", "likelihood:x:1:inf"})
    EXPECT_FALSE(make_reducer(text)) << text;
  EXPECT_TRUE(make_reducer("histogram:x:-1e307:1e307:1000000"));
}

TEST(Reductions, OfNoRowHaveTheirColumns) {
  const auto most = make_reducer("most:intensity:2");
  ASSERT_TRUE((*most)->take(some_rows().part(0, 0)));
  EXPECT_EQ((*most)->table().columns().size(), 3u);
  const auto histogram = make_reducer("histogram:intensity:0:1:2");
  ASSERT_TRUE((*histogram)->take(some_rows().part(0, 0)));
  EXPECT_EQ((*histogram)->table().rows(), 0u);
  EXPECT_NE((*histogram)->table().find("band"), nullptr);
}

TEST(Reductions, ThatMeanOneTableTwiceAreRefused) {
  EXPECT_EQ(reduced_name("log-histogram:q_scat:0:1:5"), "log_histogram_q_scat");
  EXPECT_TRUE(check_reductions({"most:intensity:5", "least:intensity:5"}));
  EXPECT_FALSE(check_reductions({"most:intensity:5", "most:intensity:6"}));
}

} // namespace
} // namespace umov::scale
