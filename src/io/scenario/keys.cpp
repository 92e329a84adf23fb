#include "io/scenario/keys.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/io/scenario.h>
#include <umov/surface/distribution.h>

namespace umov::scenario {

namespace {

/// The numbers that the distributions take come from the distributions.
std::vector<Key> with_distributions(std::vector<Key> keys) {
  for (const DistributionModel *model : distribution_models())
    for (const DistributionParameter &one : model->parameters) {
      const auto is_there = [&](const Key &key) {
        return std::string_view(key.table) == "material.distribution" &&
               std::string_view(key.name) == one.name;
      };
      if (std::none_of(keys.begin(), keys.end(), is_there))
        keys.push_back({"material.distribution", one.name, Kind::Number, "", one.text});
    }
  return keys;
}

} // namespace

const std::vector<Key> &keys() {
  using enum Kind;
  const LightOptions light; // its defaults are told once, where they stand
  static const Key own[] = {
      {"", "umov", Integer, "", "version of the scenario's form: 1"},
      {"", "title", String, "\"\"", "heading of the report"},
      {"", "seed", Integer, "0", "of every random stream"},
      {"", "observer", Table, "", "the site; absent in a scene"},
      {"", "time", Table, "", "the span; absent in a scene"},
      {"", "earth", Table, "", "how the Earth turns"},
      {"", "object", List, "", "[[object]]: one object"},
      {"", "bands", Table, "", "wavelengths and filters, and the zero of magnitudes"},
      {"", "render", Table, "", "how the light is computed"},
      {"", "detector", Table, "", "what measures it"},
      {"", "output", Table, "", "what is written"},
      {"", "material", Table, "", "materials written in place: [material.NAME]"},
      {"observer", "name", String, "\"\"", "name of the site; a known one needs no coordinates"},
      {"observer", "lat_deg", Number, "", "geodetic latitude [deg], north positive"},
      {"observer", "lon_deg", Number, "", "longitude [deg], east positive"},
      {"observer", "alt_m", Number, "", "height above the WGS 84 ellipsoid [m]"},
      {"observer", "atmosphere", String, "\"none\"", "only \"none\" is built so far"},
      {"time", "start", Time, "", "first epoch, with Z or an offset"},
      {"time", "stop", Time, "", "last epoch, included"},
      {"time", "step_s", Number, "1.0", "step [s]"},
      {"time", "only", Table, "", "which epochs are kept"},
      {"time.only", "alt_min_deg", Number, "0.0", "lowest altitude of the object [deg]"},
      {"time.only", "sun_alt_max_deg", Number, "90.0", "highest altitude of the Sun [deg]"},
      {"time.only", "sunlit", Boolean, "true", "only where some of the Sun is seen"},
      {"earth", "eop", String, "",
       "table of Earth orientation, IERS finals2000A, in place of the compiled-in one"},
      {"object", "name", String, "\"\"", "name of the object"},
      {"object", "orbit", Table, "", "elements; absent in a scene"},
      {"object", "mesh", Table, "", "shape"},
      {"object", "attitude", Table, "{ mode = \"nadir\" }", "which way it points"},
      {"object", "materials", Table, "", "mesh material -> material, and \"default\""},
      {"object", "part", List, "", "[[object.part]]: mesh groups or nodes that turn"},
      {"object.orbit", "file", String, "", "TLE, 3LE, OMM, OEM or OPM file"},
      {"object.orbit", "epoch", Time, "", "of a state written in place of a file"},
      {"object.orbit", "frame", String, "\"gcrs\"", "of the state: gcrs, eme2000, teme or itrs"},
      {"object.orbit", "position_km", List, "", "[x, y, z] [km]"},
      {"object.orbit", "velocity_km_s", List, "", "[x, y, z] [km/s]"},
      {"object.orbit", "norad", Integer, "0", "catalogue number, where the file holds several"},
      {"object.mesh", "file", String, "", "OBJ, glTF, GLB, STL, PLY, COLLADA, 3DS or OFF file"},
      {"object.mesh", "unit", String, "",
       "m, cm, mm, km, in or ft; glTF is in metres where absent"},
      {"object.mesh", "up", String, "",
       "axis of the file that becomes body +Z, such as \"+Y\" (glTF: that, where absent)"},
      {"object.mesh", "normals", String, "\"flat\"", "flat or smooth"},
      {"object.mesh", "crease_deg", Number, "35.0", "edges sharper than this stay sharp [deg]"},
      {"object.attitude", "mode", String, "", "nadir, inertial, spin, tumble, aem or pieces"},
      {"object.attitude", "point", Any, "\"+Z\"", "body axis that points exactly"},
      {"object.attitude", "at", Any, "\"nadir\"",
       "nadir, zenith, velocity, orbit_normal, sun, observer or { ra_deg, dec_deg }"},
      {"object.attitude", "then", Any, "\"+X\"", "second body axis, as near as may be"},
      {"object.attitude", "toward", Any, "\"velocity\"", "where the second axis goes"},
      {"object.attitude", "quaternion", List, "", "body_from_gcrs, [w, x, y, z]"},
      {"object.attitude", "axis", Any, "\"+Z\"", "spin: body axis"},
      {"object.attitude", "rate_deg_s", Any, "",
       "spin: rate [deg/s], right-handed; tumble: [x, y, z] in body axes"},
      {"object.attitude", "period_s", Number, "", "spin: period [s] instead of the rate"},
      {"object.attitude", "epoch", Time, "",
       "spin, tumble: when it has the attitude of `start`; default: time.start"},
      {"object.attitude", "start", Table, "{ mode = \"nadir\" }",
       "spin, tumble: attitude at `epoch`"},
      {"object.attitude", "inertia", Any, "",
       "tumble: \"shell\" or \"solid\" of the mesh, [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]"},
      {"object.attitude", "file", String, "", "aem: CCSDS attitude message"},
      {"object.attitude", "pieces", List, "", "pieces: laws, each with the time `from`"},
      {"object.attitude", "from", Time, "", "of a piece: when it begins"},
      {"object.attitude", "roll_deg", Number, "0.0", "offset about body +X, after pitch [deg]"},
      {"object.attitude", "pitch_deg", Number, "0.0", "offset about body +Y, after yaw [deg]"},
      {"object.attitude", "yaw_deg", Number, "0.0", "offset about body +Z [deg]"},
      {"object.attitude", "libration", Table, "", "small unsteadiness on top"},
      {"object.attitude.libration", "rms_deg", Number, "", "mean square per body axis [deg]"},
      {"object.attitude.libration", "period_s", Number, "60.0", "typical period [s]"},
      {"object.part", "name", String, "\"\"", "for messages and `on`"},
      {"object.part", "groups", List, "[]", "mesh groups that turn together"},
      {"object.part", "nodes", List, "[]",
       "instead or as well: nodes of a glTF tree, with all below"},
      {"object.part", "axis", Any, "\"+Y\"", "body axis that they turn about"},
      {"object.part", "pivot_m", List, "[0, 0, 0]", "a point of the axis [m]"},
      {"object.part", "face", Any, "\"+Z\"", "what is turned towards a target, as in the mesh"},
      {"object.part", "toward", Any, "\"sun\"",
       "nadir, zenith, velocity, orbit_normal, sun, observer, { ra_deg, dec_deg } or a place"},
      {"object.part", "angle_deg", Any, "", "instead: an angle, or a list with `time`"},
      {"object.part", "time", List, "", "times of the angles"},
      {"object.part", "on", String, "\"\"", "the part that carries this one"},
      {"direction", "ra_deg", Number, "", "right ascension, GCRS [deg]"},
      {"direction", "lat_deg", Number, "", "a place on the Earth: latitude [deg]"},
      {"direction", "lon_deg", Number, "", "longitude [deg], east positive"},
      {"direction", "alt_m", Number, "0.0", "height above the ellipsoid [m]"},
      {"direction", "dec_deg", Number, "", "declination, GCRS [deg]"},
      {"sides", "front", String, "", "material of the side that the winding faces"},
      {"sides", "back", String, "", "material of the other side"},
      {"bands", "set", Any, "\"paper_rgb\"",
       "a name or a list of them: \"nm:NUMBER\", \"paper_rgb\", curves (\"Bessell.V\", "
       "\"gaia\"; see umov bands list), \"file:x.vot\" or { file, unit, detector }"},
      {"bands", "mag_system", String, "\"AB\"",
       "AB, ST or Vega (the latter where a band has a zero point)"},
      {"bands.set", "file", String, "",
       "curve of a band: VOTable of the SVO Filter Profile Service, or columns wavelength, "
       "response"},
      {"bands.set", "unit", String, "",
       "of its wavelengths: nm, um or Angstrom; absent: the file says"},
      {"bands.set", "detector", String, "",
       "photon or energy: what the curve multiplies; absent: the file says"},
      {"render", "bounces", Integer, fmt::format("{}", light.bounces),
       "surfaces that the light may touch, 1 to 64; 1: direct light"},
      {"render", "sun", String, "\"disk\"", "disk (695,700 km at its distance) or point"},
      {"render", "method", String, fmt::format("\"{}\"", name_of(light.method)),
       "how hiding is decided: rays, masks, or auto: masks mended by rays to the accuracy asked"},
      {"render", "accuracy", Number, shortest(light.accuracy),
       "relative 95 % half-width asked of I"},
      {"render", "accuracy_floor", Number, shortest(default_accuracy_floor(light.method)),
       "in parts of the object's typical light: below it I need not be known any better than at "
       "it; 0 with rays and masks"},
      {"render", "earthshine", Table, "",
       "light of the Earth, in columns of its own; absent: none"},
      {"render", "moonlight", Boolean, "false", "light of the Moon, in columns of its own"},
      {"render", "shadow_edge", String, "\"geometric\"",
       "geometric, or refracted: sunlight bent, dimmed and reddened by the Earth's air"},
      {"render.earthshine", "albedo", Number, "0.3", "of a Lambert Earth"},
      {"render.earthshine", "patches", Integer, "200",
       "sources that the Earth's disk is cut into to begin with; 100 times as many at most"},
      {"render.earthshine", "accuracy", Number, "0.02",
       "relative 95 % half-width asked of earth_I"},
      {"detector", "model", String, "\"ideal\"", "only \"ideal\" is built so far"},
      {"output", "dir", String, "\"out\"", "folder, relative to the working folder"},
      {"output", "formats", List, "[\"ecsv\", \"html\"]", "ecsv, csv, fits, html"},
      {"output", "pol_frame", String, "\"equatorial\"", "equatorial, altaz or scattering"},
      {"material", "index", Any, "",
       "name, file (.yml .csv .txt .dat), { file }, { n, k } or { wavelength_nm, n, k }"},
      {"material", "layers", List, "", "films on the substrate, first on top"},
      {"material", "distribution", Table, "", "of microfacet normals"},
      {"material", "direction", Any, "",
       "direction field of ashikhmin_shirley: a body axis such as \"+X\", or \"uv\""},
      {"material", "shadowing", String, "\"ashikhmin\"",
       "ashikhmin, smith, smith_directional or separable"},
      {"material", "body", Table, "", "light scattered below the surface; absent: none"},
      {"material", "haze", Table, "",
       "floor under all lobes: part of the area that reflects like a Lambert surface; absent: "
       "none"},
      {"material", "interreflection", String, "\"none\"",
       "between microfacets: none, unpolarized or single_bounce_q"},
      {"material", "apparent_roughness", Table, "",
       "absent: the same roughness at every wavelength"},
      {"material", "table", String, "", "measured BRDF (CSV), instead of all of the above"},
      {"material", "accept", Boolean, "false", "take a measured table that is not physical"},
      {"material", "description", String, "", "what it is"},
      {"material", "source", String, "", "where its numbers come from"},
      {"material", "assumed", String, "", "what is not known and was assumed"},
      {"material.index", "file", String, "",
       "page of refractiveindex.info (YAML), or columns of wavelength, n and k"},
      {"material.index", "n", Any, "", "real part, a number or a list"},
      {"material.index", "k", Any, "0.0", "imaginary part (n + ik, k >= 0 absorbs)"},
      {"material.index", "wavelength_nm", List, "", "wavelengths of the lists [nm]"},
      {"material.layers", "index", Any, "", "as the material's"},
      {"material.layers", "thickness_nm", Number, "", "[nm]"},
      {"material.layers", "coherent", Boolean, "true", "false: too thick to interfere"},
      {"material.apparent_roughness", "hurst", Number, "",
       "Hurst exponent of the surface, 0.3 to 1: smoother at longer wavelengths"},
      {"material.apparent_roughness", "reference_nm", Number, "550.0",
       "wavelength at which the distribution holds [nm]"},
      {"material.apparent_roughness", "rms_height_nm", Number, "",
       "polished surface: part of the light sees a mirror [nm]"},
      {"material.body", "reflectance", Any, "",
       "R_sub: a number or { wavelength_nm, reflectance }"},
      {"material.body", "polarized", Boolean, "false", "p-polarized by the way out (Baek 2018)"},
      {"material.body.reflectance", "wavelength_nm", List, "", "[nm]"},
      {"material.body.reflectance", "reflectance", List, "", "0 to 1"},
      {"material.haze", "share", Number, "",
       "of the area, reflecting as much as the interface does on average"},
      {"material.haze", "albedo", Number, "", "of all light, whatever the interface reflects"},
      {"material.haze", "polarized", Boolean, "false",
       "beside share: with the Q/I of one reflection"},
      {"material.haze", "range", List, "", "smallest and largest value that it may have"},
      {"material.distribution", "model", String, "", "see umov material list --models"},
      {"material.distribution", "file", String, "",
       "model table: CSV with columns theta_deg, density"},
  };
  static const std::vector<Key> all = with_distributions({std::begin(own), std::end(own)});
  return all;
}

std::vector<std::string> names_in(std::string_view table) {
  std::vector<std::string> out;
  for (const Key &key : keys())
    if (table == key.table)
      out.emplace_back(key.name);
  return out;
}

const Key *find_key(std::string_view table, std::string_view name) {
  for (const Key &key : keys())
    if (table == key.table && name == key.name)
      return &key;
  return nullptr;
}

const char *to_text(Kind kind) {
  switch (kind) {
  case Kind::String:
    return "a string";
  case Kind::Number:
    return "a number";
  case Kind::Integer:
    return "a whole number";
  case Kind::Boolean:
    return "true or false";
  case Kind::Time:
    return "a time such as 2018-01-21T04:00:00Z";
  case Kind::List:
    return "a list";
  case Kind::Table:
    return "a table";
  case Kind::Any:
    break;
  }
  return "a value";
}

namespace {

nlohmann::ordered_json schema_of(std::string_view table) {
  nlohmann::ordered_json out{{"type", "object"}, {"additionalProperties", false}};
  for (const Key &key : keys()) {
    if (table != key.table)
      continue;
    nlohmann::ordered_json entry{{"description", key.text}};
    const std::string below = std::string(table) + (table.empty() ? "" : ".") + key.name;
    switch (key.kind) {
    case Kind::Number:
      entry["type"] = "number";
      break;
    case Kind::Integer:
      entry["type"] = "integer";
      break;
    case Kind::Boolean:
      entry["type"] = "boolean";
      break;
    case Kind::Time:
      entry["type"] = "string";
      entry["format"] = "date-time";
      break;
    case Kind::String:
      entry["type"] = "string";
      break;
    case Kind::List:
      entry["type"] = "array";
      if (below == "object" || below == "material.layers" || below == "object.part")
        entry["items"] = schema_of(below);
      break;
    case Kind::Table:
      if (below == "material")
        entry["additionalProperties"] = schema_of("material");
      else if (!names_in(below).empty())
        entry.update(schema_of(below));
      else
        entry["type"] = "object";
      break;
    case Kind::Any:
      break;
    }
    if (!key.fallback.empty() && key.fallback[0] != '{')
      entry["default"] = nlohmann::ordered_json::parse(key.fallback);
    out["properties"][key.name] = std::move(entry);
  }
  return out;
}

} // namespace
} // namespace umov::scenario

namespace umov {

std::string scenario_schema_json() {
  nlohmann::ordered_json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                             {"title", "umov scenario"}};
  out.update(scenario::schema_of(""));
  return out.dump(2) + "\n";
}

} // namespace umov
