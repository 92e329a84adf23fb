#include "io/report/report_data.h"

#include "io/report/base64.h"
#include "io/report/page.h"
#include "io/report/report_turning.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <umov/lightcurve/derived_errors.h>

namespace umov {
namespace {

using Json = nlohmann::ordered_json; // keeps the order of insertion: same bytes each run

const char *north_name(PolarizationFrame frame) {
  switch (frame) {
  case PolarizationFrame::Equatorial:
    return "celestial north";
  case PolarizationFrame::AltAz:
    return "the local zenith";
  case PolarizationFrame::Scattering:
    break;
  }
  return "the normal of the scattering plane";
}

std::vector<std::string> standard_conventions(PolarizationFrame frame, const LightCurve &curve) {
  return {
      "Times are UTC at mid-exposure; phase angle is Sun-object-observer, 0 = full.",
      "intensity is reflected intensity per unit solar irradiance [m2/sr], without distance, "
      "eclipse or atmosphere; irradiance adds sunlit fraction, Sun distance and range, above the "
      "atmosphere [W m-2 nm-1]" +
          std::string(has_curve(curve.bands) ? ", photon-weighted means over the band" : "") +
          fmt::format(". Magnitudes are {}.", name_of(curve.magnitudes)),
      fmt::format("q and u are fractions of I, shown in percent: +q towards {}, +u 45 deg from it "
                  "{}, position angle counted the same way in [0, 180) deg (IAU 1973).",
                  north_name(frame),
                  frame == PolarizationFrame::Scattering ? "counter-clockwise on the sky"
                                                         : "through east"),
      "q_scat is positive perpendicular to the scattering plane (Sun, object, observer).",
      "p is the linear degree of polarization; where nothing is both lit and seen, intensity is 0 "
      "and q, u, p and position angle are undefined and left out.",
      "v > 0: the field turns counter-clockwise as seen by the observer (IAU 1973).",
  };
}

template <class Value> Json column(std::size_t count, std::size_t stride, Value &&value) {
  Json out = Json::array();
  for (std::size_t i = 0; i < count; i += stride)
    out.push_back(value(i));
  return out;
}

/// Names of materials in the order that fixes their colours.
std::vector<std::string> colour_order(const ReportInput &input) {
  std::vector<std::string> names = input.key_frame_materials;
  for (const std::string &name : input.curve.materials)
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return names;
}

Json epochs_json(const LightCurve &curve, std::size_t stride) {
  const auto each = [&](auto &&value) {
    return column(curve.epochs.size(), stride,
                  [&](std::size_t i) { return value(curve.epochs[i]); });
  };
  using E = const LightCurveEpoch &;
  return {{"time", each([](E e) { return to_iso(e.geometry.time); })},
          {"pass", each([](E e) { return e.pass_id; })},
          {"az", each([](E e) { return e.geometry.azimuth.degrees(); })},
          {"alt", each([](E e) { return e.geometry.altitude.degrees(); })},
          {"range", each([](E e) { return e.geometry.range_km; })},
          {"phase", each([](E e) { return e.geometry.phase_angle.degrees(); })},
          {"sunlit", each([](E e) { return e.geometry.sunlit; })},
          {"sun_alt", each([](E e) { return e.geometry.sun_altitude.degrees(); })},
          {"dark", each([](E e) { return e.is_dark ? 1 : 0; })},
          {"glint", each([](E e) { return e.has_glint ? 1 : 0; })},
          {"elset_age", each([](E e) { return e.elset_age_days; })}};
}

/// Two digits: half-widths are drawn, not read.
double coarse(double value) {
  if (!(value > 0) || !std::isfinite(value))
    return value;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::stod(fmt::format("{:.1e}", std::round(value / unit) * unit));
}

/// Half-widths of what the figures show; of I as a part of it.
void add_errors(Json &out, const ReportInput &input, std::size_t band, std::size_t stride) {
  const LightCurve &curve = input.curve;
  const auto each = [&](const char *name, auto &&value) {
    out[name] = column(curve.epochs.size(), stride, [&](std::size_t i) {
      const LightCurveSample &s = curve.samples[i * curve.bands.size() + band];
      if (std::isnan(s.sky.q))
        return std::numeric_limits<double>::quiet_NaN();
      const double twice = 2 * scattering_axis(curve.epochs[i].geometry, input.frame).radians();
      return coarse(value(DerivedErrors(s), s, std::cos(twice), std::sin(twice)));
    });
  };
  using D = const DerivedErrors &;
  using S = const LightCurveSample &;
  each("mag_err", [](D d, S, double, double) { return d.mag(); });
  each("q_err", [](D d, S s, double c, double x) { return d.part(s.sky.q, c, x); });
  each("u_err", [](D d, S s, double c, double x) { return d.part(s.sky.u, x, c); });
  each("p_err", [](D d, S, double, double) { return d.p(); });
  each("pa_err", [](D d, S s, double, double) {
    return s.p > 0 ? d.pa_deg() : std::numeric_limits<double>::quiet_NaN();
  });
}

Json band_json(const LightCurve &curve, std::size_t band, std::size_t stride) {
  const std::size_t bands = curve.bands.size();
  const auto each = [&](auto &&value) {
    return column(curve.epochs.size(), stride,
                  [&](std::size_t i) { return value(curve.samples[i * bands + band]); });
  };
  using S = const LightCurveSample &;
  Json out{{"name", curve.bands[band].name},
           {"wavelength_nm", curve.bands[band].wavelength.nm()},
           {"irradiance", each([](S s) { return s.irradiance; })},
           {"intensity", each([](S s) { return s.intensity; })},
           {"mag", each([](S s) { return s.magnitude; })},
           {"mag_limit", each([](S s) { return has_magnitude_limit(s) ? 1 : 0; })},
           {"q", each([](S s) { return s.sky.q; })},
           {"u", each([](S s) { return s.sky.u; })},
           {"p", each([](S s) { return s.p; })},
           {"pa", each([](S s) { return s.pa_deg; })},
           {"q_scat", each([](S s) { return s.scattering.q; })},
           {"u_scat", each([](S s) { return s.scattering.u; })}};
  if (!curve.spread.empty()) {
    const auto spread = [&](const char *name, Extent SampleSpread::*of) {
      const auto take = [&](double Extent::*end) {
        return column(curve.epochs.size(), stride,
                      [&](std::size_t i) { return curve.spread[i * bands + band].*of.*end; });
      };
      out[std::string(name) + "_low"] = take(&Extent::low);
      out[std::string(name) + "_high"] = take(&Extent::high);
    };
    spread("intensity", &SampleSpread::intensity);
    spread("mag", &SampleSpread::magnitude);
    spread("p", &SampleSpread::p);
  }
  if (curve.bounces > 1) {
    out["indirect_i"] = each([](S s) { return s.indirect.i; });
    out["indirect_q"] = each([](S s) { return s.indirect.q; });
    out["indirect_u"] = each([](S s) { return s.indirect.u; });
    out["indirect_v"] = each([](S s) { return s.indirect.v; });
  }
  return out;
}

/// Direct light of each material.
Json contributions_json(const ReportInput &input, std::size_t stride) {
  const LightCurve &curve = input.curve;
  Json out = Json::array();
  const std::size_t bands = curve.bands.size(), materials = curve.materials.size();
  const std::vector<std::string> names = colour_order(input);
  for (std::size_t m = 0; m < names.size(); ++m) {
    Json per_band = Json::array();
    const auto at = static_cast<std::size_t>(
        std::find(curve.materials.begin(), curve.materials.end(), names[m]) -
        curve.materials.begin());
    const bool is_used = at < materials;
    for (std::size_t b = 0; b < bands; ++b)
      per_band.push_back(column(curve.epochs.size(), stride, [&](std::size_t i) {
        return is_used ? curve.material_i[(i * materials + at) * bands + b] : 0;
      }));
    out.push_back({{"material", names[m]},
                   {"colour", material_colour(m)},
                   {"line_colour", plot_colour(m)},
                   {"intensity", is_used ? std::move(per_band) : Json::array()}});
  }
  return out;
}

Json passes_json(const std::vector<Pass> &passes) {
  Json out = Json::array();
  for (const Pass &pass : passes)
    out.push_back({{"id", pass.id},
                   {"rise", to_iso(pass.rise)},
                   {"culmination", to_iso(pass.culmination)},
                   {"set", to_iso(pass.set)},
                   {"altitude_max", pass.culmination_altitude.degrees()},
                   {"open_start", pass.is_open_at_start},
                   {"open_end", pass.is_open_at_end},
                   {"rows", pass.rows}});
  return out;
}

Json sky_track_json(const std::vector<SkyTrackPoint> &track) {
  const auto each = [&](auto &&value) {
    return column(track.size(), 1, [&](std::size_t i) { return value(track[i]); });
  };
  using P = const SkyTrackPoint &;
  return {{"time", each([](P p) { return to_iso(p.time); })},
          {"pass", each([](P p) { return p.pass_id; })},
          {"az", each([](P p) { return p.azimuth.degrees(); })},
          {"alt", each([](P p) { return p.altitude.degrees(); })},
          {"sunlit", each([](P p) { return p.sunlit; })}};
}

Json pure_json(const std::vector<PureMaterialCurve> &curves) {
  Json out = Json::array();
  for (const PureMaterialCurve &curve : curves)
    out.push_back({{"material", curve.material},
                   {"band", curve.band},
                   {"phase", curve.phase_deg},
                   {"q_scat", curve.q_scat}});
  return out;
}

Json key_frames_json(const std::vector<ReportKeyFrame> &frames) {
  Json out = Json::array();
  for (const ReportKeyFrame &frame : frames) {
    Json pictures = Json::array();
    for (const ReportPicture &picture : frame.pictures)
      pictures.push_back(
          {{"label", picture.label}, {"src", "data:image/png;base64," + base64(picture.png)}});
    out.push_back({{"time", frame.time},
                   {"caption", frame.caption},
                   {"width_m", frame.width_m},
                   {"white", frame.white},
                   {"sun", {frame.sun_right, frame.sun_up}},
                   {"pictures", std::move(pictures)}});
  }
  return out;
}

Json film_json(const std::vector<ReportFilmFrame> &film) {
  Json out = Json::array();
  for (const ReportFilmFrame &frame : film)
    out.push_back({{"time", frame.time}, {"src", "data:image/png;base64," + base64(frame.png)}});
  return out;
}

Result<void> check(const ReportInput &input) {
  const LightCurve &c = input.curve;
  const std::size_t rows = c.epochs.size() * c.bands.size();
  if (c.samples.size() != rows || c.material_i.size() != rows * c.materials.size())
    return fail(ErrorCode::Internal,
                fmt::format("report: {} epochs, {} bands and {} materials do not fit {} samples "
                            "and {} contributions",
                            c.epochs.size(), c.bands.size(), c.materials.size(), c.samples.size(),
                            c.material_i.size()));
  for (const PureMaterialCurve &pure : input.pure_materials)
    if (pure.band >= c.bands.size() || pure.phase_deg.size() != pure.q_scat.size())
      return fail(ErrorCode::Internal,
                  fmt::format("report: curve of material {} is for band {} of {} with {} angles "
                              "and {} values",
                              pure.material, pure.band, c.bands.size(), pure.phase_deg.size(),
                              pure.q_scat.size()));
  return {};
}

} // namespace

Result<std::string> report_data(const ReportInput &input) {
  UMOV_TRY(check(input));
  const LightCurve &curve = input.curve;
  const std::size_t stride =
      std::max<std::size_t>(1, (curve.epochs.size() + report_max_epochs - 1) / report_max_epochs);
  Json bands = Json::array();
  for (std::size_t b = 0; b < curve.bands.size(); ++b) {
    bands.push_back(band_json(curve, b, stride));
    add_errors(bands.back(), input, b, stride);
  }
  Json manifest = Json::array();
  for (const auto &[key, value] : input.manifest)
    manifest.push_back({key, value});
  const Json data = {
      {"title", input.title},
      {"object", curve.object},
      {"norad_cat_id", curve.norad_cat_id},
      {"site",
       {{"name", input.site.name},
        {"lat", input.site.latitude.degrees()},
        {"lon", input.site.longitude.degrees()},
        {"alt_m", input.site.altitude_m}}},
      {"frame", name_of(input.frame)},
      {"mag_system", name_of(curve.magnitudes)},
      {"bounces", curve.bounces},
      {"stride", stride},
      {"passes", passes_json(input.passes)},
      {"epochs", epochs_json(curve, stride)},
      {"bands", std::move(bands)},
      {"contributions", contributions_json(input, stride)},
      {"sky_track", sky_track_json(input.sky_track)},
      {"pure_materials", pure_json(input.pure_materials)},
      {"key_frames", key_frames_json(input.key_frames)},
      {"film", film_json(input.film)},
      {"polarization_scale", polarization_scale()},
      {"turning", turning_json(input)},
      {"manifest", std::move(manifest)},
      {"warnings", input.warnings},
      {"conventions",
       input.conventions.empty() ? standard_conventions(input.frame, curve) : input.conventions},
  };
  return inert_json(data); // NaN becomes null
}

} // namespace umov
