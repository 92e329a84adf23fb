#pragma once
// Counts back to Stokes parameters with their errors.

#include <optional>
#include <span>
#include <umov/io/counts_file.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/reduction/calibration.h>
#include <umov/reduction/stokes_fit.h>

namespace umov::jobs {

/// B - V of the Sun, and of what is grey in its light: Ramirez et al. 2012 (ApJ 752, 5).
inline constexpr double solar_colour = 0.653;

/// How counts are reduced.
struct ReduceOptions {
  /// Brightness as a Fourier series of this period [s], with q, u (and v) that stay: for sequences
  /// of a tumbling object. 0: every set by itself.
  double period_s = 0;
  int harmonics = 3;
  /// The same with splines, knots this far apart [s], where there is no period. 0: none.
  double knot_s = 0;
  ErrorPriors priors; ///< of the instrument, beside the scintillation that the file tells
  /// Relative standard deviation of each exposure's transparency beside scintillation: thin cloud,
  /// one for all pupils.
  double transparency_sd = 0;
  /// In which it changes by that [s]: exposures share it as exp(-dt/this). 0: as the header's
  /// `cloud_time_s` has it; without one each exposure has its own.
  double transparency_time_s = 0;
  /// Relative standard deviation of the share of the light in each exposure's apertures.
  double aperture_sd = 0;
  double zero_sd_mag = 0; ///< of the zero point, the same in the whole run
  std::optional<PolarimeterCalibration> calibration; ///< its offset and factor are taken out
  /// Zero point, extinction and colour term take the place of those in w0.
  std::optional<PhotometricCalibration> photometry;
  /// Of the object, in the index of the standards; absent: that of the Sun, with a warning where it
  /// matters.
  std::optional<double> colour;
  unsigned threads = 0;
};

/// An error of ReduceOptions that users say, under one name in every language.
struct ReducePrior {
  const char *name; ///< "q0_sd"; an option is --q0-sd
  const char *text; ///< one line
  double unit;      ///< of what users give, in that of the options
  double &(*of)(ReduceOptions &);
};
/// All of them.
std::span<const ReducePrior> reduce_priors();

/// One row per set (or per band, with a period): Stokes parameters, degree and angle with errors,
/// intervals and tests. BadInput where no set can be solved.
Result<Table> reduce(const CountsFile &counts, const ReduceOptions &options, const Monitor &monitor,
                     Diagnostics &diagnostics);

/// A page of plots of that table: the q-u plane with ellipses, degree with its intervals,
/// brightness, and how well the fits do. Internal if this build has no plotting script.
Result<std::string> stokes_page(const Table &stokes, const std::string &title,
                                const Diagnostics &diagnostics);

} // namespace umov::jobs
