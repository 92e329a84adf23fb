#include <umov/scale/reduction.h>

#include "scale/grouped_reducer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

namespace umov::scale {
namespace {

/// Hands the rows of the first table to all who keep something of them.
class KeptRows final : public jobs::RangeSink {
public:
  KeptRows(std::vector<std::unique_ptr<Reducer>> &to, std::string by, jobs::RangeSink &sink)
      : to_(to), by_(std::move(by)), sink_(sink) {}
  Result<void> add(std::size_t table, Table &&rows) override {
    if (table != 0)
      return {};
    const std::vector<double> order =
        by_.empty() ? std::vector<double>{} : hidden(rows, by_.c_str());
    rows.remove(by_);
    for (const auto &one : to_)
      UMOV_TRY(one->take(rows, order));
    return {};
  }
  void tally(const std::vector<std::size_t> &counts) override { sink_.tally(counts); }

private:
  std::vector<std::unique_ptr<Reducer>> &to_;
  const std::string by_; ///< RangedJob::order
  jobs::RangeSink &sink_;
};

class Reduced final : public jobs::RangedJob {
public:
  Reduced(std::unique_ptr<jobs::RangedJob> job, std::vector<std::string> texts)
      : job_(std::move(job)), texts_(std::move(texts)) {}
  [[nodiscard]] std::string unit() const override { return job_->unit(); }
  [[nodiscard]] std::size_t total() const override { return job_->total(); }
  [[nodiscard]] std::size_t grain() const override { return job_->grain(); }
  [[nodiscard]] bool is_reduced() const override { return true; }
  [[nodiscard]] std::string identity() const override {
    return job_->identity() + fmt::format("reduced to {}\n", fmt::join(texts_, " and "));
  }
  [[nodiscard]] std::vector<std::size_t> layout() const override { return job_->layout(); }
  [[nodiscard]] std::vector<std::string> tables() const override {
    std::vector<std::string> out;
    for (const std::string &text : texts_)
      out.push_back(reduced_name(text));
    return out;
  }
  [[nodiscard]] std::string nothing() const override { return job_->nothing(); }
  [[nodiscard]] std::vector<std::string> warnings() const override { return job_->warnings(); }
  [[nodiscard]] std::vector<jobs::Tally> tallies() const override { return job_->tallies(); }
  Result<void> rows(jobs::IndexRange range, jobs::RangeSink &sink, const jobs::Monitor &monitor,
                    Diagnostics &diagnostics) override {
    std::vector<std::unique_ptr<Reducer>> all;
    for (const std::string &text : texts_) {
      UMOV_ASSIGN(one, make_reducer(text));
      all.push_back(std::move(one));
    }
    KeptRows kept(all, job_->order(), sink);
    UMOV_TRY(job_->rows(range, kept, monitor, diagnostics));
    for (std::size_t k = 0; k < all.size(); ++k)
      UMOV_TRY(sink.add(k, all[k]->kept()));
    return {};
  }
  [[nodiscard]] Result<void> keep() override { return job_->keep(); }

private:
  std::unique_ptr<jobs::RangedJob> job_;
  std::vector<std::string> texts_;
};

} // namespace

Result<std::unique_ptr<Reducer>> make_reducer(const std::string &text) {
  UMOV_ASSIGN(wanted, read_wanted(text));
  if (wanted.kind == Kind::Histogram || wanted.kind == Kind::LogHistogram)
    return make_histogram(std::move(wanted), text);
  if (wanted.kind == Kind::Likelihood)
    return make_likelihood(std::move(wanted), text);
  return make_extremes(std::move(wanted), text);
}

Result<std::unique_ptr<jobs::RangedJob>> reduced_job(std::unique_ptr<jobs::RangedJob> job,
                                                     const std::vector<std::string> &texts) {
  UMOV_TRY(check_reductions(texts));
  if (texts.empty())
    return std::move(job);
  if (!job->problems().empty())
    return fail(ErrorCode::Usage,
                "--reduce: the rows of this verb are answers of curves, which are few and kept "
                "whole. Leave it out.");
  return std::make_unique<Reduced>(std::move(job), texts);
}

} // namespace umov::scale
