#include <umov/surface/measured.h>

#include "kernel/gauss.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <span>
#include <tuple>
#include <umov/core/quantity.h>
#include <utility>

namespace umov {
namespace {

using Matrix = std::array<double, 16>;

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

using Axis = std::vector<double>::const_iterator;

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

/// Calls `take` with the weights and numbers of the nodes about a place.
template <class Take>
void for_nodes(const std::array<std::vector<double>, 4> &axes, const std::array<double, 4> &place,
               const Take &take) {
  std::array<Place, 4> p;
  unsigned between = 0; // axes on which the place is on no node: both neighbours count
  for (unsigned k = 0; k < 4; ++k) {
    p[k] = place_of(axes[k], place[k]);
    between |= p[k].t > 0 ? 1u << k : 0u;
  }
  unsigned corner = 0;
  do {
    double weight = 1;
    std::size_t at = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool high = (corner >> k & 1) != 0;
      weight *= high ? p[k].t : 1 - p[k].t;
      at = at * axes[k].size() + (high ? p[k].high : p[k].low);
    }
    take(weight, at);
    corner = (corner - between) & between; // the next of those axes' bits alone
  } while (corner != 0);
}

bool holds(const std::vector<double> &axis, double at) {
  return at >= axis.front() - 1e-9 && at <= axis.back() + 1e-9;
}

struct HalfAngles {
  double tilt, incidence; ///< of the half vector from the normal; on the half vector [rad]
};

HalfAngles half_angles(double theta_i, double theta_o, double phi) {
  const double l_v =
      std::cos(theta_i) * std::cos(theta_o) + std::sin(theta_i) * std::sin(theta_o) * std::cos(phi);
  const double half = std::sqrt(std::max(1e-15, (1 + l_v) / 2));
  const double n_h = (std::cos(theta_i) + std::cos(theta_o)) / (2 * half);
  // sin of the tilt from the components across the normal: acos would lose the digits of narrow
  // lobes.
  const double x = std::sin(theta_i) + std::sin(theta_o) * std::cos(phi);
  const double y = std::sin(theta_o) * std::sin(phi);
  return {std::atan2(std::hypot(x, y) / (2 * half), n_h), std::acos(std::min(1.0, half))};
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

bool MeasuredBrdf::is_partner_known(const BrdfSample &s) const {
  if (!is_in_plane_)
    return holds(axes_[1], s.theta_o_deg) && holds(axes_[2], s.theta_i_deg);
  // Between the few incidences of a goniometer a lobe cannot be interpolated: on the grid alone.
  return std::binary_search(axes_[1].begin(), axes_[1].end(), s.theta_o_deg) &&
         std::binary_search(axes_[2].begin(), axes_[2].end(), s.theta_i_deg);
}

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
  double size = 1; // a product of whole numbers could wrap around to the number of rows
  for (std::size_t k = 0; k < 4; ++k) {
    out.axes_[k] = distinct(axes[k]);
    size *= static_cast<double>(out.axes_[k].size());
  }
  if (size != static_cast<double>(samples.size()))
    return fail(
        ErrorCode::BadInput,
        fmt::format("{} rows do not fill the grid of {} wavelengths x {} theta_i x {} theta_o "
                    "x {} phi = {:.16g}; every combination once was expected",
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
  out.is_in_plane_ = !has_polarization && out.axes_[3] == std::vector<double>{0, 180};
  if (out.is_in_plane_)
    remarks.emplace_back(
        "measured in the plane of incidence; other azimuths take the value of the same "
        "tilt of the half vector");
  else if (out.axes_[3].size() == 1)
    remarks.emplace_back("measured at one azimuth; the same is taken for all");
  double largest = 0, worst = 0;
  for (const BrdfSample &s : samples)
    largest = std::max(largest, s.mueller[0]);
  for (const BrdfSample &s : samples)
    if (out.is_partner_known(s)) {
      const Matrix back =
          way_back(mirrored(out.look_up(s.wavelength_nm, s.theta_o_deg, s.theta_i_deg, s.phi_deg)));
      for (std::size_t k = 0; k < 16; ++k)
        worst = std::max(worst, std::abs(back[k] - s.mueller[k]));
    }
  out.asymmetry_ = largest > 0 ? worst / largest : 0;
  const Albedo brightest = out.largest_albedo(remarks);
  std::string trouble;
  if (out.asymmetry_ > 0.05)
    trouble =
        fmt::format("the table is not reciprocal: f(i, o) and f(o, i) differ by up to {:.1f} % "
                    "of its largest value",
                    100 * out.asymmetry_);
  if (brightest.value > 1 + 1e-4)
    trouble += fmt::format("{}the table gives more than it gets: albedo {:.3f} at {:g} deg",
                           trouble.empty() ? "" : "; ", brightest.value, brightest.theta_i_deg);
  if (!trouble.empty() && !accept)
    return fail(ErrorCode::BadInput, trouble + ". Pass --accept (or accept = true) to take it.");
  if (!trouble.empty())
    remarks.push_back("accepted although " + trouble);
  out.remark_on_grid(remarks);
  return out;
}

Matrix MeasuredBrdf::look_up(double nm, double i, double o, double phi) const {
  Matrix out{};
  for_nodes(axes_, {nm, i, o, phi}, [&](double weight, std::size_t at) {
    for (std::size_t k = 0; k < 16; ++k)
      out[k] += weight * values_[at][k];
  });
  return out;
}

Matrix MeasuredBrdf::operator()(double wavelength_nm, double theta_i_rad, double theta_o_rad,
                                double phi_rad) const {
  const double i = theta_i_rad * 180 / pi, o = theta_o_rad * 180 / pi;
  const double turned = std::remainder(phi_rad, 2 * pi) * 180 / pi;
  const double phi = std::abs(turned);
  if (is_in_plane_) {
    const HalfAngles at = half_angles(theta_i_rad, theta_o_rad, phi * pi / 180);
    Matrix plain{};
    plain[0] = in_plane(wavelength_nm, at.tilt, at.incidence);
    return plain;
  }
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

double MeasuredBrdf::in_plane(double nm, double tilt_rad, double incidence_rad) const {
  // In the plane, with the observer's angle s positive on the mirror side, tilt = (i - s)/2 and
  // incidence on the half vector = (i + s)/2: each measured i gives the wanted tilt twice.
  const double tilt = tilt_rad * 180 / pi, wanted = std::abs(incidence_rad) * 180 / pi;
  const double last = axes_[2].back();
  const Place at_nm = place_of(axes_[0], nm);
  // Of the measured incidence `i` in its order, on the mirror's side or on the source's.
  const auto value_at = [&](std::size_t i, double o, bool is_mirror_side) {
    const Place at_o = place_of(axes_[2], o);
    const auto add = [&](std::size_t w, std::size_t k, double weight) {
      const std::size_t row = (w * axes_[1].size() + i) * axes_[2].size() + k;
      return weight > 0 ? weight * values_[2 * row + (is_mirror_side ? 1 : 0)][0] : 0;
    };
    double out = 0;
    for (const auto &[k, weight] :
         {std::pair(at_o.low, 1 - at_o.t), std::pair(at_o.high, at_o.t)}) {
      out += add(at_nm.low, k, (1 - at_nm.t) * weight);
      out += add(at_nm.high, k, at_nm.t * weight);
    }
    return out;
  };
  std::array<std::pair<double, double>, 6> all; // incidence on the half vector, value
  std::size_t count = 0;
  // The neighbours of the wanted incidence in a stretch of the axis along which it rises or falls.
  const auto take = [&](Axis begin, Axis end, double side, bool is_rising) {
    const Axis at = std::partition_point(
        begin, end, [&](double i) { return (std::abs(i - side * tilt) < wanted) == is_rising; });
    for (const Axis i : {at, at == begin ? end : at - 1})
      if (i != end) {
        const double s = *i - 2 * side * tilt;
        all[count++] = {
            std::abs(*i - side * tilt),
            value_at(static_cast<std::size_t>(i - axes_[1].begin()), std::abs(s), s >= 0)};
      }
  };
  const Axis begin = axes_[1].begin(), end = axes_[1].end();
  const Axis first =
      std::partition_point(begin, end, [&](double i) { return i - 2 * tilt < -last; });
  const Axis stop =
      std::partition_point(first, end, [&](double i) { return i - 2 * tilt <= last; });
  const Axis bend = std::partition_point(first, stop, [&](double i) { return i < tilt; });
  take(first, bend, 1, false);
  take(bend, stop, 1, true);
  if (tilt != 0)
    take(begin, std::partition_point(begin, end, [&](double i) { return i + 2 * tilt <= last; }),
         -1, true);
  const std::span found(all.data(), count);
  if (found.empty()) // beyond what was measured: the nearest angle that was
    return value_at(axes_[1].size() - 1, last, false);
  std::sort(found.begin(), found.end());
  if (wanted <= found.front().first)
    return found.front().second;
  for (std::size_t k = 1; k < found.size(); ++k)
    if (wanted <= found[k].first) {
      const double width = found[k].first - found[k - 1].first;
      const double t = width > 0 ? (wanted - found[k - 1].first) / width : 0.5;
      return (1 - t) * found[k - 1].second + t * found[k].second;
    }
  return found.back().second;
}

double MeasuredBrdf::m00(double nm, double i, double o, double phi) const {
  const auto value = [&](double from, double to) {
    double out = 0;
    for_nodes(axes_, {nm, from, to, phi},
              [&](double weight, std::size_t at) { out += weight * values_[at][0]; });
    return out;
  };
  const bool there = holds(axes_[1], i) && holds(axes_[2], o);
  const bool back = holds(axes_[1], o) && holds(axes_[2], i);
  if (there == back)
    return 0.5 * (value(i, o) + value(o, i));
  return there ? value(i, o) : value(o, i);
}

double MeasuredBrdf::albedo(double wavelength_nm, double theta_i_rad) const {
  // Panels that grow away from the mirror direction, where lobes stand.
  std::vector<double> theta{0, theta_i_rad, pi / 2}, phi{0, pi};
  for (double step = 0.005; step < pi; step *= 1.6) {
    for (const double edge : {theta_i_rad - step, theta_i_rad + step})
      if (edge > 0 && edge < pi / 2)
        theta.push_back(edge);
    phi.push_back(step); // from the mirror's azimuth
  }
  std::sort(theta.begin(), theta.end());
  std::sort(phi.begin(), phi.end());
  double sum = 0;
  for (std::size_t t = 1; t < theta.size(); ++t)
    for (std::size_t p = 1; p < phi.size(); ++p)
      sum += gauss_integral<6>(theta[t - 1], theta[t], [&](double o) {
        return std::cos(o) * std::sin(o) * gauss_integral<6>(phi[p - 1], phi[p], [&](double from) {
                 return is_in_plane_ ? (*this)(wavelength_nm, theta_i_rad, o, pi - from)[0]
                                     : m00(wavelength_nm, theta_i_rad * 180 / pi, o * 180 / pi,
                                           (pi - from) * 180 / pi);
               });
      });
  return 2 * sum;
}

} // namespace umov
