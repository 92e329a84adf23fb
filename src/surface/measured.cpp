#include <umov/surface/measured.h>

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <tuple>
#include <umov/core/quantity.h>

namespace umov {
namespace {

using Matrix = std::array<double, 16>;

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Delta M^T Delta, Delta = diag(1, 1, -1, 1): the matrix of the way back.
Matrix way_back(const Matrix &m) {
  Matrix out{};
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      out[4 * r + c] = ((r == 2) != (c == 2) ? -1 : 1) * m[4 * c + r];
  return out;
}

/// The matrix of the mirrored geometry (azimuth with the other sign): U and V change theirs.
Matrix mirrored(const Matrix &m) {
  Matrix out = m;
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      if ((r < 2) != (c < 2))
        out[4 * r + c] = -m[4 * r + c];
  return out;
}

Matrix mean_of(const Matrix &a, const Matrix &b) {
  Matrix out{};
  for (std::size_t k = 0; k < 16; ++k)
    out[k] = 0.5 * (a[k] + b[k]);
  return out;
}

struct Place {
  std::size_t low = 0, high = 0;
  double t = 0;
};

Place place_of(const std::vector<double> &axis, double at) {
  if (axis.size() < 2 || at <= axis.front())
    return {0, 0, 0};
  if (at >= axis.back())
    return {axis.size() - 1, axis.size() - 1, 0};
  const auto high =
      static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), at) - axis.begin());
  return {high - 1, high, (at - axis[high - 1]) / (axis[high] - axis[high - 1])};
}

bool holds(const std::vector<double> &axis, double at) {
  return at >= axis.front() - 1e-9 && at <= axis.back() + 1e-9;
}

Result<void> check_samples(const std::vector<BrdfSample> &samples) {
  if (samples.empty())
    return fail(ErrorCode::BadInput, "a BRDF table without rows");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BrdfSample &s = samples[i];
    if (!(s.theta_i_deg >= 0 && s.theta_i_deg <= 90 && s.theta_o_deg >= 0 && s.theta_o_deg <= 90 &&
          s.phi_deg >= 0 && s.phi_deg <= 180))
      return fail(ErrorCode::BadInput,
                  fmt::format("row {}: theta_i {:g}, theta_o {:g}, phi {:g} deg; 0 to 90, 0 to 90 "
                              "and 0 to 180 were expected",
                              i + 1, s.theta_i_deg, s.theta_o_deg, s.phi_deg));
    if (!(s.wavelength_nm >= 10 && s.wavelength_nm <= 1e6))
      return fail(ErrorCode::BadInput, fmt::format("row {}: wavelength {:g} nm; 10 to 1e6 was "
                                                   "expected. Is it in um?",
                                                   i + 1, s.wavelength_nm));
    if (!(s.mueller[0] >= 0) || !std::isfinite(s.mueller[0]))
      return fail(ErrorCode::BadInput,
                  fmt::format("row {}: m00 = {}; 0 or more was expected", i + 1, s.mueller[0]));
    double square = 0;
    for (const double m : s.mueller)
      square += m * m;
    if (!(square <= 4 * s.mueller[0] * s.mueller[0] * (1 + 1e-6)))
      return fail(
          ErrorCode::BadInput,
          fmt::format("row {}: the Mueller matrix is not physical (it would polarize by more "
                      "than 100 %)",
                      i + 1));
  }
  return {};
}

} // namespace

