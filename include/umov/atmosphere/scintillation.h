#pragma once

namespace umov {

/// Whose light scintillates.
struct ScintillationSite {
  double height_m = 0;
  double c_y = 1.5; ///< of the site: 1.3 to 1.67 measured, 1.5 in the mean (Osborn et al. 2015)
};

/// Exposure below which the air stands still over a pupil [s]: that in which the law of long
/// exposures, 10.66 D^(-4/3)/(t V) int Cn2 h^2 dh, reaches the variance of the shortest, 17.34
/// D^(-7/3) int Cn2 h^2 dh (Kenyon et al. 2006, PASP 118, 924): .61 D over a wind of 20 m/s.
double wind_crossing_s(double aperture_m);

/// Relative standard deviation of one exposure behind one entrance pupil (Osborn et al. 2015,
/// MNRAS 452, 1707, Eq. 7): sqrt(1e-5 C_Y^2 D^(-4/3) t^-1 X^3 exp(-2 h/8000 m)), and that at
/// `wind_crossing_s` in shorter ones. For D > 0.1 m and less than about .5; nights differ by two.
double scintillation_sd(const ScintillationSite &site, double aperture_m, double exposure_s,
                        double airmass);

/// Part of the variance of a long exposure that is left while the telescope follows a satellite at
/// `rate_rad_s`: the pupil's track through a layer at 10 km outruns a wind of 20 m/s, and a long
/// exposure's variance goes with 1/speed. An assumption, derived, not measured.
double slewing_variance_factor(double rate_rad_s, double airmass);
/// As above, of a telescope that follows at `rate_rad_s`; short exposures flicker as they do of one
/// that stands.
double slewing_scintillation_sd(const ScintillationSite &site, double aperture_m, double exposure_s,
                                double airmass, double rate_rad_s);

} // namespace umov
