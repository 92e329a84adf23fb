#include "jobs/observe_frames.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov::jobs {
namespace {

constexpr double earth_rad_s = 7.292115e-5; // of the turning Earth
constexpr double arcsec = pi / 180 / 3600;

/// About the pole of the GCRS, which the Earth's has left by a tenth of a degree since 2000.
Vec3<Gcrs> turned_with_earth(Vec3<Gcrs> v, double seconds) {
  const double a = earth_rad_s * seconds, c = std::cos(a), s = std::sin(a);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

Vec3<Gcrs> direction_of(const FieldStar &star) {
  const double ra = star.ra_deg * pi / 180, dec = star.dec_deg * pi / 180;
  return {std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)};
}

/// Through three values at three times.
double parabola(const std::array<double, 3> &t, const std::array<double, 3> &v, double at) {
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    out += v[k] * (at - t[a]) * (at - t[b]) / ((t[k] - t[a]) * (t[k] - t[b]));
  }
  return out;
}

} // namespace

Result<std::vector<FieldStar>> field_of(const ScenarioObservation &o,
                                        std::vector<InputFile> &inputs, Diagnostics &diagnostics) {
  if (o.stars.empty())
    return std::vector<FieldStar>();
  UMOV_ASSIGN(text, read_file(o.stars));
  inputs.push_back({o.stars, sha256_hex(text)});
  return read_stars_text(text, o.stars, diagnostics);
}

double trail_feature_s(const ScenarioObservation &o, const Track &track,
                       std::span<const Exposure> exposures, double fwhm_arcsec) {
  if (!o.makes_frames || o.instrument.telescope.tracking == Tracking::Satellite)
    return 0;
  double fastest = 0;
  const std::size_t step = std::max<std::size_t>(1, exposures.size() / 50);
  for (std::size_t k = 0; k < exposures.size(); k += step) {
    const ObservingGeometry &g = exposures[k].middle;
    const auto after = track.observe(plus_seconds(g.time, 0.1));
    if (after)
      fastest = std::max(fastest, angle_between(g.to_observer, after->to_observer) / 0.1);
  }
  // The Earth turns by less than this beside it.
  return fwhm_arcsec * arcsec / 2 / (fastest + earth_rad_s);
}

double longest_trail_px(const Setup &s, std::span<const Exposure> exposures) {
  const Tracking tracking = s.observation.instrument.telescope.tracking;
  double fastest = 0;
  const std::size_t step = std::max<std::size_t>(1, exposures.size() / 50);
  for (std::size_t k = 0; k < exposures.size(); k += step) {
    const ObservingGeometry &g = exposures[k].middle;
    if (const auto after = s.track.observe(plus_seconds(g.time, 0.1)))
      fastest = std::max(fastest, rate_over_detector(tracking, g, *after));
  }
  return trail_length_px(fastest, s.observation.exposure_s, s.observers.front().pixel_arcsec());
}

double rate_over_detector(Tracking tracking, const ObservingGeometry &first,
                          const ObservingGeometry &last) {
  const double seconds = seconds_between(last.time, first.time);
  if (tracking == Tracking::Satellite || !(seconds > 0))
    return 0;
  // Of a telescope that stands the later direction is where it was before the Earth turned.
  const double turned_s = tracking == Tracking::Fixed ? -seconds : 0;
  return angle_between(first.to_observer, turned_with_earth(last.to_observer, turned_s)) / seconds;
}

FrameView::FrameView(const Setup &setup, const Exposure &exposure)
    : s_(setup), e_(exposure), is_mirrored_(is_mirrored(setup.observation.instrument.telescope)) {
  const ScenarioObservation &o = s_.observation;
  middle_ = at(e_.middle);
  Draws draws({s_.scenario.seed, s_.observers[e_.planned.band].conditions().object,
               e_.planned.plan.index, 0, 0xf01e}); // apart from light, sky and air
  const double error =
      o.instrument.telescope.tracking_error_arcsec / s_.observers[e_.planned.band].pixel_arcsec();
  const double dx = error * draws.normal(), dy = error * draws.normal();
  origin_ = {(o.frame_px[0] - 1) / 2. + dx, (o.frame_px[1] - 1) / 2. + dy};
}

