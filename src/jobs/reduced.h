#pragma once
// Private: what a set of counts becomes, and the table of it.

#include <array>
#include <limits>
#include <span>
#include <umov/jobs/reduce.h>
#include <umov/reduction/sequence.h>

namespace umov::jobs {

/// A set, reduced.
struct Reduced {
  CountRow middle; ///< name, band and set, and where the light came from in the middle of it
  StokesFit fit;
  StokesFractions fractions;
  std::string flags;
  /// Half the difference of q and of u between the two half turns of a plate.
  std::array<double, 2> null{std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::quiet_NaN()};
  double sky_share = std::numeric_limits<double>::quiet_NaN();
  bool is_solved = false; ///< the fractions say something
};

/// One row for each.
Table stokes_table(const CountsFile &file, std::size_t parameters,
                   std::span<const Reduced> reduced);

} // namespace umov::jobs
