#include "io/scenario/instrument.h"

#include "io/scenario/parts.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>

namespace umov::scenario {
namespace {

/// A key's number that is at least `low`.
Result<void> read_at_least(const Node &node, const char *name, double low, double &out) {
  if (!node.has(name))
    return {};
  out = node.number(name, out);
  if (out >= low)
    return {};
  return fail(ErrorCode::BadInput, fmt::format("{} = {}; {} or more was expected", name, out, low),
              node.where(name));
}

/// A key's number from 0 to 1.
Result<void> read_share(const Node &node, const char *name, double &out) {
  out = node.number(name, out);
  if (out >= 0 && out <= 1)
    return {};
  return fail(ErrorCode::BadInput, fmt::format("{} = {}; 0 to 1 was expected", name, out),
              node.where(name));
}

Result<void> read_seeing(const Node &air, Seeing &out) {
  out.outer_scale_m = 25;
  if (!air.has("seeing"))
    return {};
  UMOV_ASSIGN(node, air.child("seeing"));
  UMOV_TRY(read_at_least(node, "arcsec", 1e-3, out.arcsec));
  UMOV_TRY(read_at_least(node, "at_nm", 100, out.at_nm));
  UMOV_TRY(read_at_least(node, "outer_scale_m", 0, out.outer_scale_m));
  UMOV_ASSIGN(profile, node.choice("profile", "moffat", {"moffat", "gauss"}));
  out.profile = profile == "gauss" ? ImageProfile::Gauss : ImageProfile::Moffat;
  return {};
}

Result<void> read_scintillation(const Node &air, ScenarioObservation &out) {
  if (!air.has("scintillation"))
    return {};
  if (air.get("scintillation")->is_string()) {
    UMOV_TRY(air.choice("scintillation", "none", {"none"}));
    out.scintillation_c_y.reset();
    return {};
  }
  UMOV_ASSIGN(node, air.child("scintillation"));
  UMOV_ASSIGN(model, node.choice("model", "osborn2015", {"osborn2015", "none"}));
  double c_y = 1.5;
  UMOV_TRY(read_at_least(node, "c_y", 0, c_y));
  if (model == "none")
    out.scintillation_c_y.reset();
  else
    out.scintillation_c_y = c_y;
  out.has_slewing_factor = node.boolean("slew", false);
  return {};
}

Result<void> read_sky(const Node &air, SkyOptions &out) {
  if (!air.has("sky"))
    return {};
  UMOV_ASSIGN(node, air.child("sky"));
  if (node.has("dark_mag")) {
    UMOV_ASSIGN(dark, node.child("dark_mag"));
    for (const char *letter : {"U", "B", "V", "R", "I"})
      if (dark.has(letter))
        out.dark_mag[letter] = dark.number(letter, 0);
  }
  UMOV_ASSIGN(twilight, node.choice("twilight", "patat2006", {"patat2006", "none"}));
  UMOV_ASSIGN(moon, node.choice("moon", "ks1991", {"ks1991", "none"}));
  out.has_twilight = twilight != "none";
  out.has_moon = moon != "none";
  if (node.has("dilution")) {
    UMOV_ASSIGN(dilution, node.child("dilution"));
    UMOV_TRY(read_share(dilution, "sun", out.dilution_sun));
    UMOV_TRY(read_share(dilution, "moon", out.dilution_moon));
  }
  UMOV_TRY(read_share(node, "p", out.p));
  const SkyOptions usual; // which earlier locks spell out, whatever it says to a sky
  if (node.has("mag")) {
    for (const auto &[name, is_unusual] :
         {std::pair{"dark_mag", node.has("dark_mag")},
          {"twilight", out.has_twilight != usual.has_twilight},
          {"moon", out.has_moon != usual.has_moon},
          {"dilution",
           out.dilution_sun != usual.dilution_sun || out.dilution_moon != usual.dilution_moon}})
      if (is_unusual)
        return fail(ErrorCode::BadInput,
                    fmt::format("{} beside mag: a sky of one brightness has no other parts; leave "
                                "one of them out",
                                name),
                    node.where(name));
    out.mag = node.number("mag", 0);
    const auto &[bright, dark] = sky_mag_range;
    if (!(*out.mag >= bright && *out.mag <= dark))
      return fail(ErrorCode::BadInput,
                  fmt::format("mag = {}: {} to {} mag a square second of arc was expected; the "
                              "darkest skies have 22, twilight 10",
                              *out.mag, bright, dark),
                  node.where("mag"));
  } else if (out.p != usual.p) {
    return fail(ErrorCode::BadInput,
                "p without mag: the polarization of dark sky, twilight and moonlight is computed "
                "(dilution scales it); give mag too, or leave p out",
                node.where("p"));
  }
  return {};
}

Result<SiteAir> read_clear_air(const Node &node) {
  SiteAir out;
  out.has_own_pressure = node.has("pressure_hpa");
  UMOV_TRY(read_at_least(node, "pressure_hpa", 0, out.air.pressure_hpa));
  if (constexpr double most = 1200; out.air.pressure_hpa > most)
    return fail(ErrorCode::BadInput,
                fmt::format("pressure_hpa = {}; up to {} hPa was expected (1 hPa is 100 Pa)",
                            out.air.pressure_hpa, most),
                node.where("pressure_hpa"));
  if (node.has("aerosol")) {
    UMOV_ASSIGN(aerosol, node.child("aerosol"));
    UMOV_TRY(read_at_least(aerosol, "tau_550", 0, out.air.aerosol_550));
    if (constexpr double most = 10; out.air.aerosol_550 > most)
      return fail(ErrorCode::BadInput,
                  fmt::format("tau_550 = {}; an optical depth of up to {} was expected",
                              out.air.aerosol_550, most),
                  aerosol.where("tau_550"));
    out.air.aerosol_exponent = aerosol.number("exponent", out.air.aerosol_exponent);
  }
  UMOV_TRY(read_at_least(node, "ozone_du", 0, out.air.ozone_du));
  UMOV_TRY(read_at_least(node, "water_cm", 0, out.air.water_cm));
  return out;
}

/// The air of an observation. Where there is none, nothing flickers or scatters the light of Sun
/// and Moon; the dark sky, much of it starlight and zodiacal light, stays.
void put_air(const std::optional<SiteAir> &site, ScenarioObservation &out) {
  out.air =
      site ? site->air : Air{.pressure_hpa = 0, .aerosol_550 = 0, .ozone_du = 0, .water_cm = 0};
  out.has_own_pressure = !site || site->has_own_pressure;
  if (site)
    return;
  out.scintillation_c_y.reset();
  out.sky.has_twilight = out.sky.has_moon = false;
}

Result<void> read_atmosphere(const Node &top, ScenarioObservation &out) {
  out.seeing.outer_scale_m = 25;
  if (!top.has("atmosphere"))
    return {};
  UMOV_ASSIGN(air, top.child("atmosphere"));
  UMOV_TRY(read_seeing(air, out.seeing));
  UMOV_TRY(read_scintillation(air, out));
  UMOV_TRY(read_sky(air, out.sky));
  if (air.has("cloud")) {
    UMOV_ASSIGN(cloud, air.child("cloud"));
    UMOV_TRY(read_at_least(cloud, "sd_mag", 0, out.cloud_sd_mag));
    if (constexpr double most = 3; out.cloud_sd_mag > most)
      return fail(
          ErrorCode::BadInput,
          fmt::format("sd_mag = {}: nothing is seen behind a cloud that changes by so much; "
                      "0 to {} mag was expected, .05 of thin cloud",
                      out.cloud_sd_mag, most),
          cloud.where("sd_mag"));
    UMOV_TRY(read_at_least(cloud, "time_s", 1e-6, out.cloud_time_s));
    if (cloud.has("time_s") && !cloud.has("sd_mag"))
      return fail(ErrorCode::BadInput,
                  fmt::format("time_s = {} without sd_mag, which says how much the cloud changes: "
                              "there is none. Add sd_mag, as 0.05, or leave cloud out",
                              out.cloud_time_s),
                  cloud.where("time_s"));
  }
  return {};
}

Result<void> read_sequence(const Node &node, ScenarioObservation &out) {
  if (!node.has("sequence"))
    return {};
  for (const toml::node &item : *node.get("sequence")->as_array()) {
    if (!item.is_table())
      return fail(ErrorCode::BadInput,
                  "sequence: tables such as { analyser_deg = 45 } were expected",
                  node.where("sequence"));
    const Node step(*item.as_table(), "observation.sequence", "observation.sequence", node.file());
    UMOV_TRY(step.check());
    out.sequence.push_back(
        {{step.number("analyser_deg", 0), step.number("plate_deg", 0), 0}, step.text("band", "")});
  }
  return {};
}

Result<void> read_frames(const Node &node, const std::string &folder, ScenarioObservation &out) {
  UMOV_ASSIGN(level, node.choice("level", "aperture", {"aperture", "image"}));
  out.makes_frames = level == "image";
  UMOV_ASSIGN(photometry, node.choice("photometry", "aperture", {"aperture", "image"}));
  out.photometry = photometry == "image" ? FramePhotometry::Image : FramePhotometry::Aperture;
  out.stars = node.text("stars", "");
  if (!out.stars.empty() && !out.stars.starts_with('/') && !folder.empty())
    out.stars = folder + "/" + out.stars;
  UMOV_ASSIGN(trail, node.choice("trail", "whole", {"whole", "slices"}));
  out.cuts_trail = trail == "slices";
  if (out.cuts_trail && out.photometry == FramePhotometry::Image)
    return fail(ErrorCode::BadInput,
                "trail = \"slices\" with photometry = \"image\": pieces of a trail are summed; "
                "photometry = \"aperture\" was expected",
                node.where("trail"));
  if (!out.makes_frames)
    for (const char *name : {"frame_px", "stars", "photometry", "trail"})
      if (node.has(name))
        return fail(ErrorCode::BadInput,
                    fmt::format("{} is of frames, and level = \"{}\" makes none; add level = "
                                "\"image\" or leave it out",
                                name, level),
                    node.where(name));
  if (!node.has("frame_px"))
    return {};
  UMOV_ASSIGN(size, node.numbers("frame_px"));
  constexpr double least = 16, most = 16384;
  const auto fits = [&](double x) { return x >= least && x <= most && x == std::floor(x); };
  if (size.size() != 2 || !fits(size[0]) || !fits(size[1]))
    return fail(ErrorCode::BadInput,
                fmt::format("frame_px: [columns, rows], each {} to {}, was expected", least, most),
                node.where("frame_px"));
  out.frame_px = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  const auto &has = out.instrument.detector.size_px;
  if (has[0] > 0 && (out.frame_px[0] > has[0] || out.frame_px[1] > has[1]))
    return fail(ErrorCode::BadInput,
                fmt::format("frame_px = [{}, {}] on a detector of size_px = [{}, {}]: a frame is a "
                            "part of it",
                            out.frame_px[0], out.frame_px[1], has[0], has[1]),
                node.where("frame_px"));
  return {};
}

Result<void> read_exposures(const Node &node, const std::string &folder, ScenarioObservation &out) {
  if (node.has("bands")) {
    UMOV_ASSIGN(bands, node.strings("bands"));
    if (bands.empty())
      return fail(
          ErrorCode::BadInput,
          "bands = []: one or more were expected, as [\"Bessell.V\"]; without the key those "
          "of [bands] are taken",
          node.where("bands"));
    out.bands = bands;
  }
  UMOV_TRY(read_at_least(node, "width_nm", 1e-6, out.width_nm));
  UMOV_TRY(read_at_least(node, "exposure_s", 1e-9, out.exposure_s));
  out.cadence_s = node.number("cadence_s", out.exposure_s);
  if (!(out.cadence_s >= out.exposure_s))
    return fail(ErrorCode::BadInput,
                fmt::format("cadence_s = {} is shorter than exposure_s = {}; exposures cannot "
                            "overlap",
                            out.cadence_s, out.exposure_s),
                node.where("cadence_s"));
  UMOV_TRY(read_sequence(node, out));
  out.aperture_fwhm = node.number("aperture_fwhm", out.aperture_fwhm);
  if (const auto fits = check_aperture("aperture_fwhm =", out.aperture_fwhm); !fits)
    return fail(fits.error().code, fits.error().message, node.where("aperture_fwhm"));
  UMOV_TRY(read_at_least(node, "clock_error_s", 0, out.clock_error_s));
  return read_frames(node, folder, out);
}

} // namespace

} // namespace umov::scenario