Angle FrameView::axis_pa(const ObservingGeometry &g) const {
  const Instrument &instrument = s_.observation.instrument;
  const Angle on_sky =
      axis_on_sky(instrument.telescope, x_axis_from_zenith(instrument, g), g.altitude, g.azimuth);
  return Angle::radians(on_sky.radians() + zenith_in(PolarizationFrame::Equatorial, g).radians());
}

FrameView::Axes FrameView::at(const ObservingGeometry &g) const {
  const Tracking tracking = s_.observation.instrument.telescope.tracking;
  const ObservingGeometry &pointed = tracking == Tracking::Satellite ? g : e_.middle;
  Axes out;
  out.centre = pointed.to_observer * -1.;
  const Vec3<Gcrs> east = normalized(cross(Vec3<Gcrs>{0, 0, 1}, out.centre));
  const Vec3<Gcrs> north = cross(out.centre, east);
  const double pa = axis_pa(pointed).radians(), hand = is_mirrored_ ? -1 : 1;
  out.x = north * std::cos(pa) + east * std::sin(pa);
  out.y = (east * std::cos(pa) - north * std::sin(pa)) * hand;
  if (tracking == Tracking::Fixed) {
    const double elapsed = seconds_between(g.time, e_.middle.time);
    out = {turned_with_earth(out.centre, elapsed), turned_with_earth(out.x, elapsed),
           turned_with_earth(out.y, elapsed)};
  }
  return out;
}

std::optional<FramePoint> FrameView::image(const Axes &axes, Vec3<Gcrs> direction) const {
  const double depth = dot(direction, axes.centre);
  if (!(depth > 0.1))
    return std::nullopt;
  const double scale = 1 / (depth * s_.observers[e_.planned.band].pixel_arcsec() * arcsec);
  return FramePoint{origin_.x + dot(direction, axes.x) * scale,
                    origin_.y + dot(direction, axes.y) * scale};
}

/// Row y begins y line times after the first, so what moves by v rows a second meets its rows'
/// shutters 1/(1 - v line time) times as far apart as if it stood.
double FrameView::stretch(Speed speed) const {
  return 1 / (1 - rolling_change(s_.observation.instrument.detector, speed.y));
}

double FrameView::stretch(std::span<const TrackPoint> points) const {
  return stretch(speed_of(points));
}

double FrameView::rows_per_s(std::span<const TrackPoint> points) const {
  const double own = std::abs(speed_of(points).y);
  if (s_.stars.empty())
    return own;
  const ObservingGeometry &first = points.front().geometry, &last = points.back().geometry;
  const auto from = image(at(first), middle_.centre), to = image(at(last), middle_.centre);
  const double seconds = seconds_between(last.time, first.time);
  return from && to && seconds > 0 ? std::max(own, std::abs(to->y - from->y) / seconds) : own;
}

FrameView::Speed FrameView::speed_of(std::span<const TrackPoint> points) const {
  const ObservingGeometry &first = points.front().geometry, &last = points.back().geometry;
  const auto from = image(at(first), first.to_observer * -1.);
  const auto to = image(at(last), last.to_observer * -1.);
  const double seconds = seconds_between(last.time, first.time);
  if (!from || !to || !(seconds > 0))
    return {};
  return {(to->x - from->x) / seconds, (to->y - from->y) / seconds};
}

