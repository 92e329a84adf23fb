// Runs of particles from all attitudes to the posterior: how many, of how many particles, and what
// they say together.

#include "inverse/attitude_set.h"
#include "inverse/particle_run.h"
#include "inverse/posterior.h"
#include "inverse/sample_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

/// Effective size where copies that have not moved apart count as one: no more than that many are
/// independent.
double different(std::vector<PoseSample> draws) {
  std::ranges::stable_sort(draws, {}, [](const PoseSample &s) { return s.minus_2_log; });
  double squares = 0;
  for (std::size_t k = 0; k < draws.size();) {
    double weight = 0;
    const Quaternion q = draws[k].turning.attitude;
    const double value = draws[k].minus_2_log;
    for (; k < draws.size() && draws[k].minus_2_log == value &&
           angle_between(draws[k].turning.attitude, q) < 1e-7;
         ++k)
      weight += draws[k].weight;
    squares += weight * weight;
  }
  return squares > 0 ? 1 / squares : 0;
}

/// The fewer epochs, the quicker particles are lit, and the more places are alike.
Crowd crowd_of(const ObservedCurve &curve, const SearchOptions &options, bool is_large) {
  constexpr std::size_t first = 20'000;                       // attitudes, at least
  constexpr std::size_t lit = 480'000, lit_large = 1'000'000; // attitudes times epochs
  constexpr std::size_t short_epochs = 20;                    // of a curve that leaves much alike
  constexpr std::size_t wide = 80, most = 10; // a large one: samples times 80 over epochs, or ten
  constexpr std::size_t most_of = 20;         // times a grid that was told to be small
  const std::size_t epochs = std::max<std::size_t>(curve.epochs.size(), 1);
  Crowd out;
  if (is_large) {
    out.first = std::min(std::max(first, lit_large / epochs), most_of * options.grid);
    out.followed = options.samples * std::clamp<std::size_t>(wide / epochs, 2, most);
  } else {
    out.first = std::min(std::max(first, lit / epochs), most_of * options.grid);
    out.followed = options.samples * (epochs <= short_epochs ? 2 : 1);
  }
  constexpr double tenth = 0.1;
  out.wanted =
      std::max(static_cast<double>(options.samples) / 2, tenth * static_cast<double>(out.followed));
  return out;
}

/// Runs as one sample: each counts by its evidence and by how many it followed, and the mean of the
/// evidences is the evidence.
Samples pooled(const std::vector<Samples> &runs, const std::vector<double> &followed) {
  Samples out;
  std::vector<double> log_weights;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const PoseSample &s : runs[r].draws) {
      out.draws.push_back(s);
      out.runs.push_back(r);
      log_weights.push_back(runs[r].log_evidence + std::log(followed[r] * s.weight));
    }
  out.log_evidence = normalize(out.draws, log_weights) -
                     std::log(std::accumulate(followed.begin(), followed.end(), 0.0));
  return out;
}

/// The largest less the least of their ln evidences.
double apart(const std::vector<Samples> &runs) {
  const auto less = [](const Samples &a, const Samples &b) {
    return a.log_evidence < b.log_evidence;
  };
  const auto [least, most] = std::minmax_element(runs.begin(), runs.end(), less);
  return most->log_evidence - least->log_evidence;
}

bool are_alike(const std::vector<Samples> &runs) { return apart(runs) < alike_evidences; }

} // namespace

Samples sample_all(const CurveModel &quick, const CurveModel &last,
                   const CurveLikelihood &likelihood, const std::vector<PoseMode> &modes,
                   const SearchOptions &options) {
  // Short curves leave the most open, and are lit the quickest.
  constexpr std::size_t least = 2, most_runs = 4, short_epochs = 20;
  const std::size_t epochs = std::max<std::size_t>(quick.curve().epochs.size(), 1);
  const std::size_t most =
      options.needs_set ? std::clamp(most_runs * short_epochs / epochs, least, most_runs) : 1;
  constexpr double little = 2; // of the growth of a set that its runs agree on
  std::vector<Samples> runs;
  std::vector<double> followed;
  Samples out;
  for (std::uint32_t run = 0; run < most; ++run) {
    const Crowd crowd = crowd_of(quick.curve(), options, run >= least && !are_alike(runs));
    runs.push_back(ParticleRun(quick, last, likelihood, modes, options, run, crowd).samples());
    if (runs.back().draws.empty())
      return {};
    followed.push_back(static_cast<double>(crowd.followed));
    out = pooled(runs, followed);
    if (run > 0 && are_alike(runs) && highest_density(out.draws, {}, out.runs).growth < little)
      break;
  }
  out.evidences_apart = apart(runs);
  out.effective = different(out.draws);
  return out;
}

} // namespace umov::inverse
