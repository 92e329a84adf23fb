// Tracks of passes over a site's sky.

#include "jobs/pass_models.h"
#include <umov/jobs/passes.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <tuple>
#include <umov/io/sky_page.h>
#include <umov/observation/epochs.h>

namespace umov::jobs {
namespace {

constexpr std::size_t passes_max = 1000; ///< a page that any browser opens at once
constexpr int steps = 60;                ///< of a track

void add_points(const Trajectory &orbit, const SitePass &pass, const PassesRequest &request,
                SkyTrack &out) {
  const double length = seconds_between(pass.set.time, pass.rise.time);
  for (int i = 0; i <= steps; ++i) {
    const Epoch<Utc> time = plus_seconds(pass.rise.time, length * i / steps);
    const auto state = orbit.at(time);
    if (!state)
      continue;
    const ObservingGeometry g = observe(*state, time, request.site, request.shadow);
    out.azimuth.push_back(g.azimuth.degrees());
    out.altitude.push_back(g.altitude.degrees());
    out.is_sunlit.push_back(g.sunlit > 0.5);
  }
}

SkyTrack track_of(const Trajectory &orbit, const ObjectPass &found, const PassesRequest &request) {
  const SitePass &pass = found.pass;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const bool is_lit = pass.sunlit_share > 0;
  SkyTrack out;
  out.id = pass_id(orbit, pass.whole_culmination);
  out.name = orbit.name().empty() ? fmt::format("{}", orbit.norad_cat_id()) : orbit.name();
  out.rise = pass.is_rise_cut ? "" : to_iso(pass.rise.time);
  out.culmination = to_iso(pass.culmination.time);
  out.set = pass.is_set_cut ? "" : to_iso(pass.set.time);
  out.brightest = found.light.brightest ? to_iso(*found.light.brightest) : "";
  out.altitude_max = pass.culmination.altitude.degrees();
  out.visible_altitude = pass.visible_s > 0 ? pass.visible_altitude_max.degrees() : none;
  out.magnitude_min = found.light.magnitude_min;
  out.phase_min = is_lit ? pass.phase_min.degrees() : none;
  out.phase_max = is_lit ? pass.phase_max.degrees() : none;
  out.visible_s = pass.visible_s;
  add_points(orbit, pass, request, out);
  return out;
}

/// Its name, or where it is.
/// The list of sites has names as they are typed ("kitt peak"), a title as they are written.
std::string capitalised(std::string name) {
  bool begins = true;
  for (char &c : name) {
    if (begins && c >= 'a' && c <= 'z')
      c = static_cast<char>(c - 'a' + 'A');
    begins = c == ' ';
  }
  return name;
}

std::string place_of(const Site &site) {
  if (!site.name.empty())
    return capitalised(site.name);
  const double latitude = site.latitude.degrees(), longitude = site.longitude.degrees();
  return fmt::format("{:.3f} {}, {:.3f} {}, {:.0f} m", std::abs(latitude), latitude < 0 ? "S" : "N",
                     std::abs(longitude), longitude < 0 ? "W" : "E", site.altitude_m);
}

/// Numbers of the passes that are drawn: the brightest, then the highest, where there are too many.
std::vector<std::size_t> chosen(const PassesResult &result) {
  std::vector<std::size_t> out(result.found.size());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = k;
  if (out.size() <= passes_max)
    return out;
  const auto rank = [&](std::size_t k) {
    const auto &[object, pass, light] = result.found[k];
    const double faint = std::isnan(light.magnitude_min) ? 99 : light.magnitude_min;
    return std::tuple(faint, pass.visible_s > 0 ? 0 : 1, -pass.visible_altitude_max.degrees(),
                      -pass.culmination.altitude.degrees());
  };
  std::ranges::stable_sort(out, [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  out.resize(passes_max);
  std::ranges::sort(out);
  return out;
}

} // namespace

std::string sky_chart(const PassesRequest &request, const PassesResult &result) {
  SkyPage page;
  page.title = "Passes over " + place_of(request.site);
  page.order = request.order == PassOrder::Magnitude  ? "mag"
               : request.order == PassOrder::Altitude ? "alt"
                                                      : "";
  const auto drawn = chosen(result);
  bool has_magnitudes = false;
  for (const std::size_t k : drawn) {
    const ObjectPass &one = result.found[k];
    page.tracks.push_back(track_of(result.orbits[one.object], one, request));
    has_magnitudes = has_magnitudes || !std::isnan(one.light.magnitude_min);
  }
  page.model = has_magnitudes ? result.model : "";
  page.notes = {
      "The sky overhead: zenith in the middle, north up, east left, the horizon outside. Times "
      "are UTC; an arrow stands at the end of each track, a ring about what hardly moves.",
      "Dotted: more than half of the Sun's disk is behind the Earth.",
      "alt: the highest while visible, that is sunlit in a dark sky; in brackets the highest of a "
      "pass that never is."};
  if (has_magnitudes)
    page.notes.push_back(
        fmt::format("Colour and mag: the brightest magnitude ({}) of the pass while sunlit; its "
                    "time stands beside it where there is room. Magnitudes are {}.",
                    name_of(result.magnitudes), how_magnitudes_are_sampled));
  else
    page.notes.emplace_back(
        "No magnitudes: give --model sphere --material paint_white, or --scene.");
  if (drawn.size() < result.found.size())
    page.notes.push_back(
        fmt::format("The best {} of {} passes are drawn.", drawn.size(), result.found.size()));
  return make_sky_page(page);
}

} // namespace umov::jobs
