// The worked chain of docs/theory/observing.md: HST at 2018-01-21T05:12:00Z through air, telescope
// and polarization camera, and back. Numbers of an independent program in numpy.
#include "core/tests/anchors.h"

#include <cmath>
#include <gtest/gtest.h>
#include <umov/atmosphere/refraction.h>
#include <umov/atmosphere/sky_polarization.h>
#include <umov/instrument/telescope.h>
#include <umov/io/observation.h>
#include <umov/io/passband_file.h>
#include <umov/jobs/exposure.h>
#include <umov/optics/passband.h>
#include <umov/photometry/radiometry.h>
#include <umov/reduction/polarization.h>
#include <umov/reduction/stokes_fit.h>

namespace umov::jobs {
namespace {

constexpr double exposure_s = .05, flux = 1e-14, axis_deg = 30;
const Angle altitude = Angle::degrees(55.844337);

/// Electrons per second before polarizers, air of `x` in front, on a fine grid.
double rate(const Passband &band, const Air &air, double x) {
  const Spectrum response{band.wavelength_nm, band.response};
  constexpr double step = .25, h_c = 6.62607015e-34 * 299792458;
  double sum = 0;
  const double first = band.wavelength_nm.front(), last = band.wavelength_nm.back();
  for (double nm = first; nm <= last + step / 2; nm += step) {
    const double part = nm == first || nm + step > last + step / 2 ? .5 : 1;
    sum += part * step * value_at(response, nm) * nm * 1e-9 / h_c *
           std::pow(10, -.4 * extinction_mag(nm, air) * x);
  }
  const Instrument camera = *read_instrument("c11_imx250");
  return collecting_area_m2(camera.telescope) * camera.telescope.throughput.value.front() * flux *
         sum;
}

/// Rows of the camera's four orientations, 0 45 90 135.
std::vector<StokesRow> camera_rows() {
  std::vector<StokesRow> out;
  for (const double angle : {0., 45., 90., 135.})
    out.push_back(first_row(polarizer(300, Angle::degrees(angle))) * .25);
  return out;
}

Stokes<InstrumentAxes> in_camera(double p, double psi_deg) {
  const Stokes<InstrumentAxes> altaz{1, p * std::cos(psi_deg * pi / 90),
                                     p * std::sin(psi_deg * pi / 90), 0};
  return axes_turned(Angle::degrees(axis_deg)) * altaz;
}

TEST(Chain, AirAndTelescope) {
  // 69.593 kPa, 283.15 K, .4 kPa of water.
  const Angle seen = apparent_altitude(550, altitude, {695.93, 283.15, 4});
  EXPECT_NEAR(seen.degrees(), 55.85188, 5e-6);
  EXPECT_NEAR(airmass(seen), 1.207467, 5e-7);
  const Passband v = *find_passband("Bessell.V");
  EXPECT_NEAR(-2.5 * std::log10(flux / *zero_irradiance(v, MagnitudeSystem::AB)), 8.890173,
              2e-6); // its pivot was taken on a grid of .25 nm
  const Air air{standard_pressure_hpa(3058), .02, 1.3, 260, 0};
  EXPECT_NEAR(rate(v, air, airmass(seen)), 41236.31, .02); // seven digits
}

/// Magnitude of one electron a second in V of every instrument, without air and polarizers.
TEST(Chain, ZeroPointsOfTheInstruments) {
  const Anchors numbers("observing_instrument");
  for (const std::string &name : instrument_names()) {
    ExposureRequest request;
    request.instrument = name;
    request.band = "Bessell.V";
    const auto table = exposure(request);
    ASSERT_TRUE(table) << table.error().message;
    double found = 0;
    for (std::size_t k = 0; k < table->rows(); ++k)
      if (table->text("quantity", k) == "zero_point")
        found = table->number("value", k);
    EXPECT_NEAR(found, numbers.row({("zero_point_" + name).c_str()})["value"], 2e-6) << name;
  }
}

TEST(Chain, CountsAndBack) {
  const double star = 41236.31 * exposure_s * .84;
  const double expected[] = {302.44379, 151.07109, 131.98078, 283.35348};
  const double expected_sky[] = {.24824592, .11939782, .10314835, .23199645};
  const Instrument camera = *read_instrument("c11_imx250");
  // V = 21.2 mag/arcsec2 on 50 arcsec2; AB 0 gives 8.916819e9 photons s-1 m-2.
  const double sky = 8.916819e9 * std::pow(10, -.4 * 21.2) * collecting_area_m2(camera.telescope) *
                     .35 * exposure_s * 50;
  const SkyPolarization twilight =
      scattered_sky(horizontal_direction(Angle::degrees(253.969112), Angle::degrees(-14.897084)),
                    horizontal_direction(Angle::degrees(140.523474), altitude), .8);
  const auto rows = camera_rows();
  std::vector<ChannelDatum> data;
  for (std::size_t k = 0; k < 4; ++k) {
    const double of_star = star * respond(rows[k], in_camera(.5, 11.093944));
    const double of_sky =
        sky * respond(rows[k], in_camera(twilight.degree, twilight.axis.degrees()));
    EXPECT_NEAR(of_star, expected[k], 4e-5); // .005 of the rate, .05 s, .84, at most .175
    EXPECT_NEAR(of_sky, expected_sky[k], 1e-7);
    data.push_back({expected[k] + expected_sky[k], expected_sky[k], 1058, 1, rows[k]});
  }
  const StokesFractions f = fractions_of(*fit_stokes(data, 3));
  const double twice = 2 * axis_deg * pi / 180, q = f.value[0], u = f.value[1];
  EXPECT_NEAR(q * std::cos(twice) - u * std::sin(twice), .46297522, 3e-8);
  EXPECT_NEAR(q * std::sin(twice) + u * std::cos(twice), .18882253, 3e-8);
  EXPECT_NEAR(std::sqrt(f.covariance[0][0]), .11984, 5e-6);
  EXPECT_NEAR(std::sqrt(f.covariance[1][1]), .11873, 5e-6);
  const auto p = polarization_of(
      q, u, {{{f.covariance[0][0], f.covariance[0][1]}, {f.covariance[1][0], f.covariance[1][1]}}});
  EXPECT_NEAR(p.debiased, .48634879, 3e-8);
  EXPECT_NEAR(std::fmod(p.angle_rad * 180 / pi + axis_deg, 180), 11.093944, 3e-6);
}

TEST(Chain, AMisjudgedTwilightIsTakenForMaterial) {
  // Sky of V = 15 on 50 arcsec2, polarized by .5 as the object would be, a tenth of it left in:
  // .0122 of the star.
  const double psi = 11.093944, star = 41236.31 * exposure_s * .84;
  const Instrument camera = *read_instrument("c11_imx250");
  const double share = 8.916819e9 * std::pow(10, -.4 * 15) * collecting_area_m2(camera.telescope) *
                       .35 * exposure_s * 50 / star; // .244
  const auto rows = camera_rows();
  std::vector<ChannelDatum> data;
  for (const StokesRow &row : rows) {
    const double sky = share * star * respond(row, in_camera(.5, psi));
    data.push_back(
        {star * row[0] + sky, .9 * sky, 0, 1, row_on_sky(row, Angle::degrees(axis_deg))});
  }
  const StokesFit fit = *fit_stokes(data, 3);
  const double twice = 2 * psi * pi / 180, q = fit.stokes[1] / star, u = fit.stokes[2] / star;
  EXPECT_NEAR(q * std::cos(twice) + u * std::sin(twice), .0122, .02 * .0122); // over the star alone
  EXPECT_NEAR(u * std::cos(twice) - q * std::sin(twice), 0, 1e-12);
}

} // namespace
} // namespace umov::jobs
