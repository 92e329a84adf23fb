#include "scale_job.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/scale/reduction.h>

namespace umov::cli {
namespace {

/// A job whose rows depend on one more file.
class WithFile final : public jobs::RangedJob {
public:
  WithFile(std::unique_ptr<jobs::RangedJob> job, const std::string &file,
           const std::string &contents)
      : job_(std::move(job)),
        identity_(job_->identity() + fmt::format("{} {}\n", sha256_hex(contents), file)) {}
  [[nodiscard]] std::string unit() const override { return job_->unit(); }
  [[nodiscard]] std::size_t total() const override { return job_->total(); }
  [[nodiscard]] std::size_t grain() const override { return job_->grain(); }
  [[nodiscard]] std::string identity() const override { return identity_; }
  [[nodiscard]] std::vector<std::size_t> layout() const override { return job_->layout(); }
  [[nodiscard]] std::vector<std::string> tables() const override { return job_->tables(); }
  [[nodiscard]] std::string order() const override { return job_->order(); }
  [[nodiscard]] std::string nothing() const override { return job_->nothing(); }
  [[nodiscard]] std::string problems() const override { return job_->problems(); }
  [[nodiscard]] bool is_reduced() const override { return job_->is_reduced(); }
  [[nodiscard]] std::vector<std::string> warnings() const override { return job_->warnings(); }
  [[nodiscard]] std::vector<jobs::Tally> tallies() const override { return job_->tallies(); }
  Result<void> rows(jobs::IndexRange range, jobs::RangeSink &sink, const jobs::Monitor &monitor,
                    Diagnostics &diagnostics) override {
    return job_->rows(range, sink, monitor, diagnostics);
  }
  [[nodiscard]] Result<void> keep() override { return job_->keep(); }

private:
  std::unique_ptr<jobs::RangedJob> job_;
  std::string identity_;
};

} // namespace

Result<void> parse_verb(CLI::App &verb, const std::vector<std::string> &arguments) {
  std::vector<std::string> words(arguments.rbegin(), arguments.rend()); // as CLI11 takes them
  try {
    verb.parse(words);
  } catch (const CLI::ParseError &problem) {
    return fail(ErrorCode::Usage,
                fmt::format("{}. See umov {} --help.", problem.what(), verb.get_name()));
  }
  return {};
}

Result<void> refuse_output(const std::string &output, const PartOptions &part) {
  if (!output.empty())
    return fail(ErrorCode::Usage, "-o " + output +
                                      ": the rows of a job in parts go to its folder; umov scale "
                                      "merge FOLDER -o TABLE puts them together");
  if (!part.shard.empty() || !part.range.empty())
    return fail(ErrorCode::Usage,
                "--shard and --range: a job in parts is cut by umov scale itself; "
                "--per-shard says how long its shards are");
  return {};
}

Result<std::unique_ptr<jobs::RangedJob>> verb_in_parts(const std::string &verb,
                                                       const std::vector<std::string> &arguments,
                                                       const PartsSetting &setting,
                                                       Diagnostics &diagnostics) {
  using InParts =
      Result<RangedVerb> (*)(const std::vector<std::string> &, const PartsSetting &, Diagnostics &);
  static const std::map<std::string, InParts> known{{"signature", signature_in_parts},
                                                    {"passes", passes_in_parts},
                                                    {"run", run_in_parts},
                                                    {"observe", observe_in_parts},
                                                    {"invert", invert_in_parts},
                                                    {"identify", identify_in_parts}};
  const auto found = known.find(verb);
  if (found == known.end())
    return fail(ErrorCode::Usage,
                verb + ": signature, passes, run, observe, invert or identify was expected");
  auto made = found->second(arguments, setting, diagnostics);
  if (!made)
    return tl::unexpected(made.error());
  if (made->job->total() == 0)
    return fail(ErrorCode::Nothing, "the job has no " + made->job->unit());
  UMOV_ASSIGN(job, scale::reduced_job(std::move(made->job), setting.reductions));
  if (made->file.empty())
    return std::move(job);
  UMOV_ASSIGN(contents, read_file(made->file));
  return std::make_unique<WithFile>(std::move(job), made->file, contents);
}

} // namespace umov::cli
