#include "io/scenario/instrument.h"
#include "io/scenario/parts.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov {

namespace scenario {

std::string quoted(const std::string &text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + "\"";
}

} // namespace scenario

namespace {

using scenario::axis_toml;
using scenario::quoted;

std::string list(const std::vector<std::string> &items) {
  std::string out;
  for (const std::string &item : items)
    out += (out.empty() ? "" : ", ") + quoted(item);
  return "[" + out + "]";
}

std::string absolute_path(const std::filesystem::path &path) {
  std::error_code code;
  const auto full = std::filesystem::absolute(path, code);
  return quoted(tidy_path(code ? path : full).string());
}

std::string observer_and_time(const Scenario &s) {
  std::string out;
  if (s.observer)
    out += fmt::format("\n[observer]\nname = {}\nlat_deg = {}\nlon_deg = {}\nalt_m = {}\n",
                       quoted(s.observer->name), degrees_text(s.observer->latitude),
                       degrees_text(s.observer->longitude), shortest(s.observer->altitude_m));
  if (s.observer && !s.air)
    out += "atmosphere = \"none\"\n";
  else if (s.observer && !s.observation) // else [atmosphere] below says it
    out += scenario::clear_air_toml(*s.air);
  if (s.time) {
    const EpochFilter &only = s.time->only;
    std::vector<std::string> own;
    for (const Epoch<Utc> time : s.time->epochs)
      own.push_back(to_iso_exact(time));
    out += own.empty() ? fmt::format("\n[time]\nstart = {}\nstop = {}\nstep_s = {}\n",
                                     to_iso_exact(s.time->start), to_iso_exact(s.time->stop),
                                     shortest(s.time->step_s))
                       : fmt::format("\n[time]\nepochs = [{}]\n", fmt::join(own, ", "));
    out +=
        fmt::format("only = {{ alt_min_deg = {}, sun_alt_max_deg = {}, sunlit = {} }}\n",
                    degrees_text(only.altitude_min),
                    degrees_text(only.sun_altitude_max.value_or(Angle::degrees(90))), only.sunlit);
  }
  return out;
}

std::string orbit_toml(const ScenarioOrbit &orbit) {
  if (!orbit.state)
    return fmt::format("orbit = {{ file = {}, norad = {} }}\n", absolute_path(orbit.file),
                       orbit.norad);
  const StateVector &s = *orbit.state;
  const auto three = [](const std::array<double, 3> &v) { return axis_toml({v[0], v[1], v[2]}); };
  constexpr std::array frames{"gcrs", "eme2000", "teme", "itrs"};
  return fmt::format("orbit = {{ epoch = {}, frame = \"{}\", position_km = {}, velocity_km_s = {}, "
                     "norad = {} }}\n",
                     to_iso_exact(s.state.time), frames[static_cast<std::size_t>(s.frame)],
                     three(s.state.position_km), three(s.state.velocity_km_s), orbit.norad);
}

/// A material by its name, or by the file that it is in.
std::string material_name(const std::string &name, const Scenario &s) {
  return scenario::is_material_file(name, s) ? absolute_path(scenario::material_file(name, s))
                                             : quoted(name);
}

std::string object(const ScenarioObject &o, const Scenario &s) {
  std::string out = fmt::format("\n[[object]]\nname = {}\n", quoted(o.name));
  if (o.orbit)
    out += orbit_toml(*o.orbit);
  // Absent where the format states them: what they are is only known when the file is read.
  std::string frame;
  for (const auto &[key, value] : {std::pair{"unit", o.mesh.unit}, {"up", o.mesh.up}})
    if (!value.empty())
      frame += fmt::format("{} = {}, ", key, quoted(value));
  if (!o.mesh.file.empty())
    out += fmt::format("mesh = {{ file = {}, {}normals = \"{}\", crease_deg = {} }}\n",
                       absolute_path(o.mesh.file), frame,
                       o.mesh.normals == NormalMode::Smooth ? "smooth" : "flat",
                       shortest(o.mesh.crease_deg));
  out += "attitude = " + scenario::attitude_toml(o.attitude) + "\n\n[object.materials]\n";
  for (const auto &[name, sides] : o.materials)
    out += fmt::format("{} = {{ front = {}, back = {} }}\n", quoted(name),
                       material_name(sides.front, s), material_name(sides.back, s));
  for (const MovingJoint &part : o.parts)
    out += "\n[[object.part]]\n" + scenario::part_toml(part);
  return out;
}

} // namespace

std::string toml_text(const std::string &text) { return quoted(text); }

std::string locked_scenario(const Scenario &s) {
  std::string out =
      "# Every default filled in; running this file repeats the run, of all rows: a range or a\n"
      "# shard of it stands in manifest.json.\n";
  out += fmt::format("umov = 1\ntitle = {}\nseed = {}\n", quoted(s.title), s.seed);
  if (s.observation)
    if (const auto names = instrument_names();
        std::ranges::find(names, s.observation->instrument.name) != names.end())
      out += fmt::format("instrument = {}\n", quoted(s.observation->instrument.name));
    else if (!s.observation->instrument.name.empty())
      out += fmt::format("instrument_name = {}\n", quoted(s.observation->instrument.name));
  out += observer_and_time(s);
  if (!s.earth_orientation.empty())
    out += fmt::format("\n[earth]\neop = {}\n", absolute_path(s.earth_orientation));
  for (const ScenarioObject &one : s.objects)
    out += object(one, s);
  out += fmt::format("\n[materials]\nvary = {}\n", s.varies_haze ? "[\"haze\"]" : "[]");
  out += scenario::bands_toml(s);
  out += fmt::format(
      "\n[render]\nmethod = \"{}\"\nbounces = {}\nbetween = \"{}\"\nsun = \"{}\"\naccuracy = {}\n"
      "accuracy_floor = {}\n",
      name_of(s.light.method), s.light.bounces, name_of(s.light.between),
      s.has_solar_disk ? "disk" : "point", shortest(s.light.accuracy),
      shortest(s.light.accuracy_floor.value_or(default_accuracy_floor(s.light.method))));
  out += fmt::format("moonlight = {}\nshadow_edge = \"{}\"\n", s.has_moonlight,
                     s.has_refracted_shadow ? "refracted" : "geometric");
  if (s.earthshine)
    out += fmt::format("earthshine = {{ albedo = {}, patches = {}, accuracy = {} }}\n",
                       shortest(s.earthshine->albedo), s.earthshine->patches,
                       shortest(s.earthshine->accuracy));
  out += s.observation ? scenario::observation_toml(*s.observation, s.air.has_value())
                       : std::string("\n[detector]\nmodel = \"ideal\"\n");
  out += fmt::format("\n[output]\ndir = {}\nformats = {}\ncsv_digits = \"{}\"\n"
                     "keep_inputs = {}\npol_frame = \"{}\"\n",
                     quoted(s.output_dir.string()), list(s.formats),
                     s.has_all_csv_digits ? "all" : "error", s.keeps_inputs, name_of(s.frame));
  for (const auto &[name, material] : s.own_materials)
    out += "\n" + scenario::material_toml(material);
  return out;
}

} // namespace umov
