// What is said of a name, where the answer is open and where it is not.

#include "jobs/identify_tables.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace umov::jobs {
namespace {

/// Light that changes by far more than its errors, without q and u.
ObservedCurve changing() {
  ObservedCurve out;
  out.bands = {"a"};
  for (std::size_t e = 0; e < 10; ++e) {
    out.epochs.emplace_back();
    ObservedSample s;
    s.epoch = e;
    s.i = 1 + static_cast<double>(e % 3);
    s.i_sd = 0.01;
    out.samples.push_back(s);
  }
  return out;
}

/// Two objects, the first judged by its own light at chi-square 10 of 10 degrees of freedom, the
/// second left behind by the look; "none of these" has `none`.
IdentityAnswer answer_of(double none) {
  IdentityAnswer out;
  out.candidates.resize(2);
  out.candidates[0].by = JudgedBy::Model;
  out.candidates[0].probability = 1 - none;
  out.candidates[0].answer.chi2 = 10;
  out.candidates[0].answer.measurements = 14;
  out.candidates[0].answer.unknowns = 4;
  out.order = {0, 1};
  out.none = none;
  return out;
}

Verdict verdict(const IdentityAnswer &answer) { return verdict_of(answer, changing(), {}); }

/// Some note of the verdict on an answer holds these words.
bool is_noted(const IdentityAnswer &answer, const std::string &words) {
  const IdentityWords all{{"one", "two"}, {0, 0}, &answer, verdict(answer), {}};
  return std::ranges::any_of(notes_of(all, changing(), {}), [&](const std::string &note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(IdentityWords, ANameIsDeterminedByOwnLightAlone) {
  IdentityAnswer answer = answer_of(0.01);
  EXPECT_EQ(verdict(answer), Verdict::Determined);
  answer.candidates[0].by = JudgedBy::Table;
  EXPECT_EQ(verdict(answer), Verdict::Ambiguous);
}

TEST(IdentityWords, NoneIsTheAnswerOnlyWhereNothingIsOpen) {
  EXPECT_EQ(verdict(answer_of(0.99)), Verdict::NoFit);
  EXPECT_TRUE(is_noted(answer_of(0.99), "by a quick look alone 1 object stayed behind"));
  IdentityAnswer cut = answer_of(0.99), unasked = cut, unsettled = cut;
  cut.is_cut = true;
  EXPECT_EQ(verdict(cut), Verdict::Undetermined);
  EXPECT_TRUE(is_noted(cut, "left out of the search"));
  unasked.unasked = 1;
  EXPECT_EQ(verdict(unasked), Verdict::Undetermined);
  EXPECT_TRUE(is_noted(unasked, "1 more whose scenarios are named were not asked"));
  unsettled.unsettled = 1;
  EXPECT_EQ(verdict(unsettled), Verdict::Undetermined);
  EXPECT_TRUE(is_noted(unsettled, "the search of 1 object in its own light"));
}

TEST(IdentityWords, AFitThatChanceDoesNotExplainIsNoName) {
  // Of chi-square with 10 degrees of freedom the .999 quantile is 29.588 (tables, NIST/SEMATECH
  // e-Handbook 1.3.6.7.4); 1 % to either side for the cube root that stands for it (Wilson &
  // Hilferty 1931).
  IdentityAnswer answer = answer_of(0.01);
  answer.candidates[0].answer.chi2 = 29.588 * 0.99;
  EXPECT_EQ(verdict(answer), Verdict::Determined);
  answer.candidates[0].answer.chi2 = 29.588 * 1.01;
  EXPECT_EQ(verdict(answer), Verdict::Undetermined);
  EXPECT_TRUE(is_noted(answer, "by more than their errors"));
}

TEST(IdentityWords, OneThatWasNotAskedMayLeadButHasNoAttitude) {
  IdentityAnswer answer = answer_of(0.05);
  answer.candidates[0].probability = 0;
  answer.candidates[1].probability = 0.95;
  answer.candidates[1].is_unasked = true;
  answer.unasked = 1;
  answer.order = {1, 0};
  const IdentityWords words{{"one", "two"}, {0, 0}, &answer, verdict(answer), {}};
  EXPECT_EQ(best_searched(answer), 0u);
  EXPECT_EQ(words.verdict, Verdict::Undetermined);
  EXPECT_EQ(std::get<std::vector<std::string>>(identity_table(words).find("by")->cells),
            (std::vector<std::string>{"unasked", "kin", "model"}));
  const std::string json = json_of(words, "");
  EXPECT_NE(json.find("\"best\": \"one\""), std::string::npos);
  EXPECT_EQ(json.find("\"two\""), std::string::npos); // not searched
}

} // namespace
} // namespace umov::jobs
