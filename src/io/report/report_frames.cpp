#include <umov/io/png.h>
#include <umov/io/report_frames.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace umov {
namespace {

/// Epochs with light, pass by pass.
std::vector<std::vector<std::size_t>> lit_passes(const LightCurve &curve) {
  std::vector<std::vector<std::size_t>> out;
  const std::string *last = nullptr;
  for (std::size_t i = 0; i < curve.epochs.size(); ++i) {
    const LightCurveEpoch &epoch = curve.epochs[i];
    if (last == nullptr || *last != epoch.pass_id)
      out.emplace_back();
    last = &epoch.pass_id;
    if (!epoch.is_dark)
      out.back().push_back(i);
  }
  return out;
}

void choose_from_pass(const LightCurve &curve, const std::vector<std::size_t> &lit,
                      std::size_t count, std::set<std::size_t> &chosen) {
  if (lit.empty() || count == 0)
    return;
  const std::size_t band = curve.bands.size() / 2;
  const auto light = [&](std::size_t i) {
    return curve.samples[i * curve.bands.size() + band].intensity;
  };
  const auto brightest = static_cast<std::size_t>(
      std::max_element(lit.begin(), lit.end(),
                       [&](std::size_t a, std::size_t b) { return light(a) < light(b); }) -
      lit.begin());
  // Even in rank, which is even in time; the nearest one gives way to the brightest.
  std::set<std::size_t> ranks;
  for (std::size_t k = 0; k < count; ++k)
    ranks.insert(count == 1 ? brightest : k * (lit.size() - 1) / (count - 1));
  const auto distance = [&](std::size_t rank) {
    return rank > brightest ? rank - brightest : brightest - rank;
  };
  ranks.erase(*std::min_element(ranks.begin(), ranks.end(), [&](std::size_t a, std::size_t b) {
    return distance(a) < distance(b);
  }));
  ranks.insert(brightest);
  for (const std::size_t rank : ranks)
    chosen.insert(lit[rank]);
}

/// Pictures that a pass can fill with something new: one, and one more for every 20 s of it.
std::size_t worth(const LightCurve &curve, const std::vector<std::size_t> &lit) {
  if (lit.empty())
    return 0;
  constexpr double apart_s = 20;
  const double length = seconds_between(curve.epochs[lit.back()].geometry.time,
                                        curve.epochs[lit.front()].geometry.time);
  return 1 + static_cast<std::size_t>(length / apart_s);
}

/// A band as people write it: 550 nm.
std::string spelt(const std::string &band) {
  return band.starts_with("nm:") ? band.substr(3) + " nm" : band;
}

std::string caption_of(const LightCurve &curve, std::size_t epoch, std::size_t band) {
  const LightCurveSample &s = curve.samples[epoch * curve.bands.size() + band];
  std::string text =
      fmt::format("phase {:.1f} deg", curve.epochs[epoch].geometry.phase_angle.degrees());
  if (std::isfinite(s.magnitude))
    text +=
        fmt::format(", {}{:.2f} mag", has_magnitude_limit(s) ? "fainter than " : "", s.magnitude);
  if (std::isfinite(s.p))
    text += fmt::format(", p {:.1f} %", 100 * s.p);
  return text + " (" + spelt(curve.bands[band].name) + ")";
}

Result<ReportKeyFrame> picture_set(const KeyFrameRaster &raster, const LightCurve &curve,
                                   std::size_t epoch, std::size_t band) {
  const LightCurveEpoch &at = curve.epochs[epoch];
  ReportKeyFrame out;
  // Each by itself: beside a glint in one picture the object would be black in all others.
  const double white = common_exposure(std::span(&raster, 1));
  out.white = white;
  out.time = to_iso(at.geometry.time);
  out.caption = caption_of(curve, epoch, band);
  out.width_m = 2 * raster.half_width_m;
  const Vec3<Body> north = celestial_north(at), v = at.pose.observer;
  const Vec3<Body> up = normalized(north - v * dot(north, v));
  out.sun_up = dot(at.pose.sun, up);
  out.sun_right = dot(at.pose.sun, cross(up, v));
  const std::uint32_t size = raster.side / raster.samples;
  const std::pair<KeyFrameShading, const char *> shadings[] = {
      {KeyFrameShading::Intensity, "brightness"},
      {KeyFrameShading::Polarization, "polarization"},
      {KeyFrameShading::Material, "material"}};
  for (const auto &[shading, label] : shadings) {
    UMOV_ASSIGN(png, encode_png(size, size, shade(raster, shading, white)));
    out.pictures.push_back({label, std::move(png)});
  }
  return out;
}

/// The rasters of some epochs, one band.
Result<std::vector<KeyFrameRaster>> trace_epochs(const Scene &scene, const LightCurve &curve,
                                                 std::span<const std::size_t> epochs,
                                                 const KeyFrameOptions &options,
                                                 const std::vector<Joint> &joints) {
  const KeyFrameStage stage(scene, joints, options.bounces);
  std::vector<KeyFrameRaster> out;
  for (const std::size_t i : epochs) {
    if (i >= curve.epochs.size())
      return fail(ErrorCode::Internal,
                  fmt::format("key frame of epoch {}; the curve has {}", i, curve.epochs.size()));
    const LightCurveEpoch &at = curve.epochs[i];
    UMOV_ASSIGN(one, stage.trace({at.pose, celestial_north(at)}, at.joint_angles_rad, options,
                                 std::span(&options.band, 1)));
    out.push_back(std::move(one.front()));
  }
  return out;
}

} // namespace

