#pragma once
// Libraries of signatures.

#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <vector>

namespace umov::jobs {

/// How signatures are made.
struct LibraryRequest {
  std::vector<std::string> scenarios; ///< one object each; its name is the file's without suffix
  std::string folder;
  std::size_t cells = 20; ///< of the grid of directions, a side: 97,461 poses
  /// Of `scenarios`, those from `first` on, `count` at most: machines that share the work name the
  /// same list.
  std::size_t first = 0, count = static_cast<std::size_t>(-1);
};

/// What happened to each object of the range.
struct LibraryBuilt {
  Table table; ///< name, poses, error, abundances, state ("made", "recoloured", "was there")
};

/// Makes NAME.umovsig for each scenario, whole or not at all; one that is there and was made from
/// the same inputs stays, so that a build that was ended goes on. Where a file's abundances serve
/// the new materials, only its colours are made anew. Usage for two scenarios of one name;
/// Interrupted after a stop, with the finished ones kept.
Result<LibraryBuilt> build_library(const LibraryRequest &request, const JobOptions &options,
                                   const Monitor &monitor, Diagnostics &diagnostics);

} // namespace umov::jobs
