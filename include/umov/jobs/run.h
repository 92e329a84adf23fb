#pragma once
// The main job: light curves of the objects of a scenario, and the folder that tells of them.

#include <memory>
#include <optional>
#include <umov/core/journal.h>
#include <umov/io/run_folder.h>
#include <umov/io/table.h>
#include <umov/jobs/monitor.h>
#include <umov/jobs/requests.h>
#include <umov/lightcurve/compute.h>

namespace umov::jobs {

/// One object of the run: what it is, what was asked and what came of it.
struct ObjectRun {
  LoadedObject object;
  LightCurveRequest request;
  LightCurveOutcome outcome;
  LightFacts light; ///< how it was lit
  /// The passes of it that are wanted; absent: all.
  std::optional<IndexRange> passes = {};
  /// The epochs of all of them, where they are known already.
  std::shared_ptr<const KeptEpochs> kept = {};
};

/// What a run computed.
struct RunResult {
  std::vector<ObjectRun> objects; ///< those with rows
  std::optional<Error> stopped;   ///< Physics or Interrupted: rows before it are complete
  bool has_all_csv_digits = false;
  Journal journal; ///< of the finished blocks: goes when the folder of a whole run is written
};

/// Reads what the scenario names and checks it; nothing is computed.
Result<std::vector<ObjectRun>> load_run(const Scenario &scenario, const JobOptions &options,
                                        const Monitor &monitor, Diagnostics &diagnostics);

/// Object after object, or of their passes those that JobOptions::part has; the first stop ends it,
/// with the rows so far kept. What the same run finished before it was ended is taken from
/// JobOptions::journal: the same bytes. Nothing if there is no row at all, with the next pass that
/// would give one; warnings tell of rows that missed the accuracy.
Result<RunResult> compute_run(std::vector<ObjectRun> objects, const Scenario &scenario,
                              const JobOptions &options, const Monitor &monitor,
                              Diagnostics &diagnostics);

/// The rows of a run.
struct RunTables {
  Table light_curve, passes;
};
/// Those of all objects, one object after the other: what the files of its folder hold.
RunTables run_tables(const RunResult &run);
/// Adds those of one object.
void append_tables(const ObjectRun &object, RunTables &tables);

/// Tables, reports, locked scenario, log and manifest (`manifest` holds what the caller knows of
/// the command; inputs, seed, warnings and method are added), put in place at once.
Result<void> write_run(RunResult &run, const Scenario &scenario, const JobOptions &options,
                       ManifestInput manifest, const Diagnostics &diagnostics, RunFolder &folder);

/// Passes with brightness and polarization, as lines for a person.
std::string summarize(const LightCurveOutcome &outcome);
/// The same as a JSON object: name, norad_cat_id, epochs, dark, bands, passes with pass_id,
/// alt_max, phase_min, phase_max, mag_min, mag_max (null where nothing is known), has_limit, p_max.
std::string summary_json(const LightCurveOutcome &outcome);

} // namespace umov::jobs
