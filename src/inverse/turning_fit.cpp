#include "inverse/turning_fit.h"

#include "algebra/dense.h"
#include "inverse/chords.h"
#include "inverse/neighbours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <umov/inverse/attitude_grid.h>

namespace umov::inverse {
namespace {

using Residuals = Eigen::Map<const Eigen::VectorXd>;

/// What a fit takes its derivatives from.
enum class Stage {
  Rough, ///< neighbours that are as far in each direction
  Fine,  ///< half a width away
  Last,  ///< the first again: masks are steps, in whose dents fine derivatives rest
};

/// One fit on its way.
struct Running {
  TurningFit fit;
  std::vector<double> residuals;
  Eigen::VectorXd gradient;
  double damping = 1e-2;
  int idle = 0;         ///< iterations in a row that gained next to nothing
  bool is_stale = true; ///< its derivatives are of another place, or of other neighbours
  Stage stage = Stage::Rough;
  int refused = 0; ///< steps in a row that gained nothing
  double chi2_at_cut = std::numeric_limits<double>::infinity(); ///< the last
};

/// Those that still move.
std::vector<Running *> moving(std::vector<Running> &fits) {
  std::vector<Running *> out;
  for (Running &one : fits)
    if (!one.fit.is_converged)
      out.push_back(&one);
  return out;
}

Neighbours neighbours_of(const Running &one, const FitPlan &plan) {
  return one.stage == Stage::Fine
             ? Neighbours::half_widths(one.fit.information, plan.difference_rad)
             : Neighbours::alike(static_cast<Eigen::Index>(plan.freedom), plan.difference_rad);
}

/// J^T J and J^T r of all fits by differences of neighbours, lit together.
bool differentiate(const CurveModel &model, const CurveLikelihood &likelihood,
                   std::vector<Running *> fits, std::span<const std::size_t> epochs,
                   const FitPlan &plan) {
  std::erase_if(fits, [](const Running *one) { return !one->is_stale; });
  const double span = span_of(model.curve(), epochs);
  std::vector<Neighbours> where;
  std::vector<Turning> near;
  std::vector<std::span<const double>> parts; // from which a whole fit would find the same again
  for (const Running *one : fits) {
    where.push_back(neighbours_of(*one, plan));
    for (std::size_t p = 0; p < where.back().count(); ++p) {
      near.push_back(stepped(one->fit.turning, where.back().step(p), span));
      parts.emplace_back(one->fit.at.off);
    }
  }
  const auto compared = compare_all(model, likelihood, near, epochs, plan.threads, true, parts);
  if (compared.empty() && !near.empty())
    return false;
  std::vector<const std::vector<double> *> residuals;
  residuals.reserve(compared.size());
  for (const Comparison &one : compared)
    residuals.push_back(&one.residuals);
  std::span<const std::vector<double> *const> rest(residuals);
  for (std::size_t k = 0; k < fits.size(); rest = rest.subspan(where[k++].count())) {
    Running &one = *fits[k];
    const Eigen::MatrixXd jacobian = where[k].jacobian(one.residuals, rest.first(where[k].count()));
    one.fit.information = algebra::gram(jacobian);
    one.gradient = algebra::transposed_times(
        jacobian, Residuals(one.residuals.data(), static_cast<Eigen::Index>(one.residuals.size())));
  }
  return true;
}

Step step_of(const Running &one) {
  const Eigen::MatrixXd &a = one.fit.information;
  const double largest = std::max(a.diagonal().maxCoeff(), 1e-12);
  Eigen::MatrixXd damped = a;
  damped.diagonal() += one.damping * (a.diagonal().array() + 1e-6 * largest).matrix();
  // What the light does not tell is not stepped by: its derivatives are rounding.
  constexpr double untold = 0.8; // [rad]: nothing is known beyond it
  damped.diagonal().array() += 1 / (untold * untold);
  Step step = -algebra::solve_symmetric(damped, one.gradient);
  constexpr double longest = 0.15; // [rad]: beyond it the light is another one
  const double length = step.norm();
  return length > longest ? Step(step * (longest / length)) : step;
}

/// The fit goes on by other derivatives: rough ones creep along a valley, or stand still in it.
void go_on(Running &one, Stage stage) {
  one.stage = stage;
  one.is_stale = true;
  one.damping = stage == Stage::Fine ? 1e-5 : 1e-2;
  one.idle = one.refused = 0;
  one.chi2_at_cut = std::numeric_limits<double>::infinity(); // what it gained so far says nothing
}

/// Takes a step that gained, shortens the next if it did not. At the bottom neither gains: a valley
/// that bends gives little in each step and much in a hundred of them, so that few gains of little
/// are no end.
void take(Running &one, const Turning &tried, const Comparison &compared) {
  constexpr double near = 1, least = 0.01, stuck = 1e5; // of chi-square; of the damping
  constexpr int patience = 3, refusals = 2;
  const double gain = one.fit.at.chi2 - compared.chi2;
  one.is_stale = gain > 0;
  if (gain > 0) {
    one.fit.turning = tried;
    one.fit.at = compared;
    one.residuals = compared.residuals;
    one.damping = std::max(one.damping / 5, one.stage == Stage::Fine ? 1e-10 : 1e-6);
    one.refused = 0;
    one.idle = gain < least ? one.idle + 1 : 0;
  } else {
    one.damping *= 6;
    ++one.refused;
  }
  const bool is_at_rest = one.idle >= patience || !(one.damping < stuck);
  if (one.stage == Stage::Rough && ((gain > 0 && gain < near) || one.refused == refusals))
    go_on(one, Stage::Fine);
  else if (one.stage == Stage::Fine && is_at_rest)
    go_on(one, Stage::Last);
  else
    one.fit.is_converged = is_at_rest;
}

/// The derivatives that a covariance is told from.
bool ask_covariances(const CurveModel &model, const CurveLikelihood &likelihood,
                     std::vector<Running> &fits, std::span<const std::size_t> epochs,
                     const FitPlan &plan) {
  std::vector<Running *> all;
  for (Running &one : fits) {
    if (one.stage == Stage::Last)
      go_on(one, Stage::Fine); // rough ones make a valley too short
    all.push_back(&one);
  }
  return differentiate(model, likelihood, all, epochs, plan);
}

/// The same turning, as far as a fit on its way tells.
bool is_same(const Turning &a, const Turning &b, double span_s) {
  constexpr double near = 5e-3; // [rad]
  // A step's tilts and turns, one after the other, turn by no more than the three of them.
  if (chord_square(a.attitude, b.attitude) > chord_square(3 * near))
    return false;
  const Step step = step_between(a, b, 6, span_s);
  return step.head(3).norm() < near && step.tail(3).norm() < near;
}

/// The best, sorted, of those that came together one each: a wide basin would crowd out the rest.
void keep_best(std::vector<Running> &fits, std::size_t count, double span_s) {
  std::ranges::stable_sort(fits, {}, [](const Running &r) { return r.fit.at.chi2; });
  std::vector<Running> out;
  for (Running &one : fits) {
    if (out.size() == count)
      break;
    if (std::ranges::none_of(out, [&](const Running &better) {
          return is_same(better.fit.turning, one.fit.turning, span_s);
        }))
      out.push_back(std::move(one));
  }
  fits = std::move(out);
}

/// Takes away fits that would not reach the best even if they went on to gain twice as fast as
/// since the last cut; a peak that far below holds e^-30 of the probability.
void drop_hopeless(std::vector<Running> &fits, double cuts_left) {
  constexpr double far = 60, hope = 2; // chi-square; beside the gain seen
  double best = std::numeric_limits<double>::infinity();
  for (const Running &one : fits)
    best = std::min(best, one.fit.at.chi2);
  std::erase_if(fits, [&](const Running &one) {
    const double gain = one.chi2_at_cut - one.fit.at.chi2;
    return one.fit.at.chi2 - best - far > hope * gain * cuts_left;
  });
  for (Running &one : fits)
    one.chi2_at_cut = one.fit.at.chi2;
}

} // namespace

double farthest_of(const ObservedCurve &curve, std::span<const std::size_t> epochs) {
  double out = 0;
  if (epochs.empty())
    for (const ObservedEpoch &epoch : curve.epochs)
      out = std::max(out, std::abs(epoch.seconds));
  for (const std::size_t e : epochs)
    out = std::max(out, std::abs(curve.epochs[e].seconds));
  return out;
}

double span_of(const ObservedCurve &curve, std::span<const std::size_t> epochs) {
  return std::max(1.0, farthest_of(curve, epochs));
}

std::vector<Turning> spread_out(const std::vector<Turning> &sorted, std::size_t count,
                                double apart_rad) {
  std::vector<Turning> out;
  const double near = chord_square(apart_rad);
  for (const Turning &t : sorted) {
    if (out.size() >= count)
      break;
    if (std::ranges::none_of(
            out, [&](const Turning &o) { return chord_square(o.attitude, t.attitude) < near; }))
      out.push_back(t);
  }
  return out;
}

std::vector<Turning> turnings_of(const std::vector<TurningFit> &fits, std::size_t count) {
  std::vector<Turning> out;
  for (std::size_t j = 0; j < std::min(fits.size(), count); ++j)
    out.push_back(fits[j].turning);
  return out;
}

std::vector<Comparison> compare_all(const CurveModel &model, const CurveLikelihood &likelihood,
                                    std::span<const Turning> turnings,
                                    std::span<const std::size_t> epochs, unsigned threads,
                                    bool keeps_residuals,
                                    std::span<const std::span<const double>> near) {
  std::vector<Comparison> out(turnings.size());
  const bool is_whole =
      model.for_each(turnings, epochs, threads, [&](std::size_t k, const ModelLight &light) {
        out[k] = likelihood.compare(light, near.empty() ? std::span<const double>() : near[k]);
        if (!keeps_residuals)
          out[k].residuals = {};
      });
  return is_whole ? out : std::vector<Comparison>();
}

std::vector<TurningFit> fit_turnings(const CurveModel &model, const CurveLikelihood &likelihood,
                                     std::vector<Turning> starts,
                                     std::span<const std::size_t> epochs, const FitPlan &plan) {
  const double span = span_of(model.curve(), epochs);
  const auto first = compare_all(model, likelihood, starts, epochs, plan.threads, true);
  std::vector<Running> fits(first.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    fits[k].fit.turning = starts[k];
    fits[k].fit.at = first[k];
    fits[k].residuals = first[k].residuals;
  }
  for (int iteration = 0; iteration < plan.iterations; ++iteration) {
    if (plan.cut_after > 0 && iteration > 0 && iteration % plan.cut_after == 0) {
      keep_best(fits, plan.kept, span);
      if (plan.drops_hopeless)
        drop_hopeless(fits, static_cast<double>(plan.iterations - iteration) / plan.cut_after);
    }
    const auto active = moving(fits);
    if (active.empty())
      break;
    if (!differentiate(model, likelihood, active, epochs, plan))
      return {};
    std::vector<Turning> tried;
    tried.reserve(active.size());
    for (const Running *one : active)
      tried.push_back(stepped(one->fit.turning, step_of(*one), span));
    const auto compared = compare_all(model, likelihood, tried, epochs, plan.threads, true);
    if (compared.empty())
      return {};
    for (std::size_t k = 0; k < active.size(); ++k)
      take(*active[k], tried[k], compared[k]);
  }
  if (plan.tells_covariance && !ask_covariances(model, likelihood, fits, epochs, plan))
    return {};
  keep_best(fits, fits.size(), span);
  std::vector<TurningFit> out;
  for (Running &one : fits) {
    one.fit.at.residuals = {};
    out.push_back(std::move(one.fit));
  }
  return out;
}

} // namespace umov::inverse
