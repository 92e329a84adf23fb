#include <umov/io/sky_page.h>

#include "io/report/page.h"

#include <cmath>
#include <umov/core/embedded.h>

UMOV_EMBEDDED(sky_page_template)
UMOV_EMBEDDED(sky_page_js)

namespace umov {
namespace {

using Json = nlohmann::ordered_json;

/// Rounded to what a screen shows: a catalogue's night stays a page.
Json number(double value, double step) {
  return std::isfinite(value) ? Json(std::round(value / step) * step) : Json(nullptr);
}

Json track_json(const SkyTrack &track) {
  Json azimuth = Json::array(), altitude = Json::array(), sunlit = Json::array();
  for (const double v : track.azimuth)
    azimuth.push_back(std::lround(v * 100)); // hundredths of a degree
  for (const double v : track.altitude)
    altitude.push_back(std::lround(v * 100));
  for (const bool is_sunlit : track.is_sunlit)
    sunlit.push_back(is_sunlit ? 1 : 0);
  return {{"id", track.id},
          {"name", track.name},
          {"rise", track.rise},
          {"culmination", track.culmination},
          {"set", track.set},
          {"brightest", track.brightest},
          {"alt", number(track.altitude_max, 0.01)},
          {"alt_visible", number(track.visible_altitude, 0.01)},
          {"mag", number(track.magnitude_min, 0.001)},
          {"phase", {number(track.phase_min, 0.1), number(track.phase_max, 0.1)}},
          {"visible", number(track.visible_s, 0.1)},
          {"az100", azimuth},
          {"alt100", altitude},
          {"sunlit", sunlit}};
}

} // namespace

std::string make_sky_page(const SkyPage &page) {
  Json data{{"title", page.title},
            {"model", page.model},
            {"order", page.order},
            {"tracks", Json::array()},
            {"notes", page.notes}};
  for (const SkyTrack &track : page.tracks)
    data["tracks"].push_back(track_json(track));
  const PageSlot slots[] = {{"DATA", inert_json(data)}, {"SCRIPT", std::string(sky_page_js())}};
  return fill_page(sky_page_template(), slots);
}

} // namespace umov
