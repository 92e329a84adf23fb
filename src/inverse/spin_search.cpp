#include <umov/inverse/spin_search.h>

#include "algebra/dense.h"
#include "inverse/attitude_set.h"
#include "inverse/tempered.h"
#include "inverse/turning_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <umov/core/median.h>
#include <umov/inverse/attitude_grid.h>

namespace umov {

using inverse::degree;
using inverse::Freedom;
using inverse::stopped;
using inverse::tempered;
using inverse::TurningFit;

namespace {

/// Directions spread evenly over the sphere (Fibonacci's lattice: Swinbank & Purser 2006).
std::vector<Vec3<Body>> axes_of(const SpinRequest &request) {
  if (request.axis)
    return {*request.axis, *request.axis * -1};
  std::vector<Vec3<Body>> out;
  const double golden = pi * (3 - std::sqrt(5.0));
  for (std::size_t k = 0; k < request.axes; ++k) {
    const double z = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(request.axes);
    const double r = std::sqrt(1 - z * z), a = golden * static_cast<double>(k);
    out.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return out;
}

/// Epochs within a stretch about second 0, `most` at most.
std::vector<std::size_t> within(const ObservedCurve &curve, double half_s, std::size_t most) {
  std::vector<std::size_t> all;
  for (std::size_t e = 0; e < curve.epochs.size(); ++e)
    if (std::abs(curve.epochs[e].seconds) <= half_s)
      all.push_back(e);
  if (all.size() <= most)
    return all;
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < most; ++k)
    out.push_back(all[k * (all.size() - 1) / (most - 1)]);
  return out;
}

/// Turnings that the light itself is asked about.
constexpr std::size_t most_starts = 60;

/// A turning and how well it does.
struct Candidate {
  Turning turning;
  double chi2 = 0;
};

void keep_best(std::vector<Candidate> &all, std::size_t count) {
  std::ranges::stable_sort(all, {}, &Candidate::chi2);
  all.resize(std::min(all.size(), count));
}

std::vector<Turning> turnings_of(const std::vector<Candidate> &candidates) {
  std::vector<Turning> out;
  out.reserve(candidates.size());
  for (const Candidate &c : candidates)
    out.push_back(c.turning);
  return out;
}

/// The same attitude and the same spin, nearly: over `reach_s` the bodies do not part by more.
bool is_near(const Turning &a, const Turning &b, double angle, double reach_s) {
  const Vec3<Body> u = normalized(a.rate_rad_s), v = normalized(b.rate_rad_s);
  return angle_between(a.attitude, b.attitude) < angle && dot(u, v) > std::cos(angle) &&
         std::abs(norm(a.rate_rad_s) - norm(b.rate_rad_s)) * reach_s < angle;
}

/// How far a fit lets the body turn further or less over one span of its epochs [rad].
double phase_sd(const TurningFit &fit, std::size_t measurements) {
  const Eigen::MatrixXd covariance = algebra::pseudo_inverse(fit.information);
  const Vec3<Body> axis = normalized(fit.turning.rate_rad_s);
  const Eigen::Vector3d u(axis.x, axis.y, axis.z);
  const double worse = std::max(1.0, fit.at.chi2 / static_cast<double>(measurements));
  return std::sqrt(std::max(0.0, u.dot(covariance.bottomRightCorner(3, 3) * u) * worse));
}

/// A pause between passes, rather than a step between exposures [s].
double pause_of(const ObservedCurve &curve, const SpinRequest &request) {
  std::vector<double> steps;
  for (std::size_t e = 1; e < curve.epochs.size(); ++e)
    steps.push_back(curve.epochs[e].seconds - curve.epochs[e - 1].seconds);
  return std::max(2.5 * *std::ranges::max_element(request.periods_s),
                  steps.empty() ? 0.0 : 10 * median_of(steps));
}

/// The second in the middle of the longest stretch without a pause: where an attitude and a rate
/// are first found, there should be light on both sides.
double middle_of_longest(const std::vector<ObservedEpoch> &epochs, double pause_s) {
  std::size_t best_begin = 0, best_end = 0, begin = 0;
  for (std::size_t e = 1; e <= epochs.size(); ++e) {
    if (e < epochs.size() && epochs[e].seconds - epochs[e - 1].seconds <= pause_s)
      continue;
    if (e - begin > best_end - best_begin) {
      best_begin = begin;
      best_end = e;
    }
    begin = e;
  }
  return epochs[(best_begin + best_end) / 2].seconds;
}

/// Search of one period, on a curve whose second 0 is its middle.
class PeriodSearch {
public:
  PeriodSearch(const CurveModel &coarse, const CurveModel &coarsest, const SpinRequest &request,
               const SearchOptions &options, double period_s)
      : coarse_(coarse), coarsest_(coarsest), request_(request), options_(options),
        period_s_(period_s) {}

