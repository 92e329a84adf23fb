#include "jobs/curve_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace umov::jobs {
namespace {

constexpr std::size_t most_terms = 3;
constexpr double likely = 0.01; // chance above which a chi-square is no reason to doubt

/// A brightness at a time, with its weight.
struct Point {
  double time = 0, light = 0, weight = 0;
};

/// Points of one band: light at the observer, or of the object.
std::vector<Point> points_of(const ObservedCurve &curve, const CurveErrors &errors,
                             std::size_t band, bool is_at_observer) {
  const CurveLikelihood likelihood(curve, errors);
  std::vector<Point> out;
  for (const ObservedSample &s : curve.samples) {
    if (s.band != band || std::isnan(s.i))
      continue;
    const ObservedEpoch &epoch = curve.epochs[s.epoch];
    const double to = is_at_observer ? epoch.flux_per_intensity : 1;
    const double floor = std::max(errors.floor, best_relative) * std::max(s.i, 0.0);
    const double base = errors.floor_median * likelihood.median_i();
    const double variance = s.i_sd * s.i_sd + floor * floor + base * base;
    if (variance > 0)
      out.push_back({epoch.seconds, s.i * to, 1 / (variance * to * to)});
  }
  return out;
}

/// A sum of squares and what it has left to be free in.
struct Squares {
  double chi2 = 0, dof = 0;
};

/// About the best polynomial of the time with so many terms, by orthogonal ones (Forsythe 1957).
Squares about_polynomial(const std::vector<Point> &points, std::size_t terms) {
  std::vector<std::vector<double>> basis;
  Squares out;
  for (const Point &p : points)
    out.chi2 += p.weight * p.light * p.light;
  if (points.empty())
    return out;
  const auto [first, last] = std::ranges::minmax(points, {}, &Point::time);
  const double middle = (first.time + last.time) / 2;
  const double half = std::max((last.time - first.time) / 2, 1e-9);
  const auto product = [&](auto &&a, auto &&b) {
    double sum = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      sum += points[k].weight * a(k) * b(k);
    return sum;
  };
  for (std::size_t term = 0; term < std::min(terms, most_terms); ++term) {
    std::vector<double> next(points.size());
    for (std::size_t k = 0; k < points.size(); ++k)
      next[k] = std::pow((points[k].time - middle) / half, static_cast<double>(term));
    const auto value = [&](std::size_t k) { return next[k]; };
    const double before = product(value, value);
    for (const std::vector<double> &other : basis) {
      const auto at = [&](std::size_t k) { return other[k]; };
      const double part = product(value, at) / product(at, at);
      for (std::size_t k = 0; k < points.size(); ++k)
        next[k] -= part * other[k];
    }
    const double square = product(value, value);
    if (!(square > 1e-9 * before)) // as many terms as times
      break;
    const double along = product(value, [&](std::size_t k) { return points[k].light; });
    out.chi2 -= along * along / square;
    basis.push_back(std::move(next));
  }
  out.chi2 = std::max(out.chi2, 0.0);
  out.dof = static_cast<double>(points.size() - basis.size());
  return out;
}

Squares of_all_bands(const ObservedCurve &curve, const CurveErrors &errors, bool is_at_observer,
                     std::size_t terms) {
  Squares out;
  for (std::size_t b = 0; b < curve.bands.size(); ++b) {
    const Squares one = about_polynomial(points_of(curve, errors, b, is_at_observer), terms);
    out.chi2 += one.chi2;
    out.dof += one.dof;
  }
  return out;
}

std::string text_of_one_epoch(Asked asked) {
  return asked == Asked::Attitude
             ? "one epoch: half a turn about the bisector of Sun and observer leaves I, q and u as "
               "they are (reciprocity), so two attitudes at least explain it; more epochs at other "
               "directions decide"
             : "one epoch: colours and polarization alone tell anything, since the scale is free; "
               "more epochs at other directions decide";
}

std::string text_of_steady(Asked asked) {
  return asked == Asked::Attitude
             ? "the brightness does not change by more than its errors: what it allows is wide, "
               "and no single attitude of it is an answer"
             : "the brightness does not change by more than its errors: colours and polarization "
               "alone tell anything, since the scale is free";
}

} // namespace

bool is_steady(const ObservedCurve &curve, const CurveErrors &errors) {
  return std::ranges::any_of(std::array{false, true}, [&](bool is_at_observer) {
    const Squares about = of_all_bands(curve, errors, is_at_observer, 1);
    return about.dof >= 3 && chi2_probability(about.chi2, about.dof) > likely;
  });
}

bool shows_no_turn(const ObservedCurve &curve, const CurveErrors &errors) {
  const Squares about = of_all_bands(curve, errors, true, most_terms);
  return chi2_probability(about.chi2, about.dof) > likely;
}

std::vector<std::string> limits_of(const ObservedCurve &curve, const CurveErrors &errors,
                                   Asked asked) {
  std::vector<std::string> out;
  if (curve.epochs.size() == 1)
    out.push_back(text_of_one_epoch(asked));
  const auto measured = [&](std::size_t b, auto take) {
    return std::ranges::count_if(curve.samples, [&](const ObservedSample &s) {
      return s.band == b && !std::isnan(take(s));
    });
  };
  std::size_t with_light = 0;
  bool has_q = false;
  for (std::size_t b = 0; b < curve.bands.size(); ++b) {
    const auto lights = measured(b, [](const ObservedSample &s) { return s.i; });
    const auto fractions = measured(b, [](const ObservedSample &s) { return s.q; });
    with_light += lights > 0 ? 1u : 0u;
    has_q = has_q || fractions > 0;
    if (lights + fractions == 0)
      out.push_back("band " + curve.bands[b] + " holds no measurement");
  }
  if (with_light == 0)
    out.emplace_back("no brightness was measured: q and u alone decide");
  if (!has_q)
    out.emplace_back("no q and u were measured: brightness alone decides");
  if (curve.bands.size() == 1)
    out.emplace_back("one band: colours would tell materials, and so sides of the body, apart");
  if (is_steady(curve, errors))
    out.push_back(text_of_steady(asked));
  return out;
}

} // namespace umov::jobs
