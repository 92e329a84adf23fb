#include <umov/lightcurve/periodogram.h>

#include <algorithm>
#include <cmath>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Least squares by the normal equations of 1, x, x2 with x in [0, 1]: well enough conditioned.
std::array<double, 3> parabola_of(const std::vector<double> &x, std::span<const double> y) {
  double m[3][4] = {};
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double powers[] = {1, x[k], x[k] * x[k]};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j)
        m[i][j] += powers[i] * powers[j];
      m[i][3] += powers[i] * y[k];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) // Gauss and Jordan; the matrix is positive definite
    for (std::size_t row = 0; row < 3; ++row)
      if (const double share = m[row][i] / m[i][i]; row != i)
        for (std::size_t j = i; j < 4; ++j)
          m[row][j] -= share * m[i][j];
  return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

double median_step(std::span<const double> seconds) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < seconds.size(); ++k)
    steps.push_back(seconds[k] - seconds[k - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Sine and cosine of every sample at one frequency, and by how much a step of frequency turns
/// them.
struct Phasors {
  std::vector<double> c, s, step_c, step_s;

  Phasors(std::span<const double> seconds, double first, double step) {
    for (const double t : seconds) {
      const double turn = 2 * pi * (t - seconds[0]);
      c.push_back(std::cos(first * turn));
      s.push_back(std::sin(first * turn));
      step_c.push_back(std::cos(step * turn));
      step_s.push_back(std::sin(step * turn));
    }
  }
  void advance() {
    for (std::size_t k = 0; k < c.size(); ++k) {
      const double turned = c[k] * step_c[k] - s[k] * step_s[k];
      s[k] = s[k] * step_c[k] + c[k] * step_s[k];
      c[k] = turned;
    }
  }
};

/// Zechmeister & Kuerster (2009) Eq. 5 with equal weights; `y` has the mean 0.
double power_of(const Phasors &at, const std::vector<double> &y, double variance) {
  double c = 0, s = 0, yc = 0, ys = 0, cc = 0, cs = 0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    c += at.c[k];
    s += at.s[k];
    yc += y[k] * at.c[k];
    ys += y[k] * at.s[k];
    cc += at.c[k] * at.c[k];
    cs += at.c[k] * at.s[k];
  }
  const auto n = static_cast<double>(y.size());
  c /= n, s /= n, yc /= n, ys /= n;
  cs = cs / n - c * s;
  const double ss = 1 - cc / n - s * s;
  cc = cc / n - c * c;
  const double d = cc * ss - cs * cs;
  return d > 1e-12 ? (ss * yc * yc + cc * ys * ys - 2 * cs * yc * ys) / (variance * d) : 0;
}

/// Frequency of the parabola through the highest value and its neighbours.
double peak_frequency(const Periodogram &p, std::size_t at, double step) {
  const double here = 1 / p.period_s[at];
  if (at == 0 || at + 1 == p.power.size())
    return here;
  const double before = p.power[at - 1], after = p.power[at + 1];
  const double bend = before - 2 * p.power[at] + after;
  return bend < 0 ? here + 0.5 * step * (before - after) / bend : here;
}

} // namespace

Periodogram periodogram(std::span<const double> seconds, std::span<const double> magnitudes) {
  const std::size_t count = seconds.size();
  if (count < 12 || !(seconds.back() > seconds.front()))
    return {};
  const double span = seconds.back() - seconds.front();
  std::vector<double> x, rest;
  for (const double t : seconds)
    x.push_back((t - seconds.front()) / span);
  Periodogram out;
  out.trend = parabola_of(x, magnitudes);
  double variance = 0;
  for (std::size_t k = 0; k < count; ++k) {
    rest.push_back(magnitudes[k] - (out.trend[0] + x[k] * (out.trend[1] + x[k] * out.trend[2])));
    variance += rest[k] * rest[k] / static_cast<double>(count);
  }
  if (!(variance > 1e-18)) // a parabola and nothing else, to rounding
    return {};
  constexpr double per_peak = 5, most_products = 3e8;
  const double step = 1 / (per_peak * span), first = 2 / span;
  const double wanted = (0.5 / median_step(seconds) - first) / step + 1;
  const double able = most_products / static_cast<double>(count);
  const auto frequencies = static_cast<std::size_t>(std::clamp(wanted, 1.0, able));
  out.is_cut = wanted > able;
  Phasors phasors(seconds, first, step);
  for (std::size_t f = 0; f < frequencies; ++f, phasors.advance()) {
    out.period_s.push_back(1 / (first + static_cast<double>(f) * step));
    out.power.push_back(power_of(phasors, rest, variance));
  }
  const auto best = std::max_element(out.power.begin(), out.power.end()) - out.power.begin();
  out.best_s = 1 / peak_frequency(out, static_cast<std::size_t>(best), step);
  return out;
}

