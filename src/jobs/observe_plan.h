#pragma once
// Private: which exposures are taken, with what, and in which bands.

#include <umov/core/diagnostics.h>
#include <umov/io/scenario.h>
#include <umov/optics/band_grid.h>

namespace umov::jobs {

/// States that a polarimeter of this type goes through where nothing else is said.
std::vector<PolarimeterState> usual_states(PolarimeterType type);

/// Bands, and what the instrument makes of each.
struct ObservedBands {
  std::vector<Band> bands;
  std::vector<BandResponse> responses; ///< at one wavelength still: `at_nodes`
  std::vector<double> zero_flux; ///< mean of magnitude 0 in the scenario's system [W m-2 nm-1]
  BandResponse v;                ///< Bessell's V, in which moonlight is known
};
/// Those of the observation, else of the scenario. BadInput for one without a zero in the
/// scenario's system of magnitudes.
Result<ObservedBands> observed_bands(const Scenario &scenario);

/// A band at the wavelengths of a grid, of which it is number `b`.
BandResponse at_nodes(BandResponse response, const BandGrid &grid, std::size_t b);

/// What exposure number k of the grid is set to.
struct PlannedExposure {
  ExposurePlan plan;
  std::size_t band = 0, set = 0;
};
/// Sequences of states and bands.
class Programme {
public:
  /// BadInput where a band of the sequence is unknown or not in it, or the states of one band
  /// cannot tell all parameters; a warning where they do so badly, or say what the type does not
  /// know.
  static Result<Programme> make(const Scenario &scenario, const std::vector<BandResponse> &bands,
                                Diagnostics &diagnostics);
  /// Exposure k.
  [[nodiscard]] PlannedExposure at(std::size_t k) const;

private:
  [[nodiscard]] Result<void> check(const Scenario &scenario, const std::vector<BandResponse> &bands,
                                   Diagnostics &diagnostics) const;
  struct Step {
    PolarimeterState state;
    std::size_t band;
  };
  std::vector<Step> steps_;
  double exposure_s_ = 1, turn_per_exposure_ = 0, turn_per_cadence_ = 0;
  std::size_t set_size_ = 1; ///< exposures of a set: a round of all states in all bands
};

} // namespace umov::jobs
