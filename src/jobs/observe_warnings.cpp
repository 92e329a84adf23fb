#include "jobs/observe_warnings.h"

#include "jobs/observe_frames.h"
#include "jobs/observed_object.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <umov/atmosphere/scintillation.h>
#include <umov/instrument/mosaic.h>
#include <umov/instrument/pixel_image.h>

namespace umov::jobs {
namespace {

bool is_glaring(const Recorded &r) {
  double star = 0, sky = 0;
  for (const ChannelCounts &c : r.channels)
    star += c.mean_star, sky += c.mean_sky;
  return sky > 10 * star;
}

/// The air changes the light by more than what the formula is made for, small changes.
bool is_flickering(const Recorded &r) {
  constexpr double weak = 0.5;
  return std::ranges::any_of(r.channels, [](const auto &c) { return c.scintillation > weak; });
}

bool has_full_channel(const Recorded &r) {
  return std::ranges::any_of(r.channels, [](const auto &c) { return c.is_saturated; });
}

} // namespace

void warn_of_mosaic(const Setup &s, Diagnostics &diagnostics) {
  const ScenarioObservation &o = s.observation;
  if (o.instrument.polarimeter.type != PolarimeterType::Mosaic)
    return;
  for (const BandObserver &observer : s.observers) {
    const double width = observer.fwhm_arcsec(1) / observer.pixel_arcsec();
    if (width < 3)
      diagnostics.warn(fmt::format(
          "{}: a star is {:.2g} px wide at the zenith; under 3 px, summed light of the four "
          "orientations is polarized by where the star stands on its pixels, up to {:.2g} in q. "
          "Defocus, or fit the image of each orientation.",
          observer.band().name, width, -mosaic_alias(width, 0, 0).q)); // on the middle of a pixel
    // Wider images have smoother edges: theirs is less than that of the widest that is summed here.
    constexpr double widest = 16;
    const double taken = std::clamp(width, narrowest_image_px, widest);
    if (o.aperture_fwhm < 2)
      diagnostics.warn(fmt::format(
          "{}: {:g} widths of a star are summed; the edge of an aperture below 2 widths cuts the "
          "four orientations unevenly, up to {:.2g} in q or u. Give observation.aperture_fwhm = 2.",
          observer.band().name, o.aperture_fwhm,
          mosaic_aperture_alias(o.seeing.profile, taken, o.aperture_fwhm * taken)));
  }
}

void warn_of_trails(const Setup &s, std::span<const Exposure> exposures, Diagnostics &diagnostics) {
  const auto &size = s.observation.instrument.detector.size_px;
  if (s.observation.makes_frames || size[0] < 1)
    return;
  const double diagonal = std::hypot(size[0], size[1]), trail = longest_trail_px(s, exposures);
  if (trail <= diagonal)
    return;
  diagnostics.warn(fmt::format(
      "{}: a trail of {:.0f} px, and detector.size_px = [{}, {}] ({:.0f} px across): its light and "
      "its pixels are counted as if all of it fell on the detector. Shorten observation.exposure_s "
      "= {:g}, or give telescope.tracking = \"satellite\"",
      s.object, trail, size[0], size[1], diagonal, s.observation.exposure_s));
}

std::string brief_words(const std::string &name, double exposure_s, double aperture_m) {
  const double crossing_s = wind_crossing_s(aperture_m);
  if (!(exposure_s < crossing_s))
    return "";
  return fmt::format("{}: the air's pattern takes {:.2g} s to cross the aperture. Scintillation is "
                     "taken as that of {:.2g} s",
                     name, crossing_s, crossing_s);
}

void warn_of_setup(const Setup &s, Diagnostics &diagnostics) {
  const Detector &d = s.observation.instrument.detector;
  // The bias takes a little of it; a well that is a few per cent over is every maker's choice.
  const double numbers = std::exp2(d.bits) * d.gain_e_adu;
  if (has_converter(d) && d.em_gain <= 1 && d.well_e > numbers)
    diagnostics.warn(
        fmt::format("detector: a well of {:g} e is more than bits = {} with {:g} e/ADU "
                    "tell ({:g} e): numbers fill first",
                    d.well_e, d.bits, d.gain_e_adu, numbers));
  // Noise of half a step makes a mean of steps that of the light; of a third it does not.
  if (constexpr double coarse = 3;
      has_converter(d) && d.em_gain <= 1 && d.gain_e_adu > coarse * std::hypot(d.read_e, 1.0))
    diagnostics.warn(fmt::format("detector: gain_e_adu = {:g} with read_e = {:g}: dark pixels fall "
                                 "on one number, and their mean is off by up to half of it. A "
                                 "step of {:.2g} e or less was expected",
                                 d.gain_e_adu, d.read_e, coarse * std::hypot(d.read_e, 1.0)));
  if (d.nonlinearity > 0 && !s.observation.makes_frames)
    diagnostics.warn(fmt::format("detector.nonlinearity = {:g} says nothing to level = "
                                 "\"aperture\", whose counts are those behind its correction; "
                                 "level = \"image\" has it",
                                 d.nonlinearity));
  if (s.observation.width_nm != line_width_nm &&
      std::ranges::all_of(s.scenario.bands, [](const Band &b) { return b.curve != nullptr; }))
    diagnostics.warn(fmt::format("observation.width_nm = {:g} says nothing to bands with a curve, "
                                 "which have their own width; it is of nm:550 and the like",
                                 s.observation.width_nm));
  const Telescope &telescope = s.observation.instrument.telescope;
  if (telescope.port == TelescopePort::Cassegrain && telescope.mirror != Telescope{}.mirror)
    diagnostics.warn(fmt::format("telescope.mirror = \"{}\" says nothing at a Cassegrain focus, "
                                 "before which no flat mirror stands",
                                 telescope.mirror));
  if (std::string brief =
          brief_words(fmt::format("observation.exposure_s = {:g}", s.observation.exposure_s),
                      s.observation.exposure_s, telescope.aperture_m);
      s.observation.scintillation_c_y && !brief.empty())
    diagnostics.warn(brief + ", and drawn for each exposure by itself, though exposures that are "
                             "closer than that flicker together");
  const double site_height_m = s.scenario.observer->altitude_m;
  if (constexpr double highest = 9000; site_height_m > highest)
    diagnostics.warn(fmt::format("observer.alt_m = {:g}: higher than any mountain. It is in metres",
                                 site_height_m));
}

std::vector<Tally> ObservationTally::words(const Scenario &scenario, std::size_t total) {
  std::vector<Tally> out(Kinds);
  out[Cut] = {"frame",
              "with an aperture that reaches over the edge: enlarge observation.frame_px, or "
              "shorten the trail",
              ""};
  out[Roomless] = {"frame",
                   "without room for the ring that tells the sky: their sky is no number, and umov "
                   "reduce leaves them out. Enlarge observation.frame_px",
                   ""};
  out[Crowded] = {"frame",
                  "with a star in the aperture that has more than a hundredth of the object's "
                  "light: it is in the counts",
                  ""};
  out[Lost] = {"frame", "in which the star's image could not be fitted: its counts are no numbers",
               ""};
  out[Glaring] = {"exposure",
                  "with a sky more than ten times as bright as the object in the aperture: an "
                  "error of one per cent of it is a tenth of the object",
                  ""};
  out[Rolled] = {"exposure",
                 "of an object that trails under a rolling shutter: by its direction it is exposed "
                 "by more than a thousandth longer or shorter than exposure_s, and I is as much "
                 "too large or too small",
                 ""};
  out[Flickering] = {"exposure",
                     "in which light flickers by more than half of itself (scint_sd): the formula "
                     "is of weak scintillation, and may give some times too much here",
                     ""};
  out[Saturated] = {"", "exposures are saturated",
                    fmt::format("every exposure of {} is saturated. Shorten observation.exposure_s "
                                "= {}, or defocus (atmosphere.seeing.arcsec)",
                                total, scenario.observation->exposure_s)};
  return out;
}

void ObservationTally::add(const Recorded &r) {
  const auto count = [this](Kind kind, bool is_such) { counts_[kind] += is_such ? 1u : 0u; };
  count(Glaring, is_glaring(r));
  count(Rolled, r.is_rolled);
  count(Flickering, is_flickering(r));
  count(Saturated, has_full_channel(r));
  if (!r.frames)
    return;
  count(Cut, r.frames->is_cut);
  count(Crowded, r.frames->has_star_in_aperture);
  count(Lost, std::ranges::any_of(r.channels, [](const auto &c) { return std::isnan(c.counts); }));
  count(Roomless, std::ranges::any_of(r.channels, [](const auto &c) {
          return std::isnan(c.sky) && !std::isnan(c.counts);
        }));
}

} // namespace umov::jobs
