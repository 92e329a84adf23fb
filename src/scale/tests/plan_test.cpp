// What a job will cost, told from some of it: of jobs whose cost is known because they spend it.

#include <ctime>
#include <gtest/gtest.h>
#include <set>
#include <umov/scale/plan.h>

namespace umov::scale {
namespace {

double cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void spend(double seconds) {
  for (const double until = cpu_s() + seconds; cpu_s() < until;) {
  }
}

/// As if by chance.
std::size_t scattered(std::uint64_t k) {
  k = (k + 1) * 0x9E3779B97F4A7C15U;
  k = (k ^ (k >> 30U)) * 0xBF58476D1CE4E5B9U;
  return k ^ (k >> 31U);
}

/// Every row costs the same, and the first of each of its directions costs more.
class Spending final : public jobs::RangedJob {
public:
  Spending(std::size_t total, double row_s, std::size_t directions, double direction_s)
      : total_(total), directions_(directions), row_s_(row_s), direction_s_(direction_s) {}
  [[nodiscard]] std::string unit() const override { return "rows"; }
  [[nodiscard]] std::size_t total() const override { return total_; }
  [[nodiscard]] std::size_t grain() const override { return 1024; }
  [[nodiscard]] std::string identity() const override { return "spending"; }
  [[nodiscard]] std::vector<std::string> tables() const override { return {"rows"}; }
  Result<void> rows(jobs::IndexRange range, jobs::RangeSink &sink, const jobs::Monitor &,
                    Diagnostics &) override {
    std::size_t learnt = 0;
    asked_ += range.count;
    for (std::size_t k = range.first; directions_ > 0 && k < range.end(); ++k)
      learnt += known_.insert(scattered(k) % directions_).second ? 1U : 0U;
    spend(static_cast<double>(learnt) * direction_s_ + static_cast<double>(range.count) * row_s_);
    Table out;
    out.add("x", "m", "a number", std::vector<double>(range.count, 1.0));
    return sink.add(0, std::move(out));
  }
  /// What all of it costs.
  [[nodiscard]] double all_s() const {
    return static_cast<double>(total_) * row_s_ + static_cast<double>(directions_) * direction_s_;
  }
  /// Rows that were asked for, each as often as it was.
  [[nodiscard]] std::size_t asked() const { return asked_; }

private:
  std::size_t total_, directions_, asked_ = 0;
  double row_s_, direction_s_;
  std::set<std::size_t> known_;
};

double predicted(Spending &job, const Rate &rate) {
  JobLock lock;
  lock.total = job.total();
  lock.per_shard = 1024;
  lock.rate = rate;
  return 3600 * plan_of(lock, {2, 1, 0}).core_hours;
}

TEST(Plans, CountWhatIsLearntOnceApartFromEveryRow) {
  Spending job(200'000, 20e-6, 500, 2e-3); // 4 s of rows, 1 s that the first of them need
  const auto rate = measure(job, 0, {});
  ASSERT_TRUE(rate) << rate.error().text();
  EXPECT_NEAR(rate->cpu_s, 20e-6, 0.1 * 20e-6);
  EXPECT_NEAR(rate->once_cpu_s, 1.0, 0.15);
  EXPECT_NEAR(predicted(job, *rate), job.all_s(), 0.1 * job.all_s());
  EXPECT_NEAR(rate->bytes, 8, 1e-9);
}

TEST(Plans, SeeTheEndOfWhatIsLearntBeforeItIsReached) {
  Spending job(4000, 1e-3, 400, 5e-3); // 450 rows of a trial know two thirds of the directions
  const auto rate = measure(job, 0, {});
  ASSERT_TRUE(rate) << rate.error().text();
  EXPECT_NEAR(rate->once_cpu_s, 2.0, 0.4);
  EXPECT_NEAR(predicted(job, *rate), job.all_s(), 0.15 * job.all_s());
}

TEST(Plans, OfRowsThatLearnNothingAskForThemOnce) {
  Spending job(1'000'000, 50e-6, 0, 0);
  const double before = cpu_s();
  const auto rate = measure(job, 0, {});
  ASSERT_TRUE(rate) << rate.error().text();
  EXPECT_LT(cpu_s() - before, 5); // a second or two is what is promised
  EXPECT_NEAR(predicted(job, *rate), job.all_s(), 0.1 * job.all_s());
}

TEST(Plans, SeeWhatIsLearntWhereItIsNearlyAll) {
  Spending job(2000, 1e-4, 300, 1e-2); // 3 s of what is learnt beside .2 s of rows
  const auto rate = measure(job, 0, {});
  ASSERT_TRUE(rate) << rate.error().text();
  EXPECT_NEAR(rate->cpu_s, 1e-4, 0.5e-4);
  EXPECT_NEAR(predicted(job, *rate), job.all_s(), 0.3 * job.all_s());
}

/// As curves that are answered one by one: one is a quarter of the job and more.
TEST(Plans, OfAFewDearRowsAskForOne) {
  Spending job(3, 1.5, 0, 0);
  const auto rate = measure(job, 0, {});
  ASSERT_TRUE(rate) << rate.error().text();
  EXPECT_EQ(job.asked(), 1U);
  EXPECT_NEAR(predicted(job, *rate), job.all_s(), 0.1 * job.all_s());
}

} // namespace
} // namespace umov::scale
