#include "jobs/observe_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>
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

PlateTurn turn_of(const Polarimeter &p, double exposure_s, double cadence_s) {
  if (p.type != PolarimeterType::SpinningHwpDualBeam)
    return {};
  return {360 * cadence_s / p.period_s, 360 * exposure_s / p.period_s};
}

PolarimeterState PlateTurn::at(PolarimeterState start, std::size_t k) const {
  if (!(per_exposure > 0))
    return start;
  start.plate_deg += std::fmod(per_cadence * static_cast<double>(k) + per_exposure / 2, 360);
  start.plate_turn_deg = per_exposure;
  return start;
}

double PlateTurn::frames() const {
  return per_cadence > 0 ? std::max(2.0, std::round(90 / per_cadence)) : 1;
}

namespace {

/// What is wrong and what helps where rows do not tell a Stokes parameter.
std::string mend_of(const Polarimeter &p, double nm) {
  const auto retardance =
      value_at(p.retardance_deg, Wavelength::nm(nm), "polarimeter.retardance_deg");
  // Of Q and U a turning plate makes sin^2 of half its retardance other light: all, by half a wave.
  constexpr double hardly = 0.01;
  if (has_plate(p.type) && retardance && std::pow(std::sin(*retardance * pi / 360), 2) < hardly)
    return fmt::format("a plate of polarimeter.retardance_deg = {:g} there hardly changes Q and U "
                       "as it turns; {} was expected",
                       *retardance,
                       p.type == PolarimeterType::RotatingRetarder
                           ? "some 90 to 150 (131.8 tells all alike)"
                           : "some 180");
  if (p.type == PolarimeterType::SpinningHwpDualBeam)
    return "shorten the exposures, or check polarimeter.period_s, retardance_deg and extinction";
  return "give other angles, or check polarimeter.extinction and retardance_deg";
}

} // namespace

Result<ModulationQuality> told_by(const std::vector<StokesRow> &rows, const Polarimeter &p,
                                  const std::string &key, const BandResponse &band) {
  const std::size_t parameters = parameters_of(p.type);
  const ModulationQuality quality = modulation_quality(rows, parameters);
  if (parameters < 3 || std::isfinite(quality.weighted_variance))
    return quality;
  return fail(
      ErrorCode::BadInput,
      fmt::format("{} with {} in band \"{}\" cannot tell {}{} (condition number {:.3g}); {}", key,
                  counted(rows.size(), "row"), band.name, quality.missing,
                  quality.missing.size() > 1 ? " apart" : "", quality.condition,
                  rows.size() < parameters ? fmt::format("{} or more are needed", parameters)
                                           : mend_of(p, band.pivot_nm)));
}

namespace {

/// Of a mirror of the port.
const std::string &metal_of(const Telescope &telescope, std::size_t mirror) {
  const bool is_own =
      telescope.port == TelescopePort::Train && !telescope.train.mirrors[mirror].index.empty();
  return is_own ? telescope.train.mirrors[mirror].index : telescope.mirror;
}

} // namespace

Result<std::vector<std::complex<double>>> port_metals(const Telescope &telescope,
                                                      const std::vector<double> &nm) {
  std::vector<std::complex<double>> out;
  for (const double one : nm)
    for (std::size_t m = 0; m < port_mirrors(telescope); ++m) {
      UMOV_ASSIGN(index, find_index(metal_of(telescope, m)));
      UMOV_ASSIGN(value, index_at(index, Wavelength::nm(one)));
      out.push_back(value);
    }
  return out;
}

namespace {

/// Angles that a polarimeter of this type does not have.
void warn_of_idle_angles(PolarimeterType type, const std::vector<SequenceStep> &sequence,
                         Diagnostics &diagnostics) {
  const bool has_analyser = type == PolarimeterType::PolarizerWheel ||
                            type == PolarimeterType::RotatingRetarder ||
                            type == PolarimeterType::Pem;
  if (is_simultaneous(type) && !sequence.empty() &&
      std::ranges::all_of(sequence, [](const auto &step) { return step.band.empty(); })) {
    diagnostics.warn(fmt::format("observation.sequence says nothing to a polarimeter of type "
                                 "\"{}\", which takes everything at once",
                                 name_of(type)));
    return;
  }
  const auto warn = [&](const char *key, bool has_it, auto angle) {
    if (!has_it &&
        std::ranges::any_of(sequence, [&](const auto &step) { return angle(step) != 0; }))
      diagnostics.warn(fmt::format("observation.sequence: {} says nothing to a polarimeter of type "
                                   "\"{}\"",
                                   key, name_of(type)));
  };
  warn("analyser_deg", has_analyser, [](const auto &step) { return step.state.analyser_deg; });
  warn("plate_deg", has_plate(type), [](const auto &step) { return step.state.plate_deg; });
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
    if (scenario.air)
      UMOV_TRY(
          check_air_reaches(bands, *scenario.air, scenario.place("observation.bands"), o.width_nm));
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
    out.turn_ = turn_of(p, o.exposure_s, o.cadence_s);
    const double frames = 90 / out.turn_.per_cadence;
    constexpr double most = 10'000;
    if (!(frames <= most))
      return fail(ErrorCode::BadInput,
                  fmt::format("polarimeter.period_s = {} makes {:.3g} exposures of each quarter "
                              "turn at observation.cadence_s = {}; {} is the limit",
                              p.period_s, frames, o.cadence_s, most),
                  scenario.place("polarimeter.period_s"));
    steps.resize(static_cast<std::size_t>(out.turn_.frames()), steps.front());
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
  // Angles of what has all channels at once are those of its analysers.
  const std::string key =
      p.type == PolarimeterType::FourCamera ? "polarimeter.angles_deg" : "observation.sequence";
  for (std::size_t b = 0; b < bands.size(); ++b) {
    std::vector<StokesRow> rows;
    for (const PolarimeterState &state : states(b)) {
      UMOV_ASSIGN(channels, polarimeter_channels(p, state, bands[b].pivot_nm));
      for (const PolarimeterChannel &channel : channels)
        rows.push_back(channel.row);
    }
    if (rows.empty())
      return fail(ErrorCode::BadInput,
                  fmt::format("observation.sequence has no step in band \"{}\"; add some, or leave "
                              "it out of observation.bands",
                              bands[b].name),
                  scenario.place("observation.sequence"));
    const auto quality = told_by(rows, p, key, bands[b]);
    if (!quality)
      return fail(quality.error().code, quality.error().message, scenario.place(key));
    if (constexpr double poor = 10; parameters_of(p.type) >= 3 && quality->condition > poor)
      diagnostics.warn(fmt::format("{}: the states tell the Stokes parameters badly (condition "
                                   "number {:.3g}, 1.4 to 1.7 is good): their errors will be large",
                                   bands[b].name, quality->condition),
                       scenario.place(key));
  }
  return {};
}

PlannedExposure Programme::at(std::size_t k) const {
  const Step &step = steps_[k % steps_.size()];
  return {{static_cast<std::uint32_t>(k), exposure_s_, turn_.at(step.state, k)},
          step.band,
          k / set_size_};
}

std::vector<PolarimeterState> Programme::states(std::size_t band) const {
  std::vector<PolarimeterState> out;
  for (std::size_t k = 0; k < steps_.size(); ++k)
    if (steps_[k].band == band)
      out.push_back(turn_.at(steps_[k].state, k));
  return out;
}

} // namespace umov::jobs
