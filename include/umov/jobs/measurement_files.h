#pragma once
// Reduced light in the forms in which others take it.

#include <map>
#include <string>
#include <umov/io/counts_file.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// What is told beside the table.
struct MeasurementNotes {
  std::map<std::string, std::string> notes; ///< of the counts: site, norad, instrument
  std::string ecsv;        ///< file that holds the Stokes parameters, which a TDM has no words for
  std::string created_utc; ///< clock time given by the caller
};

/// Magnitudes and directions as a Tracking Data Message (CCSDS 503.0-B-2), a segment for each
/// object and band. BadInput where no row has a magnitude.
Result<std::string> as_tdm(const Table &stokes, const MeasurementNotes &notes);
/// Magnitudes as the observation table of SCORE, the repository of the IAU's Centre for the
/// Protection of the Dark and Quiet Sky (columns of its template, 2024). BadInput without the site.
Result<Table> as_score(const Table &stokes, const MeasurementNotes &notes);
/// The same as the repository takes it: CSV without a header.
Result<std::string> score_text(const Table &stokes, const MeasurementNotes &notes);

} // namespace umov::jobs
