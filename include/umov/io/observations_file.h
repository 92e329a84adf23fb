#pragma once
// Light curves as observers have them: of umov reduce, of umov run, or of anybody's pipeline.

#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/io/counts_file.h>
#include <umov/lightcurve/compute.h>
#include <umov/time/epoch.h>
#include <vector>

namespace umov {

/// One band at one time, as it was measured. NaN: not measured.
struct ObservedRow {
  Epoch<Utc> time{};
  std::string band, site; ///< "": the file does not say
  double flux = std::numeric_limits<double>::quiet_NaN();
  double flux_err = std::numeric_limits<double>::quiet_NaN();
  double mag = std::numeric_limits<double>::quiet_NaN(); ///< where there is no flux
  double mag_err = std::numeric_limits<double>::quiet_NaN();
  double mag_beside = std::numeric_limits<double>::quiet_NaN(); ///< where there is a flux too
  bool is_limit = false; ///< of brightness: the object is fainter, and what `flux` holds is less
  double q = std::numeric_limits<double>::quiet_NaN(); ///< fractions of I, in the file's frame
  double u = std::numeric_limits<double>::quiet_NaN();
  double cov_qq = std::numeric_limits<double>::quiet_NaN();
  double cov_uu = std::numeric_limits<double>::quiet_NaN();
  double cov_qu = 0;
  std::int64_t set = -1; ///< of counts that it was reduced from; -1: the file does not say
  std::size_t line = 0;
};

/// A file of observations.
struct ObservationsFile {
  std::string path;
  std::vector<ObservedRow> rows;            ///< in order of time
  PolarizationFrame frame{};                ///< of q and u
  bool is_absolute = false;                 ///< fluxes are irradiances [W m-2 nm-1]
  std::map<std::string, std::string> notes; ///< of its header
  /// What `rows` were reduced from, without saturated ones; none: a file of light curves.
  std::vector<CountRow> counts;
  bool has_separate_pupils = false; ///< of the channels of those
};

/// One measurement per time, band and site: two would contradict each other or be one, twice.
/// BadInput with both lines; rows in order of time, band and site.
Result<void> check_no_row_twice(const ObservationsFile &out);

/// Reads ECSV (blank-separated), CSV or the first table of a FITS file, whose notes are COMMENT
/// cards and whose rows stand for lines in messages. Columns by name: time_utc or mjd_utc; band; I,
/// I_obs or flux (the first that is there) with I_err or flux_err, else mag with mag_err; q, u with
/// cov_qq, cov_uu, cov_qu or q_err, u_err (q_scat and u_scat where there are no q, u); site; flags.
/// Others are ignored. Empty cells and "nan" are gaps. q and u stand in `pol_frame` of the header.
/// Rows whose flags say "saturated" and those without any measurement are left out with a warning.
/// BadInput with line and column for what cannot be read, a negative error, more than one object,
/// and two rows of one time, band and site.
Result<ObservationsFile> read_observations_text(std::string_view text, const std::string &file,
                                                Diagnostics &diagnostics);

} // namespace umov