Result<MeasuredBrdf> MeasuredBrdf::from(std::vector<BrdfSample> samples, bool has_polarization,
                                        bool accept, std::vector<std::string> &remarks) {
  UMOV_TRY(check_samples(samples));
  MeasuredBrdf out;
  out.has_polarization_ = has_polarization;
  std::array<std::vector<double>, 4> axes;
  for (const BrdfSample &s : samples) {
    const double keys[4] = {s.wavelength_nm, s.theta_i_deg, s.theta_o_deg, s.phi_deg};
    for (std::size_t k = 0; k < 4; ++k)
      axes[k].push_back(keys[k]);
  }
  std::size_t size = 1;
  for (std::size_t k = 0; k < 4; ++k) {
    out.axes_[k] = distinct(axes[k]);
    size *= out.axes_[k].size();
  }
  if (size != samples.size())
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} rows do not fill the grid of {} wavelengths x {} theta_i x {} theta_o "
                    "x {} phi = {}; every combination once was expected",
                    samples.size(), out.axes_[0].size(), out.axes_[1].size(), out.axes_[2].size(),
                    out.axes_[3].size(), size));
  std::sort(samples.begin(), samples.end(), [](const BrdfSample &a, const BrdfSample &b) {
    return std::tie(a.wavelength_nm, a.theta_i_deg, a.theta_o_deg, a.phi_deg) <
           std::tie(b.wavelength_nm, b.theta_i_deg, b.theta_o_deg, b.phi_deg);
  });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && samples[i].wavelength_nm == samples[i - 1].wavelength_nm &&
        samples[i].theta_i_deg == samples[i - 1].theta_i_deg &&
        samples[i].theta_o_deg == samples[i - 1].theta_o_deg &&
        samples[i].phi_deg == samples[i - 1].phi_deg)
      return fail(ErrorCode::BadInput,
                  fmt::format("theta_i {:g}, theta_o {:g}, phi {:g} deg stands twice",
                              samples[i].theta_i_deg, samples[i].theta_o_deg, samples[i].phi_deg));
    out.values_.push_back(samples[i].mueller);
  }
  if (out.axes_[3].size() == 2 && out.axes_[3][0] == 0 && out.axes_[3][1] == 180)
    remarks.emplace_back("measured in the plane of incidence; other azimuths are interpolated by "
                         "cos^2(phi/2)");
  else if (out.axes_[3].size() == 1)
    remarks.emplace_back("measured at one azimuth; the same is taken for all");
  double largest = 0, worst = 0;
  for (const BrdfSample &s : samples)
    largest = std::max(largest, s.mueller[0]);
  for (const BrdfSample &s : samples)
    if (holds(out.axes_[1], s.theta_o_deg) && holds(out.axes_[2], s.theta_i_deg)) {
      const Matrix back =
          way_back(mirrored(out.look_up(s.wavelength_nm, s.theta_o_deg, s.theta_i_deg, s.phi_deg)));
      for (std::size_t k = 0; k < 16; ++k)
        worst = std::max(worst, std::abs(back[k] - s.mueller[k]));
    }
  out.asymmetry_ = largest > 0 ? worst / largest : 0;
  double albedo = 0, at = 0;
  for (const double nm : out.axes_[0])
    for (const double i : out.axes_[1])
      if (const double a = i < 90 ? out.albedo(nm, i * pi / 180) : 0; a > albedo) {
        albedo = a;
        at = i;
      }
  std::string trouble;
  if (out.asymmetry_ > 0.05)
    trouble =
        fmt::format("the table is not reciprocal: f(i, o) and f(o, i) differ by up to {:.1f} % "
                    "of its largest value",
                    100 * out.asymmetry_);
  if (albedo > 1 + 1e-4)
    trouble += fmt::format("{}the table gives more than it gets: albedo {:.3f} at {:g} deg",
                           trouble.empty() ? "" : "; ", albedo, at);
  if (!trouble.empty() && !accept)
    return fail(ErrorCode::BadInput, trouble + ". Pass --accept (or accept = true) to take it.");
  if (!trouble.empty())
    remarks.push_back("accepted although " + trouble);
  return out;
}

Matrix MeasuredBrdf::look_up(double nm, double i, double o, double phi) const {
  const Place p[4] = {place_of(axes_[0], nm), place_of(axes_[1], i), place_of(axes_[2], o),
                      place_of(axes_[3], phi)};
  const bool in_plane = axes_[3].size() == 2 && axes_[3][0] == 0 && axes_[3][1] == 180;
  const double s = std::sin(phi * pi / 360);
  Matrix out{};
  for (unsigned corner = 0; corner < 16; ++corner) {
    double weight = 1;
    std::size_t at = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool high = (corner >> k & 1) != 0;
      const double t = k == 3 && in_plane && p[k].high != p[k].low ? s * s : p[k].t;
      weight *= high ? t : 1 - t;
      at = at * axes_[k].size() + (high ? p[k].high : p[k].low);
    }
    if (weight > 0)
      for (std::size_t k = 0; k < 16; ++k)
        out[k] += weight * values_[at][k];
  }
  return out;
}

Matrix MeasuredBrdf::operator()(double wavelength_nm, double theta_i_rad, double theta_o_rad,
                                double phi_rad) const {
  const double i = theta_i_rad * 180 / pi, o = theta_o_rad * 180 / pi;
  const double turned = std::remainder(phi_rad, 2 * pi) * 180 / pi;
  const double phi = std::abs(turned);
  const bool there = holds(axes_[1], i) && holds(axes_[2], o);
  const bool back = holds(axes_[1], o) && holds(axes_[2], i);
  Matrix m{};
  if (there || !back)
    m = look_up(wavelength_nm, i, o, phi);
  if (back || !there) {
    const Matrix other = way_back(mirrored(look_up(wavelength_nm, o, i, phi)));
    m = there == back ? mean_of(m, other) : other;
  }
  return turned < 0 ? mirrored(m) : m;
}

double MeasuredBrdf::albedo(double wavelength_nm, double theta_i_rad) const {
  return 2 * gauss_integral<48>(0, pi, [&](double phi) {
           return gauss_integral<64>(0, pi / 2, [&](double o) {
             return (*this)(wavelength_nm, theta_i_rad, o, phi)[0] * std::cos(o) * std::sin(o);
           });
         });
}

} // namespace umov
