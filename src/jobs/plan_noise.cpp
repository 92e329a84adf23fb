#include "jobs/plan_noise.h"

#include "jobs/exposure_rates.h"
#include "jobs/observe_plan.h"
#include <umov/core/median.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/photometry/radiometry.h>
#include <utility>

namespace umov::jobs {
namespace {

constexpr double usual_snr = 100;
constexpr double least_snr = 3; ///< fractions of fainter light are not given, as umov reduce has it

/// Irradiance of 1 m2/sr, for each epoch and band.
Result<std::vector<double>> irradiances(const Scenario &scenario, const PlannedLight &light) {
  UMOV_ASSIGN(colours, photometric_bands(scenario.bands, MagnitudeSystem::AB));
  std::vector<double> out;
  for (const ObservingGeometry &g : light.geometry)
    for (const PhotometricBand &colour : colours)
      out.push_back(
          irradiance_at_observer(1, colour.solar, g.sun_distance_km, g.sunlit, g.range_km));
  return out;
}

/// Median irradiance of a band over all alternatives, of what is lit.
double median_irradiance(const PlannedLight &light, const std::vector<double> &per_intensity,
                         std::size_t band) {
  std::vector<double> lit;
  for (const Alternative &a : light.alternatives)
    for (std::size_t k = band; k < per_intensity.size(); k += light.bands)
      if (a.light.i[k] > 0)
        lit.push_back(a.light.i[k] * per_intensity[k]);
  return lit.empty() ? 0 : median_of(std::move(lit));
}

/// Photon noise of a stated size: an ideal polarimeter gives I at the full rate, q and u at half.
PlannedErrors stated(const PlannedLight &light, const std::vector<double> &per_intensity,
                     double snr) {
  PlannedErrors out;
  out.text = fmt::format("photon noise, S/N {:g} in a row of median brightness", snr);
  std::vector<double> median;
  for (std::size_t b = 0; b < light.bands; ++b)
    median.push_back(median_irradiance(light, per_intensity, b));
  for (const Alternative &a : light.alternatives) {
    ExpectedErrors one;
    for (std::size_t k = 0; k < per_intensity.size(); ++k) {
      const double reference = median[k % light.bands];
      const double irradiance = std::max(a.light.i[k], 0.0) * per_intensity[k];
      const double sd = std::sqrt(irradiance * reference) / snr / per_intensity[k];
      one.i_sd.push_back(sd);
      one.q_sd.push_back(a.light.i[k] > least_snr * sd ? std::sqrt(2.0) * sd / a.light.i[k]
                                                       : std::nan(""));
    }
    out.of.push_back(std::move(one));
  }
  return out;
}

/// An instrument in every band of the scenario; the air mass is set row by row.
class InstrumentErrors {
public:
  static Result<InstrumentErrors> make(const Scenario &scenario, const PlanRequest &request);
  Result<PlannedErrors> errors(const PlannedLight &light, const std::vector<double> &per_intensity);

private:
  Result<void> add(const Alternative &a, const PlannedLight &light,
                   const std::vector<double> &per_intensity, PlannedErrors &out);
  std::vector<ExposureSetup> setups_;
  std::vector<PhotometricBand> colours_;
  double exposure_s_ = 1;
  std::string name_;
};

Result<InstrumentErrors> InstrumentErrors::make(const Scenario &scenario,
                                                const PlanRequest &request) {
  const ScenarioObservation &o = *scenario.observation;
  InstrumentErrors out;
  UMOV_ASSIGN(bands, observed_bands(scenario));
  Diagnostics told_when_observed;
  UMOV_ASSIGN(programme, Programme::make(scenario, bands.responses, told_when_observed));
  UMOV_ASSIGN(grid, BandGrid::make(scenario.bands));
  UMOV_ASSIGN(colours, photometric_bands(scenario.bands, MagnitudeSystem::AB));
  out.colours_ = std::move(colours);
  ExposureRequest asked;
  asked.height_m = scenario.observer->altitude_m;
  asked.sky_mag = request.sky_mag;
  asked.seeing_arcsec = o.seeing.arcsec;
  for (std::size_t b = 0; b < bands.responses.size(); ++b) {
    UMOV_ASSIGN(setup, exposure_setup(asked, o.instrument, at_nodes(bands.responses[b], grid, b),
                                      programme.states(b)));
    out.setups_.push_back(std::move(setup));
  }
  const ExposureSetup &first = out.setups_.front();
  const double set_s = first.states * std::max(o.exposure_s, o.cadence_s);
  const ScenarioTime &time = *scenario.time;
  const bool is_own = !time.epochs.empty();
  if (first.states > 1 && time.epochs.size() != 1 && set_s > time.step_s)
    return fail(ErrorCode::BadInput,
                fmt::format("{} = {:g}{}, but a set of {:g} states with this polarimeter takes "
                            "{:g} s; make the step as long",
                            is_own ? "the shortest step of time.epochs" : "time.step_s",
                            time.step_s, is_own ? " s" : "", first.states, set_s),
                scenario.place(is_own ? "time.epochs" : "time.step_s"));
  out.exposure_s_ = o.exposure_s;
  out.name_ = o.instrument.name;
  return out;
}

Result<void> InstrumentErrors::add(const Alternative &a, const PlannedLight &light,
                                   const std::vector<double> &per_intensity, PlannedErrors &out) {
  constexpr double faintest = 35; // magnitudes: nothing is seen of less
  ExpectedErrors one;
  for (std::size_t k = 0; k < per_intensity.size(); ++k) {
    ExposureSetup &setup = setups_[k % light.bands];
    setup.airmass = airmass(light.geometry[k / light.bands].altitude);
    const double seen = std::max(a.light.i[k], 0.0) * per_intensity[k];
    const double least = colours_[k % light.bands].zero * std::pow(10, -0.4 * faintest);
    const double irradiance = std::max(seen, least);
    UMOV_ASSIGN(rates, star_rates(setup, magnitude_of(irradiance, colours_[k % light.bands])));
    const StarFrame frame = star_frame(setup, rates, exposure_s_);
    const double snr = frame.snr * std::sqrt(setup.states);
    if (frame.full >= 1) {
      ++out.saturated;
      one.i_sd.push_back(std::nan(""));
      one.q_sd.push_back(std::nan(""));
      continue;
    }
    one.i_sd.push_back(irradiance / per_intensity[k] / snr);
    const bool has_q =
        snr > least_snr && seen > 0 && parameters_of(setup.instrument.polarimeter.type) >= 3;
    one.q_sd.push_back(has_q ? frame.sd_p : std::nan(""));
  }
  out.of.push_back(std::move(one));
  return {};
}

Result<PlannedErrors> InstrumentErrors::errors(const PlannedLight &light,
                                               const std::vector<double> &per_intensity) {
  PlannedErrors out;
  out.text = fmt::format(
      "{}, exposures of {:g} s{}, sky of {:g} mag/arcsec2", name_, exposure_s_,
      setups_.front().states > 1 ? fmt::format(", {:g} to a row", setups_.front().states) : "",
      setups_.front().request.sky_mag);
  for (const Alternative &a : light.alternatives)
    UMOV_TRY(add(a, light, per_intensity, out));
  return out;
}

} // namespace

Result<PlannedErrors> planned_errors(const Scenario &scenario, const PlanRequest &request,
                                     const PlannedLight &light) {
  UMOV_ASSIGN(per_intensity, irradiances(scenario, light));
  if (request.snr > 0 || !scenario.observation)
    return stated(light, per_intensity, request.snr > 0 ? request.snr : usual_snr);
  UMOV_ASSIGN(instrument, InstrumentErrors::make(scenario, request));
  return instrument.errors(light, per_intensity);
}

} // namespace umov::jobs
