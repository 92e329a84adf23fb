#pragma once
// Jobs as lists: made ready once, then asked for any range of their indices, with the same rows
// whatever else is asked for.

#include <memory>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>
#include <umov/jobs/index_range.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/passes.h>
#include <umov/jobs/signature.h>
#include <umov/jobs/tallies.h>
#include <vector>

namespace umov::jobs {

/// Takes the rows of a range: for each table of the job its blocks in order.
class RangeSink {
public:
  virtual ~RangeSink() = default;
  /// Rows of table `table` of RangedJob::tables.
  virtual Result<void> add(std::size_t table, Table &&rows) = 0;
  /// How many rows of the range are such as each of RangedJob::tallies tells of.
  virtual void tally(const std::vector<std::size_t> & /*counts*/) {}
};

/// A job that was read, checked and made ready. `rows` may be called any number of times, from one
/// thread at a time.
class RangedJob {
public:
  virtual ~RangedJob() = default;
  /// What is counted, in the plural: "poses".
  [[nodiscard]] virtual std::string unit() const = 0;
  /// How many.
  [[nodiscard]] virtual std::size_t total() const = 0;
  /// Ranges begin at a multiple of it, for speed: their rows are the same anywhere.
  [[nodiscard]] virtual std::size_t grain() const { return 1; }
  /// All that the rows depend on: differs whenever they could.
  [[nodiscard]] virtual std::string identity() const = 0;
  /// What it took to find `total`, so that who has it need not look again.
  [[nodiscard]] virtual std::vector<std::size_t> layout() const { return {}; }
  /// Names of its tables.
  [[nodiscard]] virtual std::vector<std::string> tables() const = 0;
  /// Column of the first table by which rows of all ranges are put in order (stable) and which is
  /// then left out; "": they stand in the order of the indices.
  [[nodiscard]] virtual std::string order() const { return ""; }
  /// What was warned of before the first row and belongs in the header of the first table, as
  /// `warning_1` and on. Of a job whose layout was given, empty: who has that has these.
  [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
  /// What the header tells of the rows by their number, after these warnings.
  [[nodiscard]] virtual std::vector<Tally> tallies() const { return {}; }
  /// What the plain command ends with (Nothing) where the first table has no row at all; "": it
  /// writes that table without rows.
  [[nodiscard]] virtual std::string nothing() const { return ""; }
  /// Column of the first table with the problem of each row that has no answer; "": all have one.
  [[nodiscard]] virtual std::string problems() const { return ""; }
  /// Its tables are what is kept of the rows of a range (umov/scale/reduction.h): as large for a
  /// short one as for a long one, and put together by more than their order.
  [[nodiscard]] virtual bool is_reduced() const { return false; }
  /// The rows of a range, at least one block of each table (without rows if there are none).
  /// Interrupted after a stop.
  virtual Result<void> rows(IndexRange range, RangeSink &sink, const Monitor &monitor,
                            Diagnostics &diagnostics) = 0;
  /// Keeps what was learnt for the next process: masks. Before it is called the first time nothing
  /// is written, as where a job is only measured.
  [[nodiscard]] virtual Result<void> keep() { return {}; }
};

/// `umov signature` by poses. Here and below: Interrupted where `monitor` cancels.
Result<std::unique_ptr<RangedJob>>
ranged_signature(const Scenario &scenario, const PoseList &poses, const SignatureRequest &request,
                 const JobOptions &options, const Monitor &monitor, Diagnostics &diagnostics);
/// `umov passes` by objects.
Result<std::unique_ptr<RangedJob>> ranged_passes(const PassesRequest &request,
                                                 const JobOptions &options, const Monitor &monitor,
                                                 Diagnostics &diagnostics);
/// `umov run` by passes, object after object. `layout` as the job gave it once; empty: the passes
/// are looked for.
Result<std::unique_ptr<RangedJob>> ranged_run(const Scenario &scenario, const JobOptions &options,
                                              const std::vector<std::size_t> &layout,
                                              const Monitor &monitor, Diagnostics &diagnostics);
/// `umov observe` by exposures, object after object. `layout` as for a run. BadInput where it makes
/// frames.
Result<std::unique_ptr<RangedJob>> ranged_observe(const Scenario &scenario,
                                                  const JobOptions &options,
                                                  const std::vector<std::size_t> &layout,
                                                  const Monitor &monitor, Diagnostics &diagnostics);

} // namespace umov::jobs
