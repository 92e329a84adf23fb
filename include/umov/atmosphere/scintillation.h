#pragma once

namespace umov {

/// Whose light scintillates.
struct ScintillationSite {
  double height_m = 0;
  double c_y = 1.5; ///< of the site: 1.3 to 1.67 measured, 1.5 in the mean (Osborn et al. 2015)
};

/// Relative standard deviation of one exposure behind one entrance pupil (Osborn et al. 2015,
/// MNRAS 452, 1707, Eq. 7): sqrt(1e-5 C_Y^2 D^(-4/3) t^-1 X^3 exp(-2 h/8000 m)). For exposures
/// much longer than D/(wind), tens of milliseconds, and D > 0.1 m; nights differ by two.
double scintillation_sd(const ScintillationSite &site, double aperture_m, double exposure_s,
                        double airmass);

/// Part of that variance that is left while the telescope follows a satellite at `rate_rad_s`: the
/// pupil's track through a layer at 10 km outruns a wind of 20 m/s, and a long exposure's variance
/// goes with 1/speed. An assumption, derived, not measured.
double slewing_variance_factor(double rate_rad_s, double airmass);

} // namespace umov