  /// A few starts for the last fits; none if it was stopped.
  std::vector<Candidate> run();

private:
  bool judge(const CurveModel &model, std::size_t epochs_max, const std::vector<Turning> &turnings,
             std::vector<Candidate> &found) const;
  bool look_at_grid(std::vector<Candidate> &found) const;
  bool lengthen(std::vector<Candidate> &found);
  [[nodiscard]] std::optional<double> next_reach(double told_s) const;
  [[nodiscard]] bool is_pause(double told_s, double next_s) const;
  void fan_out(std::span<const TurningFit> fits, double span_s, double next_s,
               std::size_t measurements, std::vector<Candidate> &found) const;

  const CurveModel &coarse_, &coarsest_;
  const SpinRequest &request_;
  const SearchOptions &options_;
  double period_s_;
};

bool PeriodSearch::judge(const CurveModel &model, std::size_t epochs_max,
                         const std::vector<Turning> &turnings,
                         std::vector<Candidate> &found) const {
  const auto epochs = within(coarse_.curve(), 1.25 * period_s_, epochs_max);
  const CurveLikelihood rough(coarse_.curve(), tempered(options_.errors, coarse_.curve(), 0.25),
                              epochs);
  const auto compared = inverse::compare_all(model, rough, turnings, epochs, options_.threads);
  for (std::size_t k = 0; k < compared.size(); ++k)
    found.push_back({turnings[k], compared[k].chi2});
  return !compared.empty();
}

bool PeriodSearch::look_at_grid(std::vector<Candidate> &found) const {
  // On sixteen epochs a spin of a cubesat that flashes, ten degrees off at best on this grid, stood
  // behind tens of thousands of others.
  constexpr std::size_t few = 8, many = 32;
  constexpr std::size_t after_few = 150'000, after_many = 60'000, kept = 6000;
  const auto attitudes = attitude_grid(request_.attitudes);
  const double rate = 2 * pi / period_s_;
  for (const Vec3<Body> &axis : axes_of(request_)) {
    std::vector<Turning> tried;
    for (const Quaternion &q : attitudes)
      tried.push_back({q, axis * rate});
    if (!judge(coarsest_, few, tried, found))
      return false;
    if (found.size() > 2 * after_few)
      keep_best(found, after_few);
  }
  keep_best(found, after_few);
  const auto again = [&](const CurveModel &model, std::size_t left) {
    const std::vector<Turning> tried = turnings_of(found);
    found.clear();
    const bool is_whole = judge(model, many, tried, found);
    keep_best(found, left);
    return is_whole;
  };
  return again(coarsest_, after_many) && again(coarse_, kept);
}

/// As far as the next stretch goes: twice as far, or, over a pause, two and a half turns into what
/// follows it. Nothing after the last epoch.
std::optional<double> PeriodSearch::next_reach(double told_s) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ObservedEpoch &epoch : coarse_.curve().epochs)
    if (const double away = std::abs(epoch.seconds); away > told_s)
      nearest = std::min(nearest, away);
  if (!std::isfinite(nearest))
    return std::nullopt;
  return is_pause(told_s, nearest) ? nearest + 2.5 * period_s_
                                   : 2 * std::max(told_s, 1.25 * period_s_);
}

/// Between the farthest epoch that was fitted and the next.
bool PeriodSearch::is_pause(double told_s, double next_s) const {
  return next_s > 2 * std::max(told_s, 1.25 * period_s_);
}

