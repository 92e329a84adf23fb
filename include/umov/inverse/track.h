#pragma once
// An attitude that is followed from epoch to epoch by a bank of filters: docs/theory/inverse.md,
// section 14.

#include <umov/core/result.h>
#include <umov/inverse/curve_model.h>
#include <umov/inverse/pose_search.h>
#include <utility>

namespace umov {

/// How a bank follows.
struct TrackOptions {
  /// `median_i` is to be said: what an epoch tells may not depend on those that follow.
  CurveErrors errors;
  /// Random walk of the rate about each body axis [rad/s/sqrt(s)]; 0: the rate is constant.
  double rate_noise = 0;
  unsigned threads = 0; ///< the answer does not depend on it
};

/// One filter: a way to be turned, as normal as a filter takes it for.
struct TrackMode {
  std::size_t number = 0; ///< its name; filters that came of splitting one have new ones
  Turning turning;        ///< attitude now, and rate
  /// Gain of each band (of the epoch alone in clouds), then parts as
  /// `CurveLikelihood::FittedLight::off`.
  std::vector<double> nuisances;
  /// Of the rotation vector in body axes [rad], the rate [rad/s] and the nuisances: row-major.
  std::vector<double> covariance;
  double log_weight = 0;        ///< ln of its share of the probability
  double scale = 1;             ///< gain that it began with: where clouds begin anew
  double chi2 = 0;              ///< of all innovations so far
  std::size_t measurements = 0; ///< as many numbers
};
/// A filter of an attitude and rate with their covariance, 6 x 6, row-major: gains of `bands`
/// normal about `scale` (as it is, or as far as absolute light says), parts as far off as their
/// priors.
TrackMode track_mode(const Turning &turning, const std::vector<double> &covariance, double scale,
                     bool is_absolute, std::size_t bands, const std::vector<PartKind> &parts,
                     const CurveErrors &errors);
/// Filters of fixed attitudes that are known by samples of their posterior, where these are no few
/// peaks: one around each, half as wide as four neighbours lie apart, of the heaviest 4000 or those
/// that hold all but a thousandth; heaviest first. The rate about each axis is 0 to `rate_sd`
/// [rad/s].
std::vector<TrackMode> track_modes_around(std::vector<PoseSample> samples, double rate_sd,
                                          bool is_absolute, std::size_t bands,
                                          const std::vector<PartKind> &parts,
                                          const CurveErrors &errors);
/// The same turning later, its rate constant but for a random walk (`TrackOptions::rate_noise`).
TrackMode turned_on(const TrackMode &mode, double seconds, double rate_noise);

/// Why a bank no longer knows.
enum class TrackLoss {
  None,   ///< it knows
  Misfit, ///< the heaviest explains none of three measured epochs that follow each other
  Open    ///< filters of 1 % and more are open to pi/sqrt(3) rad about some axis: all around
};

/// What a bank knows beside its modes.
struct TrackMemory {
  std::size_t misses = 0;      ///< measured epochs since the last that was explained: 3 are a loss
  std::size_t next_number = 0; ///< of the filter that comes next; 0: one above those that there are
  /// The light of some epoch bent, or left open, more than there is room for in filters: what they
  /// say since then may be far off.
  bool is_wide = false;
  /// Filters were wide once, and spread over narrow ones: that of the truth may have been led away.
  bool was_spread = false;
};

/// What a bank made of an epoch.
struct TrackStep {
  std::vector<double> chi2;         ///< of the innovation, of each mode that is left; NaN: none
  std::size_t measurements = 0;     ///< numbers that were measured
  std::vector<std::size_t> dropped; ///< modes below e^-20 of the best
  std::vector<std::pair<std::size_t, std::size_t>> joined; ///< the first became part of the second
  std::size_t spread = 0; ///< places that wide filters were spread over; 0: none was
  /// Light of the heaviest mode [band], its parts as it has them; empty without measurements.
  std::vector<double> i, q, u;
  std::size_t poses_lit = 0;
};

/// Filters with weights.
class AttitudeBank {
public:
  /// `modes`: heaviest first, their weights add up to one; `light` gives those bands, which an
  /// epoch's samples name by their place.
  AttitudeBank(std::vector<TrackMode> modes, PoseLighting light, std::vector<std::string> bands,
               std::vector<PartKind> parts, const TrackOptions &options);
  /// Goes on by `seconds` to `epoch`, a curve of one epoch in the bands of this bank; without a
  /// measurement that is all, else all filters learn from it. Interrupted if the light stopped.
  Result<TrackStep> step(const ObservedCurve &epoch, double seconds);
  /// Heaviest first.
  [[nodiscard]] const std::vector<TrackMode> &modes() const { return modes_; }
  /// Why it no longer knows; what it makes of later epochs is nothing.
  [[nodiscard]] TrackLoss loss() const { return loss_; }
  /// What it keeps from step to step.
  [[nodiscard]] const TrackMemory &memory() const { return memory_; }
  /// Goes on from where a bank of these modes had been.
  void set_memory(const TrackMemory &memory) { memory_ = memory; }

private:
  Result<void> learn(const ObservedCurve &epoch, TrackStep &out);
  void look_for_opening(double seconds);
  Result<void> spread_wide(const CurveModel &model, TrackStep &out);
  void sort_by_weight(TrackStep &out);
  void settle(TrackStep &out);
  void drop_light(TrackStep &out);
  void join_near(TrackStep &out);
  void look_for_loss(const TrackStep &now);

  std::vector<TrackMode> modes_;
  PoseLighting light_;
  std::vector<std::string> bands_;
  std::vector<PartKind> parts_;
  TrackOptions options_;
  TrackMemory memory_;
  TrackLoss loss_ = TrackLoss::None;
};

} // namespace umov