namespace umov {

Result<void> check_aperture(const std::string &name, double fwhm) {
  constexpr ObservingConditions usual;
  constexpr double least = 0.01;
  if (fwhm >= least && fwhm < usual.sky_inner_fwhm)
    return {};
  return fail(
      ErrorCode::BadInput,
      fmt::format("{} {}: {:g} to less than {:g} was expected; the sky is taken from {:g} to "
                  "{:g} widths, and would hold the star",
                  name, fwhm, least, usual.sky_inner_fwhm, usual.sky_inner_fwhm,
                  usual.sky_outer_fwhm));
}

Result<void> check_air_reaches(const std::vector<Band> &bands, const Where &where) {
  for (const Band &band : bands)
    if (const double nm = band.wavelength.nm(); !(nm >= air_from_nm && nm <= air_to_nm))
      return fail(
          ErrorCode::BadInput,
          fmt::format("band \"{}\" is at {:g} nm: what air takes is known from {:g} to {:g} "
                      "nm. Take another band, or [observer] atmosphere = \"none\"",
                      band.name, nm, air_from_nm, air_to_nm),
          where);
  return {};
}

} // namespace umov

namespace umov::scenario {

Result<std::optional<SiteAir>> read_site_air(const Node &top) {
  if (top.has("observer")) {
    UMOV_ASSIGN(observer, top.child("observer"));
    if (const toml::node *value = observer.get("atmosphere"); value != nullptr) {
      if (top.has("atmosphere"))
        return fail(
            ErrorCode::BadInput,
            fmt::format("atmosphere{} beside [atmosphere]: leave one out, both say what air "
                        "there is",
                        value->is_string() ? " = " + quoted(**value->as_string()) : ""),
            observer.where("atmosphere"));
      if (value->is_table()) {
        UMOV_ASSIGN(node, observer.child("atmosphere"));
        return read_clear_air(node);
      }
      if (!value->is_string())
        return fail(ErrorCode::BadInput,
                    "atmosphere is neither a name nor a table; \"none\", \"clear\" or a table as { "
                    "aerosol = { tau_550 = 0.1, exponent = 1.3 }, ozone_du = 300 } was expected",
                    observer.where("atmosphere"));
      UMOV_ASSIGN(name, observer.choice("atmosphere", "none", {"none", "clear"}));
      return name == "none" ? std::optional<SiteAir>() : SiteAir();
    }
  }
  if (top.has("atmosphere")) {
    UMOV_ASSIGN(node, top.child("atmosphere"));
    return read_clear_air(node);
  }
  // What is observed is seen through air unless someone says otherwise.
  return top.has("observation") ? SiteAir() : std::optional<SiteAir>();
}

std::string clear_air_toml(const SiteAir &o) {
  return fmt::format(
      "atmosphere = {{ {}aerosol = {{ tau_550 = {}, exponent = {} }}, ozone_du = {}, "
      "water_cm = {} }}\n",
      o.has_own_pressure ? fmt::format("pressure_hpa = {}, ", shortest(o.air.pressure_hpa)) : "",
      shortest(o.air.aerosol_550), shortest(o.air.aerosol_exponent), shortest(o.air.ozone_du),
      shortest(o.air.water_cm));
}

Result<std::optional<ScenarioObservation>>
read_observation(const Node &top, const std::optional<SiteAir> &air, const std::string &folder) {
  ScenarioObservation out;
  if (top.has("instrument")) {
    const std::string name = top.text("instrument", "");
    const bool is_file = name.ends_with(".toml") && !name.starts_with('/');
    auto found = read_instrument(is_file && !folder.empty() ? folder + "/" + name : name);
    if (!found)
      return fail(found.error().code, found.error().text(), top.where("instrument"));
    out.instrument = *found;
  }
  UMOV_TRY(read_instrument_tables(top, out.instrument));
  if (top.has("instrument_name") && top.has("instrument"))
    return fail(ErrorCode::BadInput,
                "instrument_name beside instrument, which has a name; leave one out",
                top.where("instrument_name"));
  out.instrument.name = top.text("instrument_name", out.instrument.name);
  UMOV_TRY(read_atmosphere(top, out));
  put_air(air, out);
  if (!top.has("observation"))
    return std::optional<ScenarioObservation>();
  UMOV_ASSIGN(node, top.child("observation"));
  UMOV_TRY(read_exposures(node, folder, out));
  for (const auto &[name, value] :
       {std::pair{"telescope.aperture_m", out.instrument.telescope.aperture_m},
        {"telescope.focal_length_m", out.instrument.telescope.focal_length_m},
        {"detector.pixel_um", out.instrument.detector.pixel_um}})
    if (!(value > 0))
      return fail(ErrorCode::BadInput,
                  fmt::format("[observation] needs {}, or an instrument that has it (umov "
                              "instrument list)",
                              name),
                  top.where("observation"));
  return std::optional(out);
}

namespace {

std::string sky_toml(const SkyOptions &sky) {
  if (sky.mag)
    return fmt::format("sky = {{ mag = {}, p = {} }}\n", shortest(*sky.mag), shortest(sky.p));
  std::string dark;
  for (const auto &[letter, mag] : sky.dark_mag)
    dark += (dark.empty() ? "" : ", ") + letter + " = " + shortest(mag);
  std::string out =
      fmt::format("sky = {{ twilight = \"{}\", moon = \"{}\", dilution = {{ sun = "
                  "{}, moon = {} }}",
                  sky.has_twilight ? "patat2006" : "none", sky.has_moon ? "ks1991" : "none",
                  shortest(sky.dilution_sun), shortest(sky.dilution_moon));
  if (!dark.empty())
    out += ", dark_mag = { " + dark + " }";
  return out + " }\n";
}

std::string atmosphere_toml(const ScenarioObservation &o) {
  std::string out = "\n[atmosphere]\n";
  if (o.has_own_pressure)
    out += fmt::format("pressure_hpa = {}\n", shortest(o.air.pressure_hpa));
  out += fmt::format("aerosol = {{ tau_550 = {}, exponent = {} }}\nozone_du = {}\nwater_cm = {}\n",
                     shortest(o.air.aerosol_550), shortest(o.air.aerosol_exponent),
                     shortest(o.air.ozone_du), shortest(o.air.water_cm));
  out += fmt::format("seeing = {{ arcsec = {}, at_nm = {}, outer_scale_m = {}, profile = \"{}\" "
                     "}}\n",
                     shortest(o.seeing.arcsec), shortest(o.seeing.at_nm),
                     shortest(o.seeing.outer_scale_m),
                     o.seeing.profile == ImageProfile::Gauss ? "gauss" : "moffat");
  out += o.scintillation_c_y ? fmt::format("scintillation = {{ c_y = {}, slew = {} }}\n",
                                           shortest(*o.scintillation_c_y), o.has_slewing_factor)
                             : std::string("scintillation = \"none\"\n");
  out += sky_toml(o.sky);
  return out + fmt::format("cloud = {{ sd_mag = {}, time_s = {} }}\n", shortest(o.cloud_sd_mag),
                           shortest(o.cloud_time_s));
}

} // namespace

std::string observation_toml(const ScenarioObservation &o, bool has_air) {
  std::string out = (has_air ? atmosphere_toml(o) : "") + instrument_tables_toml(o.instrument);
  out += fmt::format("\n[observation]\nexposure_s = {}\ncadence_s = {}\nwidth_nm = {}\n"
                     "aperture_fwhm = {}\nclock_error_s = {}\n",
                     shortest(o.exposure_s), shortest(o.cadence_s), shortest(o.width_nm),
                     shortest(o.aperture_fwhm), shortest(o.clock_error_s));
  if (o.makes_frames) {
    out +=
        fmt::format("level = \"image\"\nframe_px = [{}, {}]\nphotometry = \"{}\"\n", o.frame_px[0],
                    o.frame_px[1], o.photometry == FramePhotometry::Image ? "image" : "aperture");
    if (!o.stars.empty())
      out += "stars = " + quoted(o.stars) + "\n";
    if (o.cuts_trail)
      out += "trail = \"slices\"\n";
  }
  std::string bands, steps;
  for (const std::string &band : o.bands)
    bands += (bands.empty() ? "" : ", ") + quoted(band);
  if (!bands.empty())
    out += "bands = [" + bands + "]\n";
  for (const SequenceStep &step : o.sequence)
    steps += fmt::format("{}{{ analyser_deg = {}, plate_deg = {}, band = {} }}",
                         steps.empty() ? "" : ", ", shortest(step.state.analyser_deg),
                         shortest(step.state.plate_deg), quoted(step.band));
  if (!steps.empty())
    out += "sequence = [" + steps + "]\n";
  return out;
}

} // namespace umov::scenario
