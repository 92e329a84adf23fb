#include "jobs/curve_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/inverse/sample_errors.h>

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
  const double median = inverse::median_of_i(curve);
  std::vector<Point> out;
  for (const ObservedSample &s : curve.samples) {
    if (s.band != band)
      continue;
    const ObservedEpoch &epoch = curve.epochs[s.epoch];
    const double to = is_at_observer ? epoch.flux_per_intensity : 1;
    const double variance = inverse::errors_of(s, errors, median).i_variance;
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

/// q and u of one sample, and what they weigh together: the inverse of their covariance.
struct Fractions {
  double q = 0, u = 0;
  double w_qq = 0, w_qu = 0, w_uu = 0;
};

/// Of one band, in the scattering plane or as the instrument has them.
std::vector<Fractions> fractions_of(const ObservedCurve &curve, const CurveErrors &errors,
                                    std::size_t band, bool is_at_observer) {
  std::vector<Fractions> out;
  for (const ObservedSample &s : curve.samples) {
    const inverse::SampleErrors known = inverse::errors_of(s, errors, 0);
    if (s.band != band || !(known.l_qq > 0))
      continue;
    const double qq = known.l_qq * known.l_qq + known.l_uq * known.l_uq;
    const double qu = known.l_uq * known.l_uu, uu = known.l_uu * known.l_uu;
    const double twice = is_at_observer ? 2 * curve.epochs[s.epoch].scattering_axis_rad : 0;
    const double c = std::cos(twice), d = std::sin(twice);
    out.push_back({c * s.q - d * s.u, d * s.q + c * s.u, c * c * qq - 2 * c * d * qu + d * d * uu,
                   c * d * (qq - uu) + (c * c - d * d) * qu,
                   d * d * qq + 2 * c * d * qu + c * c * uu});
  }
  return out;
}

/// About the weighted mean.
Squares about_mean(const std::vector<Fractions> &all) {
  Fractions sum;
  double a = 0, b = 0; // weights times values
  for (const Fractions &one : all) {
    sum.w_qq += one.w_qq, sum.w_qu += one.w_qu, sum.w_uu += one.w_uu;
    a += one.w_qq * one.q + one.w_qu * one.u;
    b += one.w_qu * one.q + one.w_uu * one.u;
  }
  const double determinant = sum.w_qq * sum.w_uu - sum.w_qu * sum.w_qu;
  Squares out;
  if (!(determinant > 0))
    return out;
  const double q = (sum.w_uu * a - sum.w_qu * b) / determinant;
  const double u = (sum.w_qq * b - sum.w_qu * a) / determinant;
  for (const Fractions &one : all) {
    const double dq = one.q - q, du = one.u - u;
    out.chi2 += one.w_qq * dq * dq + 2 * one.w_qu * dq * du + one.w_uu * du * du;
  }
  out.dof = 2 * static_cast<double>(all.size()) - 2;
  return out;
}

bool has_fractions(const ObservedCurve &curve, const CurveErrors &errors) {
  return errors.has_polarization && std::ranges::any_of(curve.samples, [](const ObservedSample &s) {
           return !std::isnan(s.q);
         });
}

/// No band's q and u change; true where none were measured.
bool is_steadily_polarized(const ObservedCurve &curve, const CurveErrors &errors) {
  return std::ranges::any_of(std::array{false, true}, [&](bool is_at_observer) {
    Squares sum;
    for (std::size_t b = 0; b < curve.bands.size(); ++b) {
      const Squares one = about_mean(fractions_of(curve, errors, b, is_at_observer));
      sum.chi2 += one.chi2;
      sum.dof += one.dof;
    }
    return chi2_probability(sum.chi2, sum.dof) > likely;
  });
}

std::string text_of_one_epoch(Asked asked) {
  return asked == Asked::Attitude
             ? "one epoch: half a turn about the bisector of Sun and observer leaves I, q and u as "
               "they are (reciprocity), so two attitudes at least explain it; more epochs at other "
               "directions decide"
             : "one epoch: colours and polarization alone tell anything, since the scale is free; "
               "more epochs at other directions decide";
}

std::string text_of_steady(Asked asked, bool has_q) {
  std::string out = has_q ? "brightness and polarization do not change by more than their errors: "
                          : "the brightness does not change by more than its errors: ";
  if (asked == Asked::Attitude)
    return out + "a body that gives as much to all sides does as well, so no attitude is an answer";
  return out + (has_q ? "colours and the mean of q and u" : "colours") +
         " alone tell anything, since the scale is free";
}

} // namespace

bool is_steady(const ObservedCurve &curve, const CurveErrors &errors) {
  const bool is_bright_alike = std::ranges::any_of(std::array{false, true}, [&](bool at_observer) {
    const Squares about = of_all_bands(curve, errors, at_observer, 1);
    return about.dof >= 3 && chi2_probability(about.chi2, about.dof) > likely;
  });
  return is_bright_alike && is_steadily_polarized(curve, errors);
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
  if (!has_q && curve.counts.empty()) // counts of analysers are fitted as they are
    out.emplace_back("no q and u were measured: brightness alone decides");
  if (curve.bands.size() == 1)
    out.emplace_back("one band: colours would tell materials, and so sides of the body, apart");
  if (is_steady(curve, errors))
    out.push_back(text_of_steady(asked, has_fractions(curve, errors)));
  return out;
}

} // namespace umov::jobs
