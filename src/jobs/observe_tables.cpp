#include "jobs/observe_tables.h"

#include "jobs/columns.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <umov/core/text.h>
#include <umov/lightcurve/derived_errors.h>

namespace umov::jobs {

void ExposureColumns::add(const Setup &setup, const Exposure &exposure, const Epoch<Utc> &time,
                          std::size_t slice) {
  // Pieces of a trail are exposures and sets of their own; no frame has as many.
  constexpr std::int64_t most = 10'000;
  const auto number = [&](auto of_exposure) {
    const auto whole = static_cast<std::int64_t>(of_exposure);
    return setup.observation.cuts_trail ? whole * most + static_cast<std::int64_t>(slice) : whole;
  };
  constexpr int milliseconds = 3, microseconds = 6;
  constexpr double fast_s = 0.01; // half a millisecond is much of it
  const bool is_fine = setup.observation.cuts_trail || setup.observation.cadence_s < fast_s;
  time_.push_back(to_iso(time, is_fine ? microseconds : milliseconds));
  exposure_.push_back(number(exposure.planned.plan.index));
  set_.push_back(number(exposure.planned.set));
  name_.push_back(setup.object);
  band_.push_back(setup.observers[exposure.planned.band].band().name);
}

void ExposureColumns::put(Table &table) && {
  table.add("time_utc", "", "UTC of the middle of the exposure", std::move(time_));
  table.add("exposure", "", "number in the run", std::move(exposure_));
  table.add("set_id", "", "exposures that belong together", std::move(set_));
  table.add("name", "", "object", std::move(name_));
  table.add("band", "", "band", std::move(band_));
}

void CountsTable::add(const Exposure &e, const Recorded &r) {
  if (r.slices.empty())
    return add(e, r, r.channels, 0, 0);
  for (std::size_t k = 0; k < r.slices.size(); ++k)
    add(e, r, r.slices[k].channels, r.slices[k].offset_s, k);
}

void CountsTable::add(const Exposure &e, const Recorded &r,
                      const std::vector<ChannelCounts> &channels, double offset_s,
                      std::size_t slice) {
  for (const ChannelCounts &c : channels) {
    exposures_.add(s_, e, plus_seconds(e.stamp, offset_s), slice);
    channel_.push_back(c.channel);
    saturated_.push_back(c.is_saturated);
    // The object outside the frame: no count of it, which umov reduce leaves out.
    const double none = c.row[0] > 0 ? 0 : std::nan("");
    const double axis = std::fmod(std::fmod(r.axis.degrees(), 180) + 180, 180);
    const double values[] = {c.analyser_deg,
                             e.planned.plan.state.plate_deg,
                             axis,
                             c.counts + none,
                             c.recorded * adu_per_electron(s_.observation.instrument.detector),
                             c.sky,
                             c.sky_err,
                             c.pixels,
                             c.var_read,
                             c.excess2,
                             r.airmass,
                             r.k_mag,
                             c.row[0],
                             c.row[1],
                             c.row[2],
                             c.row[3],
                             e.middle.phase_angle.degrees(),
                             scattering_axis(e.middle, s_.scenario.frame).degrees(),
                             c.scintillation,
                             e.middle.right_ascension.degrees(),
                             e.middle.declination.degrees(),
                             e.middle.range_km};
    for (std::size_t k = 0; k < std::size(values); ++k)
      numbers_[k].push_back(values[k]);
  }
}

Table CountsTable::table() && {
  Table out;
  std::move(exposures_).put(out);
  out.add("channel", "", "beam, camera or orientation", std::move(channel_));
  const char *const columns[][3] = {
      {"analyser_deg", "deg", "angle of the analyser from the instrument's x axis"},
      {"plate_deg", "deg", "angle of the plate in the middle of the exposure"},
      {"x_axis_pa", "deg", "position angle of the instrument's x axis"},
      {"counts", "electron", "in the aperture, sky included"},
      {"counts_adu", "adu",
       "the same in the camera's numbers, before a counter's dead time is made good"},
      {"sky", "electron", "sky and dark in the aperture, from the ring around it"},
      {"sky_err", "electron", "standard deviation of sky"},
      {"n_pixel", "", "pixels in the aperture"},
      {"var_read", "electron2", "variance of reading and rounding"},
      {"excess2", "", "variance of multiplied electrons over Poisson's"},
      {"airmass", "", "of the apparent altitude, Kasten & Young 1989"},
      {"k_mag", "mag", "extinction per air mass in the band"},
      {"w0", "electron m2 nm / W", "counts - sky = w0 I + w1 Q + w2 U + w3 V"},
      {"w1", "electron m2 nm / W", "of Q"},
      {"w2", "electron m2 nm / W", "of U"},
      {"w3", "electron m2 nm / W", "of V"},
      {"phase_angle", "deg", "Sun-object-observer"},
      {"pa_scat", "deg", "position angle of the normal of the scattering plane"},
      {"scint_sd", "", "relative standard deviation of the transparency by scintillation"},
      {"ra", "deg", "of the object, topocentric, geometric, ICRS axes"},
      {"dec", "deg", "the same"},
      {"range", "km", "of the object"}};
  for (std::size_t k = 0; k < std::size(columns); ++k) {
    if (k == 10)
      out.add("saturated", "", "a pixel is full", std::move(saturated_));
    out.add(columns[k][0], columns[k][1], columns[k][2], std::move(numbers_[k]));
  }
  return out;
}

void TruthTable::add(const Exposure &e, const Recorded &r) {
  if (r.slices.empty())
    return add(e, r, {0, r.channels, r.truth}, 0);
  for (std::size_t k = 0; k < r.slices.size(); ++k)
    add(e, r, r.slices[k], k);
}

void TruthTable::add(const Exposure &e, const Recorded &r, const RecordedSlice &slice,
                     std::size_t number) {
  const double zero = s_.zero_flux[e.planned.band];
  exposures_.add(s_, e, plus_seconds(e.middle.time, slice.offset_s), number);
  double electrons = 0, sky = 0;
  for (const ChannelCounts &c : slice.channels)
    electrons += c.mean_star, sky += c.mean_sky;
  const double i = slice.truth.i;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double values[] = {i,
                           i > 0 ? slice.truth.q / i : none,
                           i > 0 ? slice.truth.u / i : none,
                           i > 0 ? slice.truth.v / i : none,
                           i > 0 ? -2.5 * std::log10(i / zero) : none,
                           electrons,
                           sky,
                           e.middle.azimuth.degrees(),
                           e.middle.altitude.degrees(),
                           r.rate_rad_s * 180 / pi};
  for (std::size_t k = 0; k < std::size(values); ++k)
    numbers_[k].push_back(values[k]);
}

Table TruthTable::table() && {
  Table out;
  std::move(exposures_).put(out);
  const std::string system = name_of(s_.scenario.magnitudes);
  const std::string unit = magnitude_unit(system), told = system + " magnitude above the air";
  const char *const columns[][3] = {
      {"I", "W / (m2 nm)", "mean over the exposure above the air, photon-weighted"},
      {"q", "", "Q/I in the sky frame"},
      {"u", "", "U/I in the sky frame"},
      {"v", "", "V/I"},
      {"mag", unit.c_str(), told.c_str()},
      {"star_e", "electron", "expected of the object in all channels"},
      {"sky_e", "electron", "expected of sky and dark in all channels"},
      {"az", "deg", "azimuth, geometric"},
      {"alt", "deg", "altitude, geometric"},
      {"rate", "deg / s", "motion over the sky"}};
  for (std::size_t k = 0; k < std::size(columns); ++k)
    out.add(columns[k][0], columns[k][1], columns[k][2], std::move(numbers_[k]));
  return out;
}

void note_observation(Table &table, const Scenario &scenario, const ObservedBands &bands) {
  const ScenarioObservation &o = *scenario.observation;
  note_conventions(table);
  table.note("pol_frame", name_of(scenario.frame));
  table.note("instrument", o.instrument.name.empty() ? "in the scenario" : o.instrument.name);
  table.note("polarimeter", name_of(o.instrument.polarimeter.type));
  table.note("pupils", o.instrument.polarimeter.has_separate_pupils ? "separate" : "common");
  table.note("parameters", fmt::format("{}", parameters_of(o.instrument.polarimeter.type)));
  table.note("mag_system", name_of(scenario.magnitudes));
  for (std::size_t b = 0; b < bands.responses.size(); ++b)
    table.note("zero_flux " + bands.responses[b].name, shortest(bands.zero_flux[b]));
  if (has_plate(o.instrument.polarimeter.type))
    for (const BandResponse &band : bands.responses)
      if (const auto retardance = value_at(o.instrument.polarimeter.retardance_deg,
                                           Wavelength::nm(band.pivot_nm), "retardance_deg"))
        table.note("retardance_deg " + band.name, shortest(*retardance));
  if (o.cloud_sd_mag > 0)
    table.note("cloud_time_s", shortest(o.cloud_time_s));
  table.note("seed", fmt::format("{}", scenario.seed));
  table.note("site", scenario.observer->name);
  table.note("site_lat_deg", shortest(scenario.observer->latitude.degrees()));
  table.note("site_lon_deg", shortest(scenario.observer->longitude.degrees()));
  table.note("site_alt_m", shortest(scenario.observer->altitude_m));
  if (scenario.objects.size() == 1 && scenario.objects.front().orbit &&
      scenario.objects.front().orbit->norad > 0)
    table.note("norad", fmt::format("{}", scenario.objects.front().orbit->norad));
}

} // namespace umov::jobs
