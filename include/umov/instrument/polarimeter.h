#pragma once
// Polarimeters by the way in which they tell Stokes parameters apart.

#include <limits>
#include <string>
#include <umov/core/result.h>
#include <umov/instrument/mueller.h>
#include <umov/optics/index.h>
#include <vector>

namespace umov {

/// How Stokes parameters become counts.
enum class PolarimeterType {
  None,                ///< counts of I alone
  PolarizerWheel,      ///< one analyser angle after the other
  HwpDualBeam,         ///< a plate that steps, two beams at once
  SpinningHwpDualBeam, ///< the plate turns while exposures follow each other
  RotatingRetarder,    ///< a retarder that steps before one analyser: all four parameters
  Pem,                 ///< photoelastic modulator, counts by its phase
  Flc,                 ///< a half-wave plate whose axis flips by 45 deg many times in an exposure
  FourCamera,          ///< beam splitters or lenses, an analyser before each detector
  Mosaic               ///< an analyser on every pixel, 2 x 2
};

/// A polarimeter. Angles in degrees: they are what users write.
struct Polarimeter {
  PolarimeterType type = PolarimeterType::None;
  /// Transmittance of an analyser along its axis over that across, against wavelength.
  Tabulated extinction{{}, {std::numeric_limits<double>::infinity()}};
  Tabulated retardance_deg{{}, {180}}; ///< of the plate, against wavelength
  double amplitude_deg = 137.786355;   ///< Pem: of the retardance; J0 of it is 0
  double plate_zero_deg = 0;           ///< added to every plate angle
  double period_s = 0;                 ///< SpinningHwpDualBeam: of a full turn
  /// Mosaic: of the pixels (0,0), (0,1), (1,0), (1,1); FourCamera: of each camera.
  std::vector<double> angles_deg;
  bool has_separate_pupils = false; ///< FourCamera: lenses, each with its own air
  double x_axis_deg = 0;            ///< of the instrument, from the zenith direction or from north
  double q0 = 0, u0 = 0;            ///< of a simulation: what the reduction does not know
};

/// What is set before an exposure.
struct PolarimeterState {
  double analyser_deg = 0, plate_deg = 0;
  double plate_turn_deg = 0; ///< while the exposure lasts
};

/// One detector, beam, sub-lattice or phase of an exposure.
struct PolarimeterChannel {
  std::string name;
  double analyser_deg = 0;
  StokesRow row{};       ///< in the instrument's axes; its share of the light is in it
  double time_share = 1; ///< part of the exposure in which it collects
};

/// The channels of one exposure at a wavelength. BadInput where a table does not reach it.
Result<std::vector<PolarimeterChannel>>
polarimeter_channels(const Polarimeter &polarimeter, const PolarimeterState &state, double nm);

/// All of a set must be measured before Stokes parameters can be told apart: a sequence, or every
/// exposure by itself.
bool is_simultaneous(PolarimeterType type);
/// A plate or cell that retards and stands at angles of its own is before the analyser.
bool has_plate(PolarimeterType type);
/// How many Stokes parameters it can tell: 1, 3 or 4.
std::size_t parameters_of(PolarimeterType type);
/// Orientations that share the pixels of one detector: each has as small a part of them.
double pixel_parts(const Polarimeter &polarimeter);
/// As written in files.
const char *name_of(PolarimeterType type);
/// All names, in the order of the enumeration.
const std::vector<std::string> &polarimeter_names();

/// How well a set of rows tells the first 3 or all 4 parameters.
struct ModulationQuality {
  double condition = 0;         ///< largest over smallest singular value; infinite where that is 0
  double weighted_variance = 0; ///< tr (W^T W)^-1 (Sabatke et al. 2000)
  /// Mean of it over Q and U, of which p is made: their variance in that of a row.
  double linear_variance = 0;
  /// "Q", "U" or "V", of what cannot be told (a condition number above 1000); else empty. The
  /// variances are infinite where something is.
  std::string missing;
};
/// Of `parameters` columns of the rows.
ModulationQuality modulation_quality(const std::vector<StokesRow> &rows, std::size_t parameters);

} // namespace umov
