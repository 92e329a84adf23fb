#pragma once
// Counts of an observation in a file: of umov observe, or of anybody's pipeline.

#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <umov/core/diagnostics.h>
#include <umov/core/result.h>
#include <umov/instrument/mueller.h>
#include <umov/time/epoch.h>
#include <vector>

namespace umov {

/// One channel of one exposure.
struct CountRow {
  Epoch<Utc> time{};
  std::int64_t exposure = 0, set = 0;
  std::string name, band, channel;
  double counts = 0, sky = 0, sky_err = 0, var_read = 0, excess2 = 1;
  double scintillation = 0; ///< relative standard deviation of the exposure's transparency
  double x_axis_pa_deg = 0, phase_angle_deg = 0, airmass = 0;
  double pa_scat_deg = std::numeric_limits<double>::quiet_NaN(); ///< as the header's pol_frame
  double plate_deg = 0;
  double analyser_deg = std::numeric_limits<double>::quiet_NaN(); ///< from the x axis; the fit
                                                                  ///< takes the row
  double retardance_deg = 180;                                    ///< of the plate, by the header
  double turn_deg_s = 0; ///< of x_axis_pa, where somebody has worked it out: no column
  double k_mag = std::numeric_limits<double>::quiet_NaN(); ///< extinction [mag per air mass]
  double ra_deg = std::numeric_limits<double>::quiet_NaN(), dec_deg = ra_deg,
         range_km = ra_deg; ///< of the object
  bool is_saturated = false;
  StokesRow row{};
};

/// A file of counts.
struct CountsFile {
  std::vector<CountRow> rows;
  std::map<std::string, std::string> notes; ///< of its header
};

/// Reads ECSV (blank-separated), CSV or a FITS table with the columns time_utc, set_id, band,
/// counts, sky, sky_err, var_read, w0, w1, w2 and w3; of the others those that are there. Rows
/// whose counts are no number are left out with a warning. BadInput with line and column for what
/// is missing, a negative variance and times that go back; a warning where analyser_deg is told and
/// w1, w2 are those of another angle.
Result<CountsFile> read_counts_text(std::string_view text, const std::string &file,
                                    Diagnostics &diagnostics);

} // namespace umov
