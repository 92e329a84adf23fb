#pragma once
// What is kept of a job's rows where they are made faster than they can be stored: histograms, the
// most of them, likelihoods.

#include <memory>
#include <span>
#include <string>
#include <umov/jobs/ranged_job.h>
#include <vector>

namespace umov::scale {

/// Takes rows block by block and keeps what is asked for. Whatever the blocks, and whatever was put
/// together before, the same rows in the same order give the same table.
class Reducer {
public:
  virtual ~Reducer() = default;
  /// Rows of the first table of a job, and what they are put in order by in the whole of it (those
  /// of the same as they come); no order: they stand as they come. Usage for columns that they do
  /// not have.
  virtual Result<void> take(const Table &rows, std::span<const double> order = {}) = 0;
  /// What another one kept of the rows behind those that were taken. BadInput for another table.
  virtual Result<void> join(const Table &kept) = 0;
  /// How many rows were taken, by those that were joined too.
  [[nodiscard]] virtual std::size_t rows() const = 0;
  /// What is kept so far, with the order of the rows, for another one to join.
  [[nodiscard]] virtual Table kept() = 0;
  /// What is kept so far, as it is shown.
  [[nodiscard]] virtual Table table() = 0;
};

/// Of a text as the command line has it: "histogram:COLUMN:LOW:HIGH:BINS" (bins of one width, LOW
/// belongs to the first, HIGH to none), "log-histogram:..." (of one ratio), "most:COLUMN:COUNT" or
/// "least:COLUMN:COUNT" (whole rows, ordered by that column, earlier ones first where it is the
/// same), "likelihood:COLUMN+COLUMN:VALUE+VALUE:ERROR+ERROR" (logarithm of the mean over the rows
/// of the normal density of measured values, summed exactly). All are of each band apart where the
/// rows have a column of that name; ":BY" or ":BY+BY" behind them names other columns. Usage for
/// another text.
Result<std::unique_ptr<Reducer>> make_reducer(const std::string &text);
/// The name of its table: "log_histogram_intensity".
std::string reduced_name(const std::string &text);
/// Checks that each text is one and that their tables differ; Usage.
Result<void> check_reductions(const std::vector<std::string> &texts);

/// The same job with these in place of its rows. Usage for a job whose rows are answers, which are
/// few.
Result<std::unique_ptr<jobs::RangedJob>> reduced_job(std::unique_ptr<jobs::RangedJob> job,
                                                     const std::vector<std::string> &texts);

} // namespace umov::scale
