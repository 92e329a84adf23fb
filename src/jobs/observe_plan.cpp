#include "jobs/observe_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/text.h>
#include <umov/io/passband_file.h>

namespace umov::jobs {
std::vector<PolarimeterState> usual_states(PolarimeterType type) {
  const auto plates = [](std::initializer_list<double> angles) {
    std::vector<PolarimeterState> out;
    for (const double angle : angles)
      out.push_back({0, angle, 0});
    return out;
  };
  switch (type) {
  case PolarimeterType::PolarizerWheel:
    return {{0, 0, 0}, {45, 0, 0}, {90, 0, 0}, {135, 0, 0}};
  case PolarimeterType::HwpDualBeam:
    return plates({0, 45, 22.5, 67.5});
  case PolarimeterType::RotatingRetarder:
    return plates({-51.69, -15.12, 15.12, 51.69});
  case PolarimeterType::Pem:
    return {{0, 0, 0}, {45, 0, 0}};
  case PolarimeterType::Flc:
    return plates({0, 22.5});
  default:
    return {{}};
  }
}

namespace {

/// Angles that a polarimeter of this type does not have.
void warn_of_idle_angles(PolarimeterType type, const std::vector<SequenceStep> &sequence,
                         Diagnostics &diagnostics) {
  const bool has_analyser = type == PolarimeterType::PolarizerWheel ||
                            type == PolarimeterType::RotatingRetarder ||
                            type == PolarimeterType::Pem;
  const bool has_plate = type == PolarimeterType::HwpDualBeam ||
                         type == PolarimeterType::SpinningHwpDualBeam ||
                         type == PolarimeterType::RotatingRetarder || type == PolarimeterType::Flc;
  const auto warn = [&](const char *key, bool has_it, auto angle) {
    if (!has_it &&
        std::ranges::any_of(sequence, [&](const auto &step) { return angle(step) != 0; }))
      diagnostics.warn(fmt::format("observation.sequence: {} says nothing to a polarimeter of type "
                                   "\"{}\"",
                                   key, name_of(type)));
  };
  warn("analyser_deg", has_analyser, [](const auto &step) { return step.state.analyser_deg; });
  warn("plate_deg", has_plate, [](const auto &step) { return step.state.plate_deg; });
  if (type == PolarimeterType::SpinningHwpDualBeam && sequence.size() > 1)
    diagnostics.warn("observation.sequence: the plate turns by itself; of the steps only the first "
                     "counts, as the angle at the start");
}

} // namespace

Result<ObservedBands> observed_bands(const Scenario &scenario) {
  const ScenarioObservation &o = *scenario.observation;
  std::vector<Band> bands = scenario.bands;
  if (!o.bands.empty()) {
    std::vector<BandEntry> entries;
    for (const std::string &name : o.bands)
      entries.push_back({name, {}});
    auto own = read_bands(entries, std::filesystem::path(scenario.file).parent_path());
    if (!own)
      return fail(own.error().code, own.error().message + " (named in observation.bands)",
                  own.error().where.file.empty() ? Where{scenario.file} : own.error().where);
    bands = std::move(*own);
  }
  ObservedBands out;
  for (const Band &band : bands) {
    UMOV_ASSIGN(response, band.curve ? curve_band(*band.curve)
                                     : narrow_band(band.name, band.wavelength.nm(), o.width_nm));
    const auto zero = zero_irradiance(band, scenario.magnitudes);
    if (!zero)
      return fail(ErrorCode::BadInput,
                  fmt::format("{} (named in observation.bands; the system is that of "
                              "bands.mag_system)",
                              zero.error().message),
                  scenario.place("bands.mag_system"));
    // In AB as the instrument has it: a wavelength of its own is no narrow curve there.
    out.zero_flux.push_back(scenario.magnitudes == MagnitudeSystem::AB ? response.zero_flux
                                                                       : *zero);
    out.responses.push_back(std::move(response));
  }
  UMOV_ASSIGN(v_curve, find_passband("Bessell.V"));
  UMOV_ASSIGN(v, curve_band(v_curve));
  out.v = std::move(v);
  out.bands = std::move(bands);
  return out;
}

BandResponse at_nodes(BandResponse response, const BandGrid &grid, std::size_t b) {
  response.nm.clear();
  response.weight.clear();
  for (const BandTerm &term : grid.terms()[b]) {
    response.nm.push_back(grid.nodes()[term.node].wavelength.nm());
    response.weight.push_back(term.weight);
  }
  return response;
}

Result<Programme> Programme::make(const Scenario &scenario, const std::vector<BandResponse> &bands,
                                  Diagnostics &diagnostics) {
  const ScenarioObservation &o = *scenario.observation;
  const Polarimeter &p = o.instrument.polarimeter;
  Programme out;
  out.exposure_s_ = o.exposure_s;
  std::vector<SequenceStep> steps = o.sequence;
  if (steps.empty())
    for (const PolarimeterState &state : usual_states(p.type))
      steps.push_back({state, ""});
  if (p.type == PolarimeterType::SpinningHwpDualBeam) {
    out.turn_per_cadence_ = 360 * o.cadence_s / p.period_s;
    out.turn_per_exposure_ = 360 * o.exposure_s / p.period_s;
    const double frames = 90 / out.turn_per_cadence_;
    constexpr double most = 10'000;
    if (!(frames <= most))
      return fail(ErrorCode::BadInput,
                  fmt::format("polarimeter.period_s = {} makes {:.3g} exposures of each quarter "
                              "turn at observation.cadence_s = {}; {} is the limit",
                              p.period_s, frames, o.cadence_s, most),
                  scenario.place("polarimeter.period_s"));
    const auto whole = static_cast<std::size_t>(std::max(2.0, std::round(frames)));
    steps.resize(whole, steps.front());
  }
  std::vector<std::string> names;
  names.reserve(bands.size());
  for (const BandResponse &band : bands)
    names.push_back(band.name);
  const auto find = [&names](const std::string &name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  for (std::size_t b = 0; b < bands.size(); ++b)
    for (const SequenceStep &step : steps) {
      if (!step.band.empty() && find(step.band) == bands.size())
        return fail(ErrorCode::BadInput,
                    fmt::format("observation.sequence: band \"{}\" is none of those observed; "
                                "add it to observation.bands or name one of them: {}",
                                step.band, fmt::join(names, ", ")),
                    scenario.place("observation.sequence"));
      if (step.band.empty() || find(step.band) == b)
        out.steps_.push_back({step.state, b});
    }
  out.set_size_ = is_simultaneous(p.type) ? 1 : std::max<std::size_t>(1, out.steps_.size());
  warn_of_idle_angles(p.type, o.sequence, diagnostics);
  UMOV_TRY(out.check(scenario, bands, diagnostics));
  return out;
}

/// The states of a set must tell, in each band by itself, what the type is made for.
Result<void> Programme::check(const Scenario &scenario, const std::vector<BandResponse> &bands,
                              Diagnostics &diagnostics) const {
  const Polarimeter &p = scenario.observation->instrument.polarimeter;
  const std::size_t parameters = parameters_of(p.type);
  // Angles of what has all channels at once are those of its analysers.
  const std::string key =
      p.type == PolarimeterType::FourCamera ? "polarimeter.angles_deg" : "observation.sequence";
  for (std::size_t b = 0; b < bands.size(); ++b) {
    std::vector<StokesRow> rows;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      if (steps_[k].band != b)
        continue;
      UMOV_ASSIGN(channels, polarimeter_channels(p, at(k).plan.state, bands[b].pivot_nm));
      for (const PolarimeterChannel &channel : channels)
        rows.push_back(channel.row);
    }
    if (rows.empty())
      return fail(ErrorCode::BadInput,
                  fmt::format("observation.sequence has no step in band \"{}\"; add some, or leave "
                              "it out of observation.bands",
                              bands[b].name),
                  scenario.place("observation.sequence"));
    if (parameters < 3)
      continue;
    const ModulationQuality quality = modulation_quality(rows, parameters);
    if (!std::isfinite(quality.condition))
      return fail(ErrorCode::BadInput,
                  fmt::format("{} with {} in band \"{}\" cannot tell {}{} (condition number "
                              "{:.3g}); {}",
                              key, counted(rows.size(), "row"), bands[b].name, quality.missing,
                              quality.missing.size() > 1 ? " apart" : "", quality.condition,
                              rows.size() < parameters
                                  ? fmt::format("{} or more are needed", parameters)
                                  : "give other angles"),
                  scenario.place(key));
    if (constexpr double poor = 10; quality.condition > poor)
      diagnostics.warn(fmt::format("{}: the states tell the Stokes parameters badly (condition "
                                   "number {:.3g}, 1.4 to 1.7 is good): their errors will be large",
                                   bands[b].name, quality.condition),
                       scenario.place(key));
  }
  return {};
}

PlannedExposure Programme::at(std::size_t k) const {
  const Step &step = steps_[k % steps_.size()];
  PlannedExposure out{
      {static_cast<std::uint32_t>(k), exposure_s_, step.state}, step.band, k / set_size_};
  if (turn_per_exposure_ > 0) {
    const double middle = turn_per_cadence_ * static_cast<double>(k) + turn_per_exposure_ / 2;
    out.plan.state.plate_deg += std::fmod(middle, 360);
    out.plan.state.plate_turn_deg = turn_per_exposure_;
  }
  return out;
}

} // namespace umov::jobs
