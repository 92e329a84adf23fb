#pragma once
// Private: orbits and models of a search for passes, read once and searched in any ranges.

#include "jobs/pass_models.h"

#include <umov/jobs/passes.h>

namespace umov::jobs {

/// How a search went.
struct SearchTally {
  std::size_t searched = 0, failed = 0; ///< objects
};

/// What came of one.
struct FoundPasses {
  PassesResult result;
  SearchTally tally;
};

/// By what passes are put in order, the least first: seconds from the begin of the span to the
/// rise, or what PassesRequest::order says; 1e300 where a pass has none of it.
double order_of(const PassesRequest &request, const ObjectPass &one);

/// What is said where nothing was found.
std::string no_pass(const PassesRequest &request);

/// Objects that are to be searched.
class PassSearcher {
public:
  static Result<PassSearcher> make(const PassesRequest &request, const JobOptions &options,
                                   Diagnostics &diagnostics,
                                   const std::atomic<bool> *cancel = nullptr);
  [[nodiscard]] std::size_t objects() const { return orbits_.size(); }
  [[nodiscard]] const PassesRequest &request() const { return request_; }
  /// Objects of a range side by side; `stopped` of the result where not all were searched.
  FoundPasses search(IndexRange range, const Monitor &monitor, Diagnostics &diagnostics) const;
  [[nodiscard]] Result<void> keep_masks() const { return models_.keep_masks(); }

private:
  PassesRequest request_;
  unsigned threads_ = 0;
  std::vector<Trajectory> orbits_;
  PassModels models_;
};

} // namespace umov::jobs
