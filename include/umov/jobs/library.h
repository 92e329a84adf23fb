#pragma once
// Libraries of signatures, and which of their objects a light curve is of.

#include <umov/jobs/invert.h>

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

/// Which object of the library in `folder` gave the observations, over all its attitudes. The
/// scenario tells orbit, site and bands alone. BadInput for a library that is empty, mixed or lacks
/// a band.
Result<Inversion> identify_object(const Scenario &scenario, const InvertRequest &request,
                                  const std::string &folder, const JobOptions &options,
                                  const Monitor &monitor, Diagnostics &diagnostics);

} // namespace umov::jobs