/// The fits, and where a pause leaves open how often the body turned in it, each number of turns
/// and part of one: a fit comes to rest in the nearest of the valleys only.
void PeriodSearch::fan_out(std::span<const TurningFit> fits, double span_s, double next_s,
                           std::size_t measurements, std::vector<Candidate> &found) const {
  constexpr double step_rad = 0.25, widest = 4; // of a turn: valleys are wider; standard deviations
  constexpr double most = 60;
  for (const TurningFit &fit : fits) {
    found.push_back({fit.turning, fit.at.chi2});
    const double rate = norm(fit.turning.rate_rad_s);
    const double open_rad = widest * phase_sd(fit, measurements) * next_s / span_s;
    if (!(rate > 0) || !(open_rad > step_rad))
      continue;
    const int each = static_cast<int>(std::min(most, open_rad / step_rad));
    for (int k = -each; k <= each; ++k)
      if (k != 0)
        found.push_back(
            {{fit.turning.attitude, fit.turning.rate_rad_s * (1 + k * step_rad / (next_s * rate))},
             fit.at.chi2});
  }
}

/// Fits in six unknowns on stretches that double until they are the whole curve.
bool PeriodSearch::lengthen(std::vector<Candidate> &found) {
  const auto &curve = coarse_.curve();
  std::size_t kept = 1500;
  // Light between nodes is some per cent off: it prefers others to the truth by tens of chi-square,
  // and each of them comes as often as the body looks alike. Half of `last` are left in the end.
  constexpr std::size_t epochs_max = 120, last = 120, fanned = 30;
  bool is_fanned = false;
  for (std::optional<double> reach_s = 1.25 * period_s_; reach_s;) {
    const auto epochs = within(curve, *reach_s, epochs_max);
    const CurveLikelihood rough(curve, tempered(options_.errors, curve, 0.15), epochs);
    std::vector<Turning> starts;
    for (const Candidate &c : found)
      if ((is_fanned || starts.size() < kept) &&
          std::ranges::none_of(starts, [&](const Turning &o) {
            return is_near(o, c.turning, 1 * degree, *reach_s);
          }))
        starts.push_back(c.turning);
    const double told_s = inverse::farthest_of(curve, epochs);
    reach_s = next_reach(told_s);
    is_fanned = reach_s && is_pause(told_s, *reach_s);
    const auto fits = inverse::fit_turnings(coarse_, rough, starts, epochs,
                                            {.freedom = Freedom::AttitudeAndRate,
                                             .iterations = 6,
                                             .cut_after = 2,
                                             .kept = kept / 2,
                                             .difference_rad = 5e-3,
                                             .threads = options_.threads,
                                             .tells_covariance = is_fanned});
    if (fits.empty())
      return false;
    found.clear();
    if (is_fanned)
      fan_out(std::span(fits).first(std::min(fanned, fits.size())), inverse::span_of(curve, epochs),
              *reach_s, rough.measurements(), found);
    else
      for (const TurningFit &fit : fits)
        found.push_back({fit.turning, fit.at.chi2});
    kept = std::max(last, kept / 3);
  }
  return true;
}

std::vector<Candidate> PeriodSearch::run() {
  std::vector<Candidate> found;
  if (!look_at_grid(found) || !lengthen(found))
    return {};
  std::vector<Candidate> out;
  for (const Candidate &c : found)
    if (out.size() < most_starts && std::ranges::none_of(out, [&](const Candidate &o) {
          return is_near(o.turning, c.turning, 2 * degree, inverse::span_of(coarse_.curve()));
        }))
      out.push_back(c);
  return out;
}

/// The attitude at another time of the same spin.
Turning moved(const Turning &turning, double seconds) {
  return {attitude_at(turning, seconds), turning.rate_rad_s};
}

