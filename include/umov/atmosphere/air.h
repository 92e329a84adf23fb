#pragma once
// Clear air between the object and a telescope: what it takes away.

#include <memory>
#include <vector>

namespace umov {

/// Extinction as a site has measured it: as many wavelengths as magnitudes, one or more. Of
/// another table there is no number (NaN), and a BandObserver refuses it.
struct MeasuredExtinction {
  std::vector<double> nm, mag; ///< at increasing wavelengths, per air mass; linear in between
};

/// The air over a site.
struct Air {
  double pressure_hpa = 1013.25;
  double aerosol_550 = 0.02;     ///< optical depth at 550 nm, vertical
  double aerosol_exponent = 1.3; ///< depth goes with wavelength^-exponent (Angstrom 1929)
  double ozone_du = 260;         ///< column [Dobson units]
  double water_cm = 0.3;         ///< precipitable water [cm]
  /// Instead of all that takes light away; the pressure still refracts.
  std::shared_ptr<const MeasuredExtinction> measured = nullptr;
};

/// Wavelengths between which something is known of it [nm]: where the fit of the molecules begins
/// (Bodhaine et al. 1999) and the table of the gases ends (Bird & Riordan 1984).
inline constexpr double air_from_nm = 250, air_to_nm = 4000;

/// Pressure of the US Standard Atmosphere 1976 at a height in metres [hPa].
double standard_pressure_hpa(double height_m);

/// Vertical optical depth of the molecules (Bodhaine et al. 1999, J. Atmos. Oceanic Technol. 16,
/// 1854, Eq. 30: sea level, 45 deg, 360 ppm CO2; fitted over 250 to 850 nm), in proportion to the
/// pressure.
double rayleigh_depth(double nm, double pressure_hpa);
/// Of the aerosol.
double aerosol_depth(double nm, const Air &air);
/// Of ozone: coefficients of Leckner 1978 as Bird & Riordan 1984 list them; 0 outside 300-1200 nm.
double ozone_depth(double nm, double ozone_du);

/// Transmission of water vapour (Bird & Riordan 1984, Eq. 2-8) and of the gases that are mixed
/// with the air, oxygen above all (Eq. 2-11), at an air mass: their lines saturate, so that no
/// depth per air mass tells them.
double water_transmission(double nm, double water_cm, double airmass);
/// As above.
double mixed_gas_transmission(double nm, double pressure_hpa, double airmass);

/// Extinction without the saturating gases [mag per air mass]: molecules, aerosol, ozone. Of a
/// measured one, which has the gases in it, that; beyond its table that at its end.
double extinction_mag(double nm, const Air &air);
/// Part of the light that arrives: all of the above. 1 at air mass 0.
double transmission(double nm, const Air &air, double airmass);

} // namespace umov
