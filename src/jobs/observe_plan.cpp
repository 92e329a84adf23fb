#include "jobs/observe_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/io/passband_file.h>
#include <umov/optics/band_grid.h>

namespace umov::jobs {
namespace {

/// States that a polarimeter of this type goes through where nothing else is said.
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
      return fail(own.error().code, "observation.bands: " + own.error().message, {scenario.file});
    bands = std::move(*own);
  }
  UMOV_ASSIGN(grid, BandGrid::make(bands));
  ObservedBands out;
  out.nodes = grid.nodes();
  for (Band &node : out.nodes)
    node.curve = nullptr; // light is computed at the wavelength alone
  for (std::size_t b = 0; b < bands.size(); ++b) {
    UMOV_ASSIGN(response, bands[b].curve
                              ? curve_band(*bands[b].curve)
                              : narrow_band(bands[b].name, bands[b].wavelength.nm(), o.width_nm));
    response.nm.clear();
    response.weight.clear();
    out.index.emplace_back();
    for (const BandTerm &term : grid.terms()[b]) {
      out.index.back().push_back(term.node);
      response.nm.push_back(out.nodes[term.node].wavelength.nm());
      response.weight.push_back(term.weight);
    }
    out.bands.push_back(std::move(response));
  }
  return out;
}

Result<Programme> Programme::make(const ScenarioObservation &o,
                                  const std::vector<BandResponse> &bands) {
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
                              p.period_s, frames, o.cadence_s, most));
    const auto whole = static_cast<std::size_t>(std::max(2.0, std::round(frames)));
    steps.resize(whole, steps.front());
  }
  const auto find = [&](const std::string &name) {
    return static_cast<std::size_t>(
        std::find_if(bands.begin(), bands.end(), [&](const auto &b) { return b.name == name; }) -
        bands.begin());
  };
  for (std::size_t b = 0; b < bands.size(); ++b)
    for (const SequenceStep &step : steps) {
      if (!step.band.empty() && find(step.band) == bands.size())
        return fail(ErrorCode::BadInput,
                    fmt::format("observation.sequence: band \"{}\" is none of observation.bands",
                                step.band));
      if (step.band.empty() || find(step.band) == b)
        out.steps_.push_back({step.state, b});
    }
  out.set_size_ = is_simultaneous(p.type) ? 1 : steps.size();
  UMOV_TRY(out.check(p, bands));
  return out;
}

/// All states of a set together must tell what the type is made for.
Result<void> Programme::check(const Polarimeter &p, const std::vector<BandResponse> &bands) const {
  const std::size_t parameters = parameters_of(p.type);
  if (parameters < 3)
    return {};
  for (const BandResponse &band : bands) {
    std::vector<StokesRow> rows;
    for (std::size_t k = 0; k < set_size_; ++k) {
      UMOV_ASSIGN(channels, polarimeter_channels(p, at(k).plan.state, band.pivot_nm));
      for (const PolarimeterChannel &channel : channels)
        rows.push_back(channel.row);
    }
    const ModulationQuality quality = modulation_quality(rows, parameters);
    if (!std::isfinite(quality.condition) || rows.size() < parameters)
      return fail(ErrorCode::BadInput,
                  fmt::format("the {} rows of observation.sequence cannot tell {} (condition "
                              "number {:.3g}); give other angles",
                              rows.size(), quality.missing.empty() ? "U" : quality.missing,
                              quality.condition));
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