/// Where something is when its row is exposed that would be at `at` if all rows were exposed with
/// the middle one. The light is that of the same moment: a trail's rows are a millisecond apart.
FramePoint FrameView::rolled(FramePoint at, Speed speed) const {
  const double middle_row = (s_.observation.frame_px[1] - 1) / 2.;
  const double later =
      rolling_change(s_.observation.instrument.detector, at.y - middle_row) * stretch(speed);
  return {at.x + speed.x * later, at.y + speed.y * later};
}

std::optional<FrameStar> FrameView::star(const FieldStar &star, std::span<const TrackPoint> points,
                                         double fwhm_px) const {
  const Vec3<Gcrs> direction = direction_of(star);
  // In one exposure nothing turns by more than a few degrees.
  if (dot(direction, middle_.centre) < 0.9)
    return std::nullopt;
  const std::size_t which[] = {0, points.size() / 2, points.size() - 1};
  std::array<double, 3> t{}, x{}, y{};
  for (std::size_t k = 0; k < 3; ++k) {
    const ObservingGeometry &g = points[which[k]].geometry;
    const auto there = image(at(g), direction);
    if (!there)
      return std::nullopt;
    t[k] = seconds_between(g.time, e_.middle.time);
    x[k] = there->x, y[k] = there->y;
  }
  const double margin = 8 * fwhm_px + std::hypot(x[2] - x[0], y[2] - y[0]);
  const auto &size = s_.observation.frame_px;
  if (x[1] < -margin || y[1] < -margin || x[1] > size[0] + margin || y[1] > size[1] + margin)
    return std::nullopt;
  const double exposure = e_.planned.plan.exposure_s;
  const Speed moves{(x[2] - x[0]) / (t[2] - t[0]), (y[2] - y[0]) / (t[2] - t[0])};
  const double speed = std::hypot(moves.x, moves.y);
  FrameStar out;
  for (const ExposureNode &node :
       exposure_nodes(exposure, speed > 0 ? fwhm_px / 2 / speed : exposure)) {
    out.path.push_back(
        rolled({parabola(t, x, node.offset_s), parabola(t, y, node.offset_s)}, moves));
    out.weight.push_back(node.weight * stretch(moves));
  }
  out.flux = s_.observers[e_.planned.band].band().zero_flux * std::pow(10, -0.4 * star.mag);
  return out;
}

FramePlan FrameView::plan(std::span<const TrackPoint> points,
                          std::vector<std::vector<Stokes<InstrumentAxes>>> flux,
                          double fwhm_px) const {
  const ScenarioObservation &o = s_.observation;
  FramePlan out;
  out.columns = o.frame_px[0];
  out.rows = o.frame_px[1];
  out.photometry = o.photometry;
  out.cuts_trail = o.cuts_trail;
  const Speed moves = speed_of(points);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const ObservingGeometry &g = points[n].geometry;
    const FramePoint there = image(at(g), g.to_observer * -1.).value_or(origin_);
    out.object.push_back({rolled(there, moves), s_.nodes[n].weight * stretch(moves),
                          s_.nodes[n].offset_s, std::move(flux[n])});
  }
  for (const FieldStar &one : s_.stars)
    if (auto found = star(one, points, fwhm_px))
      out.stars.push_back(std::move(*found));
  return out;
}

std::vector<FitsCard> FrameView::world() const {
  const auto &size = s_.observation.frame_px;
  const double degrees = s_.observers[e_.planned.band].pixel_arcsec() / 3600;
  const ObservingGeometry &g = e_.middle;
  const double pa = axis_pa(g).radians(), hand = is_mirrored_ ? -1 : 1;
  return {{"CTYPE1", std::string("RA---TAN"), ""},
          {"CTYPE2", std::string("DEC--TAN"), ""},
          {"CUNIT1", std::string("deg"), ""},
          {"CUNIT2", std::string("deg"), ""},
          {"CRPIX1", (size[0] + 1) / 2., "where the telescope is meant to point"},
          {"CRPIX2", (size[1] + 1) / 2., ""},
          {"CRVAL1", g.right_ascension.degrees(), "middle of the exposure, no refraction"},
          {"CRVAL2", g.declination.degrees(), ""},
          {"CD1_1", degrees * std::sin(pa), ""},
          {"CD1_2", degrees * std::cos(pa) * hand, ""},
          {"CD2_1", degrees * std::cos(pa), ""},
          {"CD2_2", -degrees * std::sin(pa) * hand, ""},
          {"RADESYS", std::string("ICRS"), ""}};
}

