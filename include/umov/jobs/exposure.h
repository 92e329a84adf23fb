#pragma once
// Instruments, and how long one must expose for a star of a magnitude.

#include <umov/io/observation.h>
#include <umov/io/table.h>

namespace umov::jobs {

/// What is asked.
struct ExposureRequest {
  std::string instrument; ///< a name or a file
  double mag = 8;         ///< above the air
  MagnitudeSystem magnitudes =
      MagnitudeSystem::AB;  ///< of `mag`; Vega: of a band with a curve alone
  double altitude_deg = 45; ///< apparent
  double height_m = 0;      ///< of the site
  double sd_p = 0.01;       ///< wanted standard deviation of the degree of polarization
  std::string band;         ///< "Bessell.V", "nm:650", "file:x.vot"; empty: `nm` and `width_nm`
  double nm = 550, width_nm = filter_width_nm; ///< the width also of a band that is one wavelength
  double sky_mag = 21;                         ///< AB in the band [mag / arcsec2]
  double seeing_arcsec = Seeing{}.arcsec;      ///< at the zenith, as umov observe takes it
  double change_per_s = 0;                     ///< relative change of the object's brightness
  double aperture_fwhm = 1;                    ///< radius that is summed, in widths of a star
  double exposure_s = 0; ///< of a frame; 0: until p is known, or half of what fills a pixel
};

/// Rows of a quantity, its value and its unit: electrons, time for `sd_p`, time that fills a pixel,
/// shares of each noise at that time, false polarization of analysers that follow each other. The
/// note "verdict" says what a frame reaches, whether it saturates and how many of them tell p,
/// "magnitude" what the magnitude is in AB and Vega, "terms" what each error counts.
Result<Table> exposure(const ExposureRequest &request);

/// A page of figures: error of p and signal to noise against the length of a frame for stars about
/// the one asked for, time against magnitude, and what makes the noise.
Result<std::string> exposure_page(const ExposureRequest &request);

/// Every compiled-in instrument: name, aperture, type of polarimeter, what it is.
Result<Table> instrument_list();

} // namespace umov::jobs
