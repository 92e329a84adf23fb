#pragma once
// Private: which exposures are taken, with what, and in which bands.

#include <complex>
#include <umov/core/diagnostics.h>
#include <umov/io/scenario.h>
#include <umov/optics/band_grid.h>

namespace umov::jobs {

/// States that a polarimeter of this type goes through where nothing else is said.
std::vector<PolarimeterState> usual_states(PolarimeterType type);

/// How far a plate that turns by itself does so [deg]; 0 of all others.
struct PlateTurn {
  double per_cadence = 0, per_exposure = 0;
  /// Exposure number k, begun at `start`.
  [[nodiscard]] PolarimeterState at(PolarimeterState start, std::size_t k) const;
  /// Exposures of a quarter turn, after which the modulation comes again; 1 where nothing turns.
  [[nodiscard]] double frames() const;
};
/// Of exposures that begin every `cadence_s`.
PlateTurn turn_of(const Polarimeter &polarimeter, double exposure_s, double cadence_s);

/// How well the rows of a set in a band tell what the polarimeter is made for. BadInput, in words
/// that begin with `key`, where they do not.
Result<ModulationQuality> told_by(const std::vector<StokesRow> &rows, const Polarimeter &p,
                                  const std::string &key, const BandResponse &band);

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

/// Refractive indices of the port's mirrors at each of the wavelengths, as `BandObserver` takes
/// them.
Result<std::vector<std::complex<double>>> port_metals(const Telescope &telescope,
                                                      const std::vector<double> &nm);

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
  /// Of the first set, in one band.
  [[nodiscard]] std::vector<PolarimeterState> states(std::size_t band) const;

private:
  [[nodiscard]] Result<void> check(const Scenario &scenario, const std::vector<BandResponse> &bands,
                                   Diagnostics &diagnostics) const;
  struct Step {
    PolarimeterState state;
    std::size_t band;
  };
  std::vector<Step> steps_;
  double exposure_s_ = 1;
  PlateTurn turn_;
  std::size_t set_size_ = 1; ///< exposures of a set: a round of all states in all bands
};

} // namespace umov::jobs
