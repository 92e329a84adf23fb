#pragma once
// Observations put beside the object that they are of: where it was, and in the model's units.

#include <umov/inverse/observed_curve.h>
#include <umov/io/observations_file.h>
#include <umov/io/scenario.h>
#include <vector>

namespace umov::jobs {

/// A curve with the places of its numbers.
struct ObservedLightCurve {
  ObservedCurve curve;
  std::vector<std::size_t> column; ///< of each band of the curve among those of the scenario
  std::vector<ObservingGeometry> geometry; ///< per epoch
  std::vector<std::string> notes;          ///< what the data cannot tell by themselves
  std::vector<InputFile> inputs;
};

/// Reads files of observations: ECSV, CSV, FITS tables, TDM with magnitudes, and counts; those as
/// their reduced sets where q and u are not asked for (`has_polarization`), since one channel says
/// nothing of I by itself. Counts are reduced on so many threads (0: all).
Result<std::vector<ObservationsFile>> read_observations(const std::vector<std::string> &paths,
                                                        bool has_polarization, unsigned threads,
                                                        std::vector<InputFile> &inputs,
                                                        Diagnostics &diagnostics);

/// Puts them on the scenario's orbit, as seen from its observer or the site that a row names: I in
/// [m2/sr] up to a scale, q and u in the scattering plane. Epochs in the Earth's shadow
/// and below the horizon are left out with a warning. BadInput for a scenario without orbit or
/// observer, elements over 30 days away unless allowed, a band that it has not, and curves without
/// an epoch in sunlight, and files whose header tells a place more than 5 km from the observer;
/// Physics where the orbit cannot be had. Without `reads_shape` the object's
/// mesh and materials are left alone: only where it was is asked. Interrupted once `cancel` became
/// true.
Result<ObservedLightCurve> observed_light_curve(const Scenario &scenario,
                                                const std::vector<ObservationsFile> &files,
                                                bool allow_old_elements, Diagnostics &diagnostics,
                                                bool reads_shape = true,
                                                const std::atomic<bool> *cancel = nullptr);

} // namespace umov::jobs
