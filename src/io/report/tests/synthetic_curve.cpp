#include "io/report/tests/synthetic_curve.h"

#include <cmath>
#include <limits>

namespace umov::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double wavelengths_nm[] = {425, 550, 650};

LightCurveEpoch epoch_at(int pass, double t, double seconds) {
  LightCurveEpoch e;
  e.geometry.time = {2458139.5, (pass == 0 ? 0.2130 : 0.6790) + seconds / 86400}; // 2018-01-21
  e.geometry.azimuth = Angle::degrees(pass == 0 ? 310 - 190 * t : 200 + 150 * t);
  e.geometry.altitude = Angle::degrees(10 + (pass == 0 ? 62 : 28) * std::sin(pi * t));
  e.geometry.range_km = 1500 - 900 * std::sin(pi * t);
  e.geometry.phase_angle = Angle::degrees(pass == 0 ? 148 - 128 * t : 30 + 80 * t);
  e.geometry.sunlit = pass == 0 && t > 0.96 ? 0 : 1;
  e.geometry.sun_altitude = Angle::degrees(-15);
  e.body_from_gcrs = {std::cos(t), 0, std::sin(t), 0};
  const double a = e.geometry.phase_angle.radians();
  e.pose.observer = {1, 0, 0};
  e.pose.sun = {std::cos(a), std::sin(a), 0};
  e.pass_id = pass == 0 ? "20580-20180121T051155Z" : "20580-20180121T161803Z";
  e.elset_age_days = 0.7;
  e.has_glint = pass == 1 && std::abs(t - 0.4) < 0.02;
  e.is_dark = pass == 0 && t > 0.55 && t < 0.62;
  return e;
}

LightCurveSample sample_at(const LightCurveEpoch &e, double t, std::size_t band) {
  LightCurveSample s;
  if (e.is_dark) {
    s.sky = {nan, nan, nan, nan};
    s.scattering = {nan, nan, nan, nan};
    s.p = s.dop = s.pa_deg = s.magnitude = nan;
    return s;
  }
  const double phase = e.geometry.phase_angle.radians(), colour = static_cast<double>(band);
  s.intensity = (0.5 + 0.2 * colour) * (0.05 + std::pow(std::cos(phase / 2), 2)) *
                (1 + 0.3 * std::sin(40 * t)) * (e.has_glint ? 60 : 1);
  s.irradiance = 1.8 * e.geometry.sunlit * s.intensity / std::pow(1000 * e.geometry.range_km, 2);
  s.magnitude = s.irradiance > 0 ? -2.5 * std::log10(s.irradiance / 3.6e-11) : nan;
  s.p = (0.25 - 0.06 * colour) * std::pow(std::sin(phase / 2), 2) * (1.2 + std::sin(15 * t)) / 2;
  s.pa_deg = std::fmod(120 + 140 * t + 5 * colour, 180.0);
  s.dop = s.p;
  const double x = 2 * s.pa_deg * (pi / 180);
  s.sky = {1, s.p * std::cos(x), s.p * std::sin(x), 0};
  s.scattering = {1, s.p, 0, 0};
  return s;
}

} // namespace

LightCurve synthetic_curve(std::size_t rows_per_pass) {
  LightCurve c;
  c.object = "HST";
  c.norad_cat_id = 20580;
  c.materials = {"paper_asi", "paper_al"};
  for (const double nm : wavelengths_nm)
    c.bands.push_back({"nm:" + std::to_string(static_cast<int>(nm)), Wavelength::nm(nm)});
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t i = 0; i < rows_per_pass; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(rows_per_pass - 1);
      c.epochs.push_back(epoch_at(pass, t, 420 * t));
      const std::size_t first = c.samples.size();
      for (std::size_t b = 0; b < c.bands.size(); ++b)
        c.samples.push_back(sample_at(c.epochs.back(), t, b));
      const double share = 0.5 + 0.4 * std::sin(9 * t);
      for (const double part : {share, 1 - share})
        for (std::size_t b = 0; b < c.bands.size(); ++b)
          c.material_i.push_back(part * c.samples[first + b].intensity);
    }
  return c;
}

} // namespace umov::test