namespace {

/// Of one peak of power z among n values: the chance that white noise has one as high anywhere
/// below `highest_hz`.
double false_alarm(double z, std::span<const double> seconds, double highest_hz) {
  const auto n = static_cast<double>(seconds.size());
  double mean = 0, spread = 0;
  for (const double t : seconds)
    mean += t / n;
  for (const double t : seconds)
    spread += (t - mean) * (t - mean) / n;
  const double free = n - 3, mean_free = n - 1; // after a sine, and after the mean alone
  const double width = highest_hz * std::sqrt(4 * pi * spread);
  const double gamma =
      std::sqrt(2 / mean_free) * std::exp(std::lgamma(mean_free / 2) - std::lgamma((n - 2) / 2));
  const double single = std::pow(1 - z, 0.5 * free);
  const double crossings =
      gamma * width * std::pow(1 - z, 0.5 * (free - 1)) * std::sqrt(0.5 * mean_free * z);
  return -std::expm1(std::log1p(-single) - crossings);
}

} // namespace

std::vector<PeriodPeak> highest_peaks(const Periodogram &of, std::span<const double> seconds,
                                      std::size_t most) {
  const std::size_t size = of.power.size();
  if (size < 3)
    return {};
  const double first = 1 / of.period_s.front(), highest = 1 / of.period_s.back();
  const double step = (highest - first) / static_cast<double>(size - 1);
  const double span = seconds.back() - seconds.front(), n = static_cast<double>(seconds.size());
  std::vector<std::size_t> tops;
  for (std::size_t k = 1; k + 1 < size; ++k) // what still grows at an end has its peak elsewhere
    if (of.power[k] >= of.power[k - 1] && of.power[k] > of.power[k + 1])
      tops.push_back(k);
  std::ranges::sort(tops, [&](std::size_t a, std::size_t b) { return of.power[a] > of.power[b]; });
  std::vector<PeriodPeak> out;
  for (const std::size_t top : tops) {
    const double frequency = peak_frequency(of, top, step);
    const auto is_shoulder = [&](const PeriodPeak &higher) {
      return std::abs(1 / higher.period_s - frequency) < 1.5 / span;
    };
    if (out.size() == most)
      break;
    if (std::ranges::any_of(out, is_shoulder))
      continue;
    const double z = std::clamp(of.power[top], 1e-12, 1 - 1e-12);
    const double frequency_sd = std::sqrt(3 * (1 - z) / (n * z)) / (pi * span);
    out.push_back({1 / frequency, frequency_sd / (frequency * frequency), z,
                   false_alarm(z, seconds, highest)});
  }
  return out;
}

namespace {

/// Power of the spectral window, 1 at frequency 0.
double window_of(std::span<const double> seconds, double frequency) {
  double c = 0, s = 0;
  for (const double t : seconds) {
    c += std::cos(2 * pi * frequency * (t - seconds.front()));
    s += std::sin(2 * pi * frequency * (t - seconds.front()));
  }
  const auto n = static_cast<double>(seconds.size());
  return (c * c + s * s) / (n * n);
}

PeakRelation relation_of(const PeriodPeak &peak, const PeriodPeak &higher, std::size_t to,
                         std::span<const double> seconds) {
  using Kind = PeakRelation::Kind;
  const double f = 1 / peak.period_s, g = 1 / higher.period_s;
  const double seen = std::max(window_of(seconds, f - g), window_of(seconds, f + g));
  if (higher.power * seen >= 0.5 * peak.power)
    return {Kind::Sampling, to, 1};
  const double span = seconds.back() - seconds.front();
  for (const double ratio : {0.5, 2., 1. / 3, 3., 0.25, 4., 2. / 3, 1.5})
    if (std::abs(f - g / ratio) < 0.5 / span)
      return {Kind::Multiple, to, ratio};
  return {};
}

} // namespace

std::vector<PeakRelation> relate_peaks(std::span<const PeriodPeak> peaks,
                                       std::span<const double> seconds) {
  std::vector<PeakRelation> out(peaks.size());
  for (std::size_t k = 1; k < peaks.size(); ++k)
    for (std::size_t higher = 0; higher < k && out[k].kind == PeakRelation::Kind::Own; ++higher)
      out[k] = relation_of(peaks[k], peaks[higher], higher, seconds);
  return out;
}

Periodogram with_fewer_values(const Periodogram &full, std::size_t count) {
  const std::size_t size = full.power.size();
  if (size <= count)
    return full;
  Periodogram out{{}, {}, full.best_s, full.trend};
  for (std::size_t bin = 0; bin < count; ++bin) {
    const auto begin = full.power.begin() + static_cast<std::ptrdiff_t>(bin * size / count);
    const auto end = full.power.begin() + static_cast<std::ptrdiff_t>((bin + 1) * size / count);
    const auto highest = std::max_element(begin, end);
    out.power.push_back(*highest);
    out.period_s.push_back(full.period_s[static_cast<std::size_t>(highest - full.power.begin())]);
  }
  return out;
}

} // namespace umov