Vec3<Body> celestial_north(const LightCurveEpoch &epoch) {
  return rotation_from<Body, Gcrs>(epoch.body_from_gcrs) * Vec3<Gcrs>{0, 0, 1};
}

std::vector<std::size_t> choose_key_epochs(const LightCurve &curve, std::size_t count) {
  std::set<std::size_t> chosen;
  for (const auto &lit : lit_passes(curve))
    choose_from_pass(curve, lit, std::min(count, worth(curve, lit)), chosen);
  return {chosen.begin(), chosen.end()};
}

Result<std::vector<ReportKeyFrame>> make_key_frames(const Scene &scene, const LightCurve &curve,
                                                    std::span<const std::size_t> epochs,
                                                    const KeyFrameOptions &options,
                                                    const std::vector<Joint> &joints) {
  UMOV_ASSIGN(rasters, trace_epochs(scene, curve, epochs, options, joints));
  std::vector<ReportKeyFrame> out;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    UMOV_ASSIGN(frame, picture_set(rasters[k], curve, epochs[k], options.band));
    out.push_back(std::move(frame));
  }
  return out;
}

Result<std::vector<ReportFilmFrame>> make_film(const Scene &scene, const LightCurve &curve,
                                               std::size_t count, const KeyFrameOptions &options,
                                               const std::vector<Joint> &joints) {
  const auto passes = lit_passes(curve);
  const auto longest = std::ranges::max_element(
      passes, {}, [](const std::vector<std::size_t> &lit) { return lit.size(); });
  std::vector<ReportFilmFrame> out;
  if (longest == passes.end() || longest->size() < 3 || count < 2)
    return out;
  std::vector<std::size_t> epochs;
  const std::size_t pictures = std::min(count, longest->size());
  for (std::size_t k = 0; k < pictures; ++k)
    epochs.push_back((*longest)[k * (longest->size() - 1) / (pictures - 1)]);
  UMOV_ASSIGN(rasters, trace_epochs(scene, curve, epochs, options, joints));
  const double white = common_exposure(rasters);
  for (std::size_t k = 0; k < pictures; ++k) {
    UMOV_ASSIGN(png, encode_png(options.size, options.size,
                                shade(rasters[k], KeyFrameShading::Intensity, white)));
    out.push_back({to_iso(curve.epochs[epochs[k]].geometry.time), std::move(png)});
  }
  return out;
}

} // namespace umov