std::string frame_name(std::uint32_t object, std::uint32_t exposure) {
  return object == 0 ? fmt::format("frame_{:06}.fits", exposure)
                     : fmt::format("frame_{}_{:06}.fits", object + 1, exposure);
}

FitsImage fits_of(const Setup &s, const Exposure &e, const Recorded &r) {
  const Instrument &i = s.observation.instrument;
  const ExposurePlan &plan = e.planned.plan;
  const BandObserver &observer = s.observers[e.planned.band];
  FitsImage out;
  const FramedExposure &framed = *r.frames;
  out.columns = framed.planes.front().frame.columns;
  out.rows = framed.planes.front().frame.rows;
  const bool is_multiplied = i.detector.model == DetectorModel::Emccd;
  out.is_16_bit = has_converter(i.detector) && i.detector.bits <= 16;
  for (const FramePlane &plane : framed.planes)
    out.planes.emplace_back(plane.frame.adu);
  out.cards = {
      {"OBJECT", s.object, ""},
      {"DATE-OBS", to_iso(plus_seconds(e.stamp, -plan.exposure_s / 2)), "begin, by the clock"},
      {"DATE-AVG", to_iso(e.stamp), "middle"},
      {"TIMESYS", std::string("UTC"), ""},
      {"EXPTIME", plan.exposure_s, "[s]"},
      {"INSTRUME", i.name.empty() ? std::string("in the scenario") : i.name, ""},
      {"FILTER", observer.band().name, ""},
      {"BUNIT", std::string("adu"), ""},
      {"GAIN", has_converter(i.detector) ? i.detector.gain_e_adu : 1,
       is_multiplied ? "[electron/adu] behind the register" : "[electron/adu]"},
      {"RDNOISE", has_converter(i.detector) ? i.detector.read_e : 0, "[electron]"},
      {"BIASLVL", zero_adu(i.detector), "[adu]"},
      {"AIRMASS", r.airmass, ""},
      {"PIXSCALE", observer.pixel_arcsec(), "[arcsec]"},
      {"FWHM", observer.fwhm_arcsec(r.airmass), "[arcsec] of a star, before pixels"},
      {"POLTYPE", std::string(name_of(i.polarimeter.type)), "kind of polarimeter"},
      {"ANALYSER", plan.state.analyser_deg, "[deg] from the x axis"},
      {"PLATE", plan.state.plate_deg, "[deg] from the x axis"},
      {"XAXISPA", r.axis.degrees(),
       fmt::format("[deg] of the x axis, {}", name_of(s.scenario.frame))},
      {"SETID", static_cast<std::int64_t>(e.planned.set), "as in counts"}};
  if (is_multiplied)
    out.cards.push_back({"EMGAIN", i.detector.em_gain, "of the register, before GAIN"});
  const auto &angles = i.polarimeter.angles_deg;
  if (i.polarimeter.type == PolarimeterType::Mosaic)
    for (std::size_t k = 0; k < 4; ++k)
      out.cards.push_back({fmt::format("MOSAIC{}{}", k / 2, k % 2), angles[k],
                           "[deg] of pixels (row mod 2, column mod 2)"});
  else
    for (std::size_t k = 0; k < framed.planes.size(); ++k)
      out.cards.push_back({fmt::format("CHANNEL{}", k + 1), framed.planes[k].channel, ""});
  for (FitsCard &card : FrameView(s, e).world())
    out.cards.push_back(std::move(card));
  return out;
}

} // namespace umov::jobs
