#pragma once
// Where objects stand: one as seen from a site, or all of a catalogue.

#include <optional>
#include <string>
#include <umov/core/diagnostics.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <umov/orbit/ephemeris.h>
#include <umov/orbit/sgp4.h>
#include <vector>

namespace umov::jobs {

/// Rows, and why there are not more or not better ones.
struct TableOutcome {
  Table table;
  bool is_partial = false;    ///< rows are missing, for the reason that `error` gives
  std::optional<Error> error; ///< of a whole table: no row of it is good
};

/// One object, a site and a span.
struct EphemerisRequest {
  std::string orbit; ///< file of elements or of an ephemeris
  int norad = 0;     ///< 0: the only object of the file
  Site site;
  Epoch<Utc> start{}, stop{};
  double step_s = 60;
  ShadowModel shadow = ShadowModel::Ellipsoid;
  bool keep_going = false; ///< bad sets of the file are reported, the others kept
};

/// One object from a site, a row per epoch. Partial after a stop, and where the orbit ends.
Result<TableOutcome> ephemeris(const EphemerisRequest &request, const JobOptions &options,
                               const Monitor &monitor, Diagnostics &diagnostics);

/// A catalogue and the times at which its states are wanted.
struct StatesRequest {
  std::string orbit; ///< file of elements
  std::vector<Epoch<Utc>> times;
  bool keep_going = false; ///< bad sets of the file are reported, the others kept
};

/// States of a catalogue: [object * times + time].
struct CatalogueStates {
  std::vector<int> norad_cat_id; ///< per object
  std::vector<TemeState> states; ///< NaN where SGP4 gives none
  std::vector<Sgp4Code> codes;   ///< why there is none
  std::vector<char> is_done;     ///< 0 where a stop came first
  bool is_partial = false;       ///< some are not done
  std::optional<Error> error;    ///< Interrupted, or Physics if every one failed
};

/// TEME states of every object at every time as numbers; warns of the first that fail.
Result<CatalogueStates> propagate_catalogue(const StatesRequest &request, const JobOptions &options,
                                            const Monitor &monitor, Diagnostics &diagnostics);
/// The same as a table, object by object; those that SGP4 cannot give are
/// empty, with its code. Partial after a stop; Physics with a whole table if every one failed.
Result<TableOutcome> catalogue_states(const StatesRequest &request, const JobOptions &options,
                                      const Monitor &monitor, Diagnostics &diagnostics);

} // namespace umov::jobs
