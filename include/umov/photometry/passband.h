#pragma once
// Bands sampled at their own points, and how air dims them.

#include <umov/core/result.h>
#include <umov/optics/passband.h>
#include <vector>

namespace umov {

/// Weights of the wavelengths in a detected count of sunlight: response times solar irradiance
/// times wavelength times step (trapezoid), sum 1. Stokes components are summed with them before
/// one is divided by another. BadInput outside the solar table.
Result<std::vector<double>> sunlight_weights(const Passband &band);

/// Mean wavelength under the weights [nm].
double mean_wavelength_nm(const Passband &band, const std::vector<double> &weights);

/// Extinction of clear air at the zenith [mag per unit airmass]: molecules by Hansen & Travis 1974
/// (Space Sci. Rev. 16, 527, eq. 2.30) at a pressure in hPa, and aerosol of optical depth
/// `aerosol_550` at 550 nm that goes with wavelength^-1.3 (Angstrom 1929).
double clear_extinction_mag(double wavelength_nm, double pressure_hpa, double aerosol_550);

} // namespace umov
