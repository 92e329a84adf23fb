#pragma once
// Private: which exposures are taken, with what, and in which bands.

#include <umov/io/scenario.h>

namespace umov::jobs {

/// Bands with the few wavelengths that stand for them.
struct ObservedBands {
  std::vector<BandResponse> bands;
  std::vector<Band> nodes;                     ///< all wavelengths, each once
  std::vector<std::vector<std::size_t>> index; ///< [band][node of the band] into nodes
};
/// Those of the observation, else of the scenario.
Result<ObservedBands> observed_bands(const Scenario &scenario);

/// What exposure number k of the grid is set to.
struct PlannedExposure {
  ExposurePlan plan;
  std::size_t band = 0, set = 0;
};
/// Sequences of states and bands.
class Programme {
public:
  /// BadInput where a band of the sequence is unknown, or the states cannot tell all parameters.
  static Result<Programme> make(const ScenarioObservation &observation,
                                const std::vector<BandResponse> &bands);
  /// Exposure k.
  [[nodiscard]] PlannedExposure at(std::size_t k) const;
  /// Exposures of a set.
  [[nodiscard]] std::size_t set_size() const { return set_size_; }

private:
  [[nodiscard]] Result<void> check(const Polarimeter &polarimeter,
                                   const std::vector<BandResponse> &bands) const;
  struct Step {
    PolarimeterState state;
    std::size_t band;
  };
  std::vector<Step> steps_;
  double exposure_s_ = 1, turn_per_exposure_ = 0, turn_per_cadence_ = 0;
  std::size_t set_size_ = 1;
};

} // namespace umov::jobs
