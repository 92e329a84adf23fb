#include <umov/instrument/detector.h>

#include <algorithm>
#include <boost/math/special_functions/lambert_w.hpp>
#include <cmath>
#include <limits>

namespace umov {
namespace {

double register_gain(const Detector &d) { return d.model == DetectorModel::Emccd ? d.em_gain : 1; }

/// Photons in a dead time from which on counts of one that is prolonged are 2 % below their largest
/// or beyond it.
constexpr double paralysed_from = .8;

/// Photons behind what a counter told whose dead time begins anew with each of them: the smaller of
/// the two rates that tell as much.
CorrectedCount prolonged_count(const Detector &d, double told, double exposure_s) {
  const double largest = paralysed_from * std::exp(-paralysed_from);
  const double y = std::max(0., told) * d.dead_time_s / exposure_s;
  const double x = -boost::math::lambert_w0(-std::min(y, largest));
  return {told * std::exp(x), (std::exp(x) - 2 * x) / ((1 - x) * (1 - x)), y >= largest};
}

/// Electrons, after a register in units of its input, before they are read.
double draw_electrons(const Detector &d, double mean, double exposure_s, Draws &draws) {
  if (d.model == DetectorModel::Counter && mean > 0) {
    const double told = counted_rate(d, mean / exposure_s) * exposure_s;
    const double width = std::sqrt(counter_fano(d, mean / exposure_s));
    return told + (draws.poisson(told) - told) * width;
  }
  const double n = draws.poisson(mean);
  const double excess = excess_variance(d) - 1;
  if (!(excess > 0 && n > 0))
    return n;
  return draws.gamma(n / excess) * excess; // mean n, variance n (F^2 - 1)
}

} // namespace

const std::vector<std::string> &detector_names() {
  static const std::vector<std::string> names{"ideal", "ccd", "cmos", "emccd", "counter"};
  return names;
}

const char *name_of(DetectorModel model) {
  return detector_names()[static_cast<std::size_t>(model)].c_str();
}

bool has_converter(const Detector &d) {
  return d.model != DetectorModel::Ideal && d.model != DetectorModel::Counter;
}

double adu_per_electron(const Detector &d) {
  return has_converter(d) ? register_gain(d) / d.gain_e_adu : 1;
}

double zero_adu(const Detector &d) { return has_converter(d) ? d.bias_adu : 0; }

double last_adu(const Detector &d) {
  constexpr double largest = 2147483647; // of a 32-bit whole number
  return has_converter(d) ? std::min(std::exp2(d.bits) - 1, largest) : largest;
}

double number_of(const Detector &d, double electrons) {
  return has_converter(d) ? bent(d, electrons) * adu_per_electron(d) + d.bias_adu : electrons;
}

double excess_variance(const Detector &d) {
  const double g = register_gain(d);
  if (!(g > 1))
    return 1;
  const double m = d.em_stages;
  return 2 * (g - 1) * std::pow(g, -(m + 1) / m) + 1 / g;
}

double fixed_variance(const Detector &d) {
  if (!has_converter(d))
    return 0;
  const double g = register_gain(d);
  return (d.read_e * d.read_e + d.gain_e_adu * d.gain_e_adu / 12) / (g * g);
}

double saturation_e(const Detector &d) {
  if (!has_converter(d))
    return std::numeric_limits<double>::infinity();
  const double numbers = (std::exp2(d.bits) - 1 - d.bias_adu) / adu_per_electron(d);
  return d.well_e > 0 ? std::min(d.well_e, numbers) : numbers;
}

double aperture_variance(const Detector &d, const ApertureCounts &c) {
  const double f2 = excess_variance(d);
  const double of_sky = c.sky_pixels > 0 ? 1 + c.pixels / c.sky_pixels : 1;
  return f2 * c.star + c.pixels * of_sky * (f2 * (c.sky + c.dark) + fixed_variance(d));
}

double bent(const Detector &d, double x) {
  return d.well_e > 0 ? x * (1 - d.nonlinearity * x / d.well_e) : x;
}

double straightened(const Detector &d, double y) {
  if (!(d.well_e > 0))
    return y;
  const double root = 1 - 4 * d.nonlinearity * y / d.well_e;
  return 2 * y / (1 + std::sqrt(std::max(0.0, root)));
}

double counted_rate(const Detector &d, double rate) {
  const double x = rate * d.dead_time_s;
  return d.is_paralyzable ? rate * std::exp(-x) : rate / (1 + x);
}

double counter_fano(const Detector &d, double rate) {
  const double x = rate * d.dead_time_s;
  return d.is_paralyzable ? 1 - 2 * x * std::exp(-x) : 1 / ((1 + x) * (1 + x));
}

bool is_paralysed(const Detector &d, double rate) {
  return d.model == DetectorModel::Counter && d.is_paralyzable &&
         rate * d.dead_time_s > paralysed_from;
}

double rolling_change(const Detector &d, double rows_per_s) {
  return d.has_rolling_shutter ? rows_per_s * d.line_time_s : 0;
}

CorrectedCount corrected_count(const Detector &d, double told, double exposure_s) {
  if (d.model != DetectorModel::Counter)
    return {told, excess_variance(d), false};
  if (d.is_paralyzable)
    return prolonged_count(d, told, exposure_s);
  constexpr double blind = .9; // dead for nine tenths of the time: a per cent there is one of ten
  const double dead = told * d.dead_time_s / exposure_s;
  const double kept = 1 - std::min(dead, blind);
  return {told / kept, 1 / kept, dead > blind}; // 1 + n tau = 1/(1 - m tau)
}

PixelReading read_pixel(const Detector &d, double mean, double exposure_s, Draws &draws) {
  double electrons = draw_electrons(d, mean, exposure_s, draws);
  PixelReading out;
  const bool is_full = has_converter(d) && d.well_e > 0 && electrons > d.well_e;
  if (is_full)
    electrons = d.well_e;
  const double noise = has_converter(d) ? d.read_e * draws.normal() / d.gain_e_adu : 0;
  const double last = last_adu(d);
  const double number = std::floor(number_of(d, electrons) + noise + 0.5);
  out.is_saturated = is_full || number >= last;
  out.adu = static_cast<int>(std::clamp(number, 0.0, last));
  return out;
}

double electrons_of(const Detector &d, const PixelReading &reading) {
  const double x = (reading.adu - zero_adu(d)) / adu_per_electron(d);
  return has_converter(d) ? straightened(d, x) : x;
}

double draw_aperture(const Detector &d, double mean, double pixels, double exposure_s,
                     Draws &draws) {
  const double electrons = draw_electrons(d, mean, exposure_s, draws);
  const double fixed = pixels * fixed_variance(d);
  return fixed > 0 ? electrons + std::sqrt(fixed) * draws.normal() : electrons;
}

} // namespace umov