/// A mode at another time: its covariance goes through the derivatives of the motion, which are
/// taken by differences.
void move(PoseMode &mode, double seconds) {
  const Turning end = moved(mode.turning, seconds);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(6, 6);
  for (int k = 0; k < 6; ++k) {
    const double h = k < 3 ? 1e-5 : 1e-5 / std::max(1.0, std::abs(seconds));
    Turning near = mode.turning;
    const Eigen::Vector3d step = Eigen::Vector3d::Unit(k % 3) * h;
    if (k < 3)
      near.attitude = turned(near.attitude, {step[0], step[1], step[2]});
    else
      near.rate_rad_s = near.rate_rad_s + Vec3<Body>{step[0], step[1], step[2]};
    near = moved(near, seconds);
    const Vec3<Body> turn = turn_between(end.attitude, near.attitude) * (1 / h);
    jacobian.col(k).head(3) << turn.x, turn.y, turn.z;
  }
  const Eigen::Map<Eigen::MatrixXd> covariance(mode.covariance.data(), 6, 6);
  const Eigen::MatrixXd at_end =
      algebra::product(algebra::product(jacobian, covariance), jacobian.transpose());
  std::copy_n(at_end.data(), at_end.size(), mode.covariance.begin());
  mode.turning = end;
}

std::vector<SpinPeriod> periods_of(const PoseAnswer &answer, std::span<const double> tried) {
  std::vector<SpinPeriod> out;
  for (std::size_t t = 0; t < tried.size(); ++t) {
    double weight = 0, mean = 0, square = 0;
    for (const PoseSample &s : answer.samples) {
      const double period = 2 * pi / norm(s.turning.rate_rad_s);
      const auto nearest = std::ranges::min_element(
          tried, {}, [&](double p) { return std::abs(std::log(p / period)); });
      if (nearest - tried.begin() != static_cast<std::ptrdiff_t>(t))
        continue;
      weight += s.weight;
      mean += s.weight * period;
      square += s.weight * period * period;
    }
    if (!(weight > 1e-6))
      continue;
    mean /= weight;
    out.push_back({mean, std::sqrt(std::max(0.0, square / weight - mean * mean)), weight, t});
  }
  std::ranges::stable_sort(out, std::ranges::greater{}, &SpinPeriod::weight);
  return out;
}

} // namespace

Result<SpinAnswer> search_spin(const ObservedCurve &curve, const PoseLighting &light,
                               const std::vector<std::size_t> &column, const SpinRequest &request,
                               const SearchOptions &options) {
  if (request.periods_s.empty() || curve.epochs.empty())
    return fail(ErrorCode::BadInput, "no period to be tried, or no epoch");
  ObservedCurve middle = curve;
  const double shift = middle_of_longest(curve.epochs, pause_of(curve, request));
  for (ObservedEpoch &epoch : middle.epochs)
    epoch.seconds -= shift;
  const CurveModel model(middle, light, column, request.parts);
  const CurveModel first(middle, request.first ? request.first : light, column, request.parts);
  const PoseLighting &blurred = request.coarse ? request.coarse : light;
  const CurveModel coarse(middle, blurred, column);
  const CurveModel coarsest(middle, request.coarsest ? request.coarsest : blurred, column);
  std::vector<Candidate> found_of_all;
  for (std::size_t k = 0; k < request.periods_s.size(); ++k) {
    if (options.progress)
      options.progress("spin", k, request.periods_s.size() + 1);
    const auto found = PeriodSearch(coarse, coarsest, request, options, request.periods_s[k]).run();
    if (found.empty())
      return tl::unexpected(stopped());
    found_of_all.insert(found_of_all.end(), found.begin(), found.end());
  }
  // Those of each period were compared at the same epochs, which are of the whole curve. Quick
  // light tells then which of the best the light itself is asked about.
  keep_best(found_of_all, most_starts);
  UMOV_ASSIGN(answer, refine_spin(model, first, turnings_of(found_of_all), options));
  for (PoseMode &mode : answer.modes)
    move(mode, -shift);
  for (PoseSample &sample : answer.samples)
    sample.turning = moved(sample.turning, -shift);
  answer.set95 = inverse::highest_density(answer.samples, answer.modes).balls;
  answer.share_of_so3 = inverse::share_of(answer.set95);
  SpinAnswer out;
  out.periods = periods_of(answer, request.periods_s);
  out.pose = std::move(answer);
  return out;
}

} // namespace umov
