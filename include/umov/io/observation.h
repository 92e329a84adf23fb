#pragma once
// Instruments as files, and what a scenario says of an observation.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <umov/instrument/frame_observer.h>
#include <umov/lightcurve/extinction.h>
#include <umov/optics/band.h>
#include <vector>

namespace umov {

/// How bright and how polarized the sky is.
struct SkyOptions {
  std::map<std::string, double> dark_mag; ///< by letter, over the tables'
  bool has_twilight = true, has_moon = true;
  double dilution_sun = 0.8, dilution_moon = 0.6;
  std::optional<double> mag; ///< fixed surface brightness, AB in the band, instead of all that
  double p = 0;              ///< of it, along the normal of the plane of the Sun
};

/// One step of a sequence.
struct SequenceStep {
  PolarimeterState state;
  std::string band; ///< empty: every band, one after the other
};

/// [atmosphere], [telescope], [detector], [polarimeter] and [observation] of a scenario.
struct ScenarioObservation {
  Instrument instrument;
  SiteAir air;
  Seeing seeing;
  std::optional<double> scintillation_c_y = 1.5; ///< absent: none
  bool has_slewing_factor = false;
  SkyOptions sky;
  double cloud_sd_mag = 0, cloud_time_s = 60;
  std::vector<std::string> bands;  ///< empty: those of [bands]
  double width_nm = line_width_nm; ///< of bands that are one wavelength
  double exposure_s = 1, cadence_s = 1;
  std::vector<SequenceStep> sequence; ///< empty: that of the polarimeter's type
  double aperture_fwhm = 2;
  double clock_error_s = 0.001;
  bool makes_frames = false;
  std::array<int, 2> frame_px{256, 256}; ///< columns, rows
  std::string stars;                     ///< file of the field's, empty: none
  FramePhotometry photometry = FramePhotometry::Aperture;
  bool cuts_trail = false; ///< each trail is cut into a light curve of its own
};

/// Brightness that a fixed sky may have, AB [mag / arcsec2]: from daylight to below any night.
inline constexpr std::array<double, 2> sky_mag_range{-5, 40};

/// BadInput for a radius that is summed [widths of a star] which reaches into the ring of the sky,
/// or is none. `name`: as the message begins.
Result<void> check_aperture(const std::string &name, double fwhm);

/// BadInput for a band at which nothing is known of what air takes: at all, or by its table.
/// `width_nm`: of the box that a band without a curve is observed as, 0 where it is one wavelength.
Result<void> check_air_reaches(const std::vector<Band> &bands, const SiteAir &air,
                               const Where &where, double width_nm = 0);

/// Names of the instruments that are compiled in.
std::vector<std::string> instrument_names();
/// An instrument by name or from a TOML file.
Result<Instrument> read_instrument(const std::string &name_or_path);
/// From a text that stands for the file `path`.
Result<Instrument> read_instrument_text(const std::string &text, const std::string &path);
/// An instrument as TOML; reading it gives the same.
std::string instrument_as_toml(const Instrument &instrument);

} // namespace umov
