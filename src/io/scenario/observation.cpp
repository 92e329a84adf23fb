#include "io/scenario/instrument.h"

#include "io/scenario/parts.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/extinction_file.h>

namespace umov::scenario {
namespace {

constexpr Bounds share{0, 1, "0 to 1"};

Result<void> read_seeing(const Node &air, Seeing &out) {
  out.outer_scale_m = 25;
  if (!air.has("seeing"))
    return {};
  UMOV_ASSIGN(node, air.child("seeing"));
  Problems problems;
  problems.went(
      read_number(node, "arcsec", {1e-3, 1000, "0.001 to 1000 seconds of arc"}, out.arcsec));
  problems.went(read_number(node, "at_nm", {100, 1e5, "100 nm to 100000 nm"}, out.at_nm));
  problems.went(read_number(node, "outer_scale_m", {0, 1e6, "0 or more"}, out.outer_scale_m));
  const std::string profile =
      problems.taken(node.choice("profile", "moffat", {"moffat", "gauss"}), std::string());
  out.profile = profile == "gauss" ? ImageProfile::Gauss : ImageProfile::Moffat;
  return problems.told();
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
  Problems problems;
  const std::string model =
      problems.taken(node.choice("model", "osborn2015", {"osborn2015", "none"}), std::string());
  double c_y = 1.5;
  problems.went(read_number(
      node, "c_y", {0, 10, "0 to 10 (sites have 1.3 to 1.67, nights twice as much)"}, c_y));
  if (model == "none")
    out.scintillation_c_y.reset();
  else
    out.scintillation_c_y = c_y;
  out.has_slewing_factor = node.boolean("slew", false);
  return problems.told();
}

/// A sky of one brightness, which has no other parts.
Result<void> read_even_sky(const Node &node, SkyOptions &out) {
  const SkyOptions usual; // which earlier locks spell out, whatever it says to a sky
  Problems problems;
  for (const auto &[name, is_unusual] :
       {std::pair{"dark_mag", node.has("dark_mag")},
        {"twilight", out.has_twilight != usual.has_twilight},
        {"moon", out.has_moon != usual.has_moon},
        {"dilution",
         out.dilution_sun != usual.dilution_sun || out.dilution_moon != usual.dilution_moon}})
    if (is_unusual)
      problems.add({ErrorCode::BadInput,
                    fmt::format("{} beside mag: a sky of one brightness has no other parts; leave "
                                "one of them out",
                                name),
                    node.where(name)});
  out.mag = node.number("mag", 0);
  const auto &[bright, dark] = sky_mag_range;
  if (!(*out.mag >= bright && *out.mag <= dark))
    problems.add({ErrorCode::BadInput,
                  fmt::format("mag = {}: {} to {} mag a square second of arc was expected; the "
                              "darkest skies have 22, twilight 10",
                              *out.mag, bright, dark),
                  node.where("mag")});
  return problems.told();
}

Result<void> read_dark_sky(const Node &sky, SkyOptions &out) {
  UMOV_ASSIGN(dark, sky.child("dark_mag"));
  const auto &[bright, darkest] = sky_mag_range;
  const Bounds bounds{bright, darkest, "-5 to 40 mag a square second of arc"};
  Problems problems;
  for (const char *letter : {"U", "B", "V", "R", "I"})
    if (double mag = 0; dark.has(letter) && problems.went(read_number(dark, letter, bounds, mag)))
      out.dark_mag[letter] = mag;
  return problems.told();
}

Result<void> read_sky(const Node &air, SkyOptions &out) {
  if (!air.has("sky"))
    return {};
  UMOV_ASSIGN(node, air.child("sky"));
  Problems problems;
  if (node.has("dark_mag"))
    problems.went(read_dark_sky(node, out));
  const auto word = [&](const char *name, const char *usual) {
    return problems.taken(node.choice(name, usual, {usual, "none"}), std::string(usual));
  };
  out.has_twilight = word("twilight", "patat2006") != "none";
  out.has_moon = word("moon", "ks1991") != "none";
  if (node.has("dilution")) {
    UMOV_ASSIGN(dilution, node.child("dilution"));
    problems.went(read_number(dilution, "sun", share, out.dilution_sun));
    problems.went(read_number(dilution, "moon", share, out.dilution_moon));
  }
  const bool has_fine_p = problems.went(read_number(node, "p", share, out.p));
  if (node.has("mag"))
    problems.went(read_even_sky(node, out));
  else if (has_fine_p && out.p != 0)
    problems.add({ErrorCode::BadInput,
                  "p without mag: the polarization of dark sky, twilight and moonlight is computed "
                  "(dilution scales it); give mag too, or leave p out",
                  node.where("p")});
  return problems.told();
}

/// A table in place of the numbers of clear air.
Result<void> read_measured_air(const Node &node, const std::filesystem::path &folder, SiteAir &out,
                               std::vector<InputFile> &files) {
  Problems problems;
  for (const char *name : {"aerosol", "ozone_du", "water_cm"})
    if (node.has(name))
      problems.add({ErrorCode::BadInput,
                    fmt::format("{} beside file: the table has all that the air takes; leave one "
                                "of them out",
                                name),
                    node.where(name)});
  out.file = tidy_path(folder / node.text("file", "")).string();
  const auto text = read_file(out.file);
  if (!problems.went(named_in(text, node.where("file"))))
    return problems.told();
  files.push_back({out.file, sha256_hex(*text)});
  auto table = read_extinction_text(*text, out.file);
  if (problems.went(table))
    out.air.measured = std::make_shared<const MeasuredExtinction>(std::move(*table));
  return problems.told();
}

Result<void> read_aerosol(const Node &node, Air &out) {
  UMOV_ASSIGN(aerosol, node.child("aerosol"));
  Problems problems;
  problems.went(
      read_number(aerosol, "tau_550", {0, 10, "an optical depth of 0 to 10"}, out.aerosol_550));
  problems.went(read_number(aerosol, "exponent", {-5, 5, "-5 to 5"}, out.aerosol_exponent));
  return problems.told();
}

Result<SiteAir> read_clear_air(const Node &node, const std::filesystem::path &folder,
                               std::vector<InputFile> &files) {
  SiteAir out;
  Problems problems;
  out.has_own_pressure = node.has("pressure_hpa");
  double pressure = out.air.pressure_hpa;
  // Under a tenth of it nobody lives: another unit. Without molecules it is 0.
  if (problems.went(read_number(
          node, "pressure_hpa",
          {0, 1200, "100 to 1200 hPa, or 0 for no molecules (1 hPa is 100 Pa)"}, pressure)) &&
      pressure > 0 && pressure < 100)
    problems.add(wrong_value(node, "pressure_hpa", pressure,
                             "100 to 1200 hPa, or 0 for no molecules (1 kPa is 10 hPa)"));
  out.air.pressure_hpa = pressure;
  if (node.has("file")) {
    problems.went(read_measured_air(node, folder, out, files));
  } else {
    if (node.has("aerosol"))
      problems.went(read_aerosol(node, out.air));
    problems.went(read_number(node, "ozone_du",
                              {0, 1000, "0 to 1000 Dobson units (the Earth has 100 to 600)"},
                              out.air.ozone_du));
    problems.went(read_number(node, "water_cm",
                              {0, 10, "0 to 10 cm of water (is it in mm? the tropics have 5)"},
                              out.air.water_cm));
  }
  UMOV_TRY(problems.told());
  return out;
}

/// The air of an observation. Where there is none, nothing flickers or scatters the light of Sun
/// and Moon; the dark sky, much of it starlight and zodiacal light, stays.
void put_air(const std::optional<SiteAir> &site, ScenarioObservation &out) {
  const Air none{.pressure_hpa = 0, .aerosol_550 = 0, .ozone_du = 0, .water_cm = 0};
  out.air = site ? *site : SiteAir{none, true, ""};
  if (site)
    return;
  out.scintillation_c_y.reset();
  out.sky.has_twilight = out.sky.has_moon = false;
}

Result<void> read_cloud(const Node &air, ScenarioObservation &out) {
  UMOV_ASSIGN(cloud, air.child("cloud"));
  Problems problems;
  problems.went(read_number(cloud, "sd_mag",
                            {0, 3,
                             "0 to 3 mag (0.05 of thin cloud; nothing is seen behind a cloud that "
                             "changes by more)"},
                            out.cloud_sd_mag));
  problems.went(read_number(cloud, "time_s", {1e-6, 1e300, "0.000001 or more"}, out.cloud_time_s));
  if (cloud.has("time_s") && !cloud.has("sd_mag"))
    problems.add({ErrorCode::BadInput,
                  fmt::format("time_s = {} without sd_mag, which says how much the cloud changes: "
                              "there is none. Add sd_mag, as 0.05, or leave cloud out",
                              out.cloud_time_s),
                  cloud.where("time_s")});
  return problems.told();
}

Result<void> read_atmosphere(const Node &top, ScenarioObservation &out) {
  out.seeing.outer_scale_m = 25;
  if (!top.has("atmosphere"))
    return {};
  UMOV_ASSIGN(air, top.child("atmosphere"));
  Problems problems;
  problems.went(read_seeing(air, out.seeing));
  problems.went(read_scintillation(air, out));
  problems.went(read_sky(air, out.sky));
  if (air.has("cloud"))
    problems.went(read_cloud(air, out));
  return problems.told();
}

Result<void> read_sequence(const Node &node, ScenarioObservation &out) {
  if (!node.has("sequence"))
    return {};
  for (const toml::node &item : *node.get("sequence")->as_array()) {
    if (!item.is_table())
      return no_table("sequence", item, "tables such as { analyser_deg = 45 }",
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
  if (const double dead = out.instrument.detector.dead_time_s; out.makes_frames && dead > 0)
    return fail(ErrorCode::BadInput,
                fmt::format("level = \"image\" with detector.dead_time_s = {:g}: what a counter's "
                            "pixels miss is not put back into frames; level = \"aperture\", or "
                            "dead_time_s = 0, was expected",
                            dead),
                node.where("level"));
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
  Problems problems;
  if (node.has("bands")) {
    const auto bands = node.strings("bands");
    if (problems.went(bands) && bands->empty())
      problems.add({ErrorCode::BadInput,
                    "bands = []: one or more were expected, as [\"Bessell.V\"]; without the key "
                    "those of [bands] are taken",
                    node.where("bands")});
    else if (bands)
      out.bands = *bands;
  }
  problems.went(read_number(node, "width_nm", {1e-6, 1e5, "a number above 0"}, out.width_nm));
  const bool has_time = problems.went(
      read_number(node, "exposure_s", {1e-9, 1e6, "1e-9 to 1000000 s"}, out.exposure_s));
  out.cadence_s = node.number("cadence_s", out.exposure_s);
  if (has_time && !(out.cadence_s >= out.exposure_s))
    problems.add({ErrorCode::BadInput,
                  fmt::format("cadence_s = {} is shorter than exposure_s = {}; exposures cannot "
                              "overlap",
                              out.cadence_s, out.exposure_s),
                  node.where("cadence_s")});
  problems.went(read_sequence(node, out));
  out.aperture_fwhm = node.number("aperture_fwhm", out.aperture_fwhm);
  if (const auto fits = check_aperture("aperture_fwhm =", out.aperture_fwhm); !fits)
    problems.add({fits.error().code, fits.error().message, node.where("aperture_fwhm")});
  problems.went(read_number(node, "clock_error_s",
                            {0, 600, "0 to 600 s (0.001 by GPS, 0.5 of a computer's clock)"},
                            out.clock_error_s));
  problems.went(read_frames(node, folder, out));
  return problems.told();
}

} // namespace

} // namespace umov::scenario

namespace umov {

Result<void> check_aperture(const std::string &name, double fwhm) {
  const ObservingConditions usual;
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

Result<void> check_air_reaches(const std::vector<Band> &bands, const SiteAir &air,
                               const Where &where, double width_nm) {
  for (const Band &band : bands) {
    const double nm = band.wavelength.nm(), half = band.curve ? 0 : width_nm / 2;
    if (!air.air.measured && !(nm - half >= air_from_nm && nm + half <= air_to_nm))
      return fail(
          ErrorCode::BadInput,
          fmt::format("band \"{}\" is at {:g} nm{}: what air takes is known from {:g} to {:g} "
                      "nm. Take another band, or [observer] atmosphere = \"none\"",
                      band.name, nm, half > 0 ? fmt::format(", {:g} nm wide", width_nm) : "",
                      air_from_nm, air_to_nm),
          where);
    if (!air.air.measured)
      continue;
    const double first = band.curve ? band.curve->wavelength_nm.front() : nm - half;
    const double last = band.curve ? band.curve->wavelength_nm.back() : nm + half;
    const std::vector<double> &known = air.air.measured->nm;
    if (first < known.front() || last > known.back())
      return fail(ErrorCode::BadInput,
                  fmt::format("band \"{}\" reaches from {:g} to {:g} nm, and the extinction of {} "
                              "from {:g} to {:g} nm: a table over all of the band was expected",
                              band.name, first, last, air.file, known.front(), known.back()),
                  where);
  }
  return {};
}

} // namespace umov

namespace umov::scenario {

Result<std::optional<SiteAir>> read_site_air(const Node &top, const std::filesystem::path &folder,
                                             std::vector<InputFile> &files) {
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
        return read_clear_air(node, folder, files);
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
    return read_clear_air(node, folder, files);
  }
  // What is observed is seen through air unless someone says otherwise.
  return top.has("observation") ? SiteAir() : std::optional<SiteAir>();
}

namespace {

/// Keys of the air, one a line or in a row.
std::string air_keys(const SiteAir &o, const char *between) {
  std::string out;
  const auto put = [&](const char *key, const std::string &value) {
    out += fmt::format("{}{} = {}", out.empty() ? "" : between, key, value);
  };
  if (o.has_own_pressure)
    put("pressure_hpa", shortest(o.air.pressure_hpa));
  if (o.air.measured) {
    std::error_code code;
    const auto full = std::filesystem::absolute(o.file, code);
    put("file", quoted(tidy_path(code ? std::filesystem::path(o.file) : full).string()));
    return out;
  }
  put("aerosol", fmt::format("{{ tau_550 = {}, exponent = {} }}", shortest(o.air.aerosol_550),
                             shortest(o.air.aerosol_exponent)));
  put("ozone_du", shortest(o.air.ozone_du));
  put("water_cm", shortest(o.air.water_cm));
  return out;
}

} // namespace

std::string clear_air_toml(const SiteAir &o) {
  return fmt::format("atmosphere = {{ {} }}\n", air_keys(o, ", "));
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
  Problems problems;
  problems.went(read_instrument_tables(top, out.instrument));
  if (top.has("instrument_name") && top.has("instrument"))
    problems.add({ErrorCode::BadInput,
                  "instrument_name beside instrument, which has a name; leave one out",
                  top.where("instrument_name")});
  out.instrument.name = top.text("instrument_name", out.instrument.name);
  problems.went(read_atmosphere(top, out));
  put_air(air, out);
  if (top.has("observation")) {
    UMOV_ASSIGN(node, top.child("observation"));
    problems.went(read_exposures(node, folder, out));
  }
  UMOV_TRY(problems.told());
  if (!top.has("observation"))
    return std::optional<ScenarioObservation>();
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
  std::string out = "\n[atmosphere]\n" + air_keys(o.air, "\n") + "\n";
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
