#include "io/scenario/instrument.h"
#include "io/scenario/parse_toml.h"
#include "io/scenario/parts.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/sites.h>

namespace umov {
namespace {

using scenario::Node, scenario::Problems;
namespace fs = std::filesystem;

/// Puts one "dotted.key=value" into the document; "object.x" means its first object, "object.1.x"
/// its second.
Result<void> override_key(toml::table &document, const std::string &text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return fail(ErrorCode::Usage, "--set " + text + ": KEY=VALUE was expected");
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  const std::string origin = "--set " + key;
  UMOV_TRY(scenario::check_key_depth(text, origin));
  auto parsed = scenario::parse_toml("x = " + value, origin);
  if (!parsed) // a bare word
    parsed = scenario::parse_toml("x = " + scenario::quoted(value), origin);
  if (!parsed)
    return fail(parsed.error().code, parsed.error().message, {origin});
  toml::table *at = &document;
  std::size_t begin = 0;
  const auto next_name = [&]() -> std::optional<std::string> {
    const std::size_t dot = key.find('.', begin);
    if (dot == std::string::npos)
      return std::nullopt;
    return key.substr(begin, dot - begin);
  };
  while (const auto name = next_name()) {
    begin += name->size() + 1;
    if (!at->contains(*name))
      at->insert(toml::key(*name, toml::source_region(parsed->source())), toml::table{});
    toml::node *next = at->get(*name);
    if (toml::array *list = next->as_array(); list != nullptr && !list->empty()) {
      std::size_t index = 0;
      if (const auto number = next_name();
          number && !number->empty() && number->size() < 6 &&
          number->find_first_not_of("0123456789") == std::string::npos) {
        index = static_cast<std::size_t>(std::stoul(*number));
        begin += number->size() + 1;
      }
      if (index >= list->size())
        return fail(ErrorCode::BadInput, fmt::format("{}: {} has {} entries, counted from 0",
                                                     origin, *name, list->size()));
      next = list->get(index);
    }
    at = next->as_table();
    if (at == nullptr)
      return fail(ErrorCode::BadInput, origin + ": " + *name + " is not a table");
  }
  at->erase(key.substr(begin)); // an assignment would keep the place of the old key
  at->insert(toml::key(key.substr(begin), toml::source_region(parsed->source())),
             *parsed->get("x"));
  return {};
}

Result<void> read_observer(const Node &top, Scenario &out) {
  if (!top.has("observer"))
    return {};
  UMOV_ASSIGN(node, top.child("observer"));
  if (node.has("name") && !node.has("lat_deg") && !node.has("lon_deg") && !node.has("alt_m")) {
    auto known = site_from(node.text("name", ""));
    if (!known)
      return fail(ErrorCode::BadInput, known.error().message, node.where("name"));
    known->name = node.text("name", "");
    out.observer = *known;
    return {};
  }
  Problems problems;
  for (const char *name : {"lat_deg", "lon_deg", "alt_m"})
    problems.went(node.require(name));
  UMOV_TRY(problems.told());
  auto site = make_site(node.text("name", ""), node.number("lat_deg", 0), node.number("lon_deg", 0),
                        node.number("alt_m", 0));
  if (!site) // the message begins with the name of the key
    return fail(ErrorCode::BadInput, site.error().message,
                node.where(site.error().message.substr(0, site.error().message.find(' ')).c_str()));
  out.observer = *site;
  return {};
}

Result<void> read_earth(const Node &top, const fs::path &folder, Scenario &out) {
  if (!top.has("earth"))
    return {};
  UMOV_ASSIGN(node, top.child("earth"));
  if (node.has("eop")) {
    out.earth_orientation = folder / node.text("eop", "");
    out.places["earth.eop"] = node.where("eop");
  }
  return {};
}

Result<void> read_time(const Node &top, Scenario &out) {
  if (!top.has("time"))
    return {};
  UMOV_ASSIGN(node, top.child("time"));
  ScenarioTime time;
  UMOV_ASSIGN(start, node.time("start"));
  UMOV_ASSIGN(stop, node.time("stop"));
  time.start = start;
  time.stop = stop;
  time.step_s = node.number("step_s", 1);
  if (!(time.step_s > 0))
    return fail(ErrorCode::BadInput,
                fmt::format("step_s = {}; a positive number was expected", time.step_s),
                node.where("step_s"));
  if (auto count = epoch_count({start, stop, time.step_s}); !count)
    return fail(ErrorCode::BadInput, count.error().message, node.where("stop"));
  if (node.has("only")) {
    UMOV_ASSIGN(only, node.child("only"));
    const double lowest = only.number("alt_min_deg", 0), sun = only.number("sun_alt_max_deg", 90);
    for (const auto &[name, value] : {std::pair{"alt_min_deg", lowest}, {"sun_alt_max_deg", sun}})
      if (std::abs(value) > 90)
        return fail(ErrorCode::BadInput,
                    fmt::format("{} = {}; -90 to 90 was expected", name, value), only.where(name));
    time.only.altitude_min = Angle::degrees(lowest);
    if (only.has("sun_alt_max_deg"))
      time.only.sun_altitude_max = Angle::degrees(sun);
    time.only.sunlit = only.boolean("sunlit", true);
  }
  out.time = time;
  return {};
}

/// Places of the tables of an observation and of their keys: some of what is wrong with it is found
/// where it is carried out.
void note_places(const Node &top, Scenario &out) {
  for (const char *name : {"atmosphere", "bands", "detector", "observation", "polarimeter", "time"})
    if (const auto *table = top.table().get_as<toml::table>(name)) {
      out.places[name] = top.where(name);
      for (const auto &[key, value] : *table)
        out.places[fmt::format("{}.{}", name, key.str())] =
            scenario::place_of(key, value, out.file);
    }
}

/// How the places of an object's keys are called.
std::string key_of(const Scenario &out, const std::string &key) {
  return fmt::format("object.{}.{}", out.objects.size() - 1, key);
}

Result<void> read_materials(const Node &object, Scenario &out) {
  if (!object.has("materials"))
    return {};
  const toml::table *table = object.table().get_as<toml::table>("materials");
  const Node node(*table, "", "object.materials", out.file);
  Problems problems;
  for (const auto &[key, value] : *table) {
    const std::string name(key.str());
    MaterialNames sides;
    if (value.is_string()) {
      sides.front = sides.back = value.value_or(std::string());
    } else if (value.is_table()) {
      UMOV_ASSIGN(below, node.child(name.c_str(), "sides"));
      UMOV_TRY(below.require("front"));
      UMOV_TRY(below.require("back"));
      sides = {below.text("front", ""), below.text("back", "")};
    } else {
      return fail(ErrorCode::BadInput,
                  name + ": the name of a material or { front = ..., back = ... } was expected",
                  scenario::place_of(key, value, out.file));
    }
    const Where where = scenario::place_of(key, value, out.file);
    for (const std::string &side : {sides.front, sides.back})
      if (auto found = scenario::find_material(side, out); !found)
        problems.add({found.error().code, found.error().text(), where});
    out.places[key_of(out, "materials." + name)] = scenario::place_of(key.source(), out.file);
    out.objects.back().materials.emplace(name, sides);
  }
  return problems.told();
}

Result<void> read_mesh(const Node &object, const fs::path &folder, Scenario &out) {
  UMOV_ASSIGN(node, object.child("mesh"));
  UMOV_TRY(node.require("file"));
  UMOV_ASSIGN(normals, node.choice("normals", "flat", {"flat", "smooth"}));
  if (node.text("file", "").empty())
    return fail(ErrorCode::BadInput, "file = \"\"; the name of a mesh was expected",
                node.where("file"));
  ScenarioMesh &mesh = out.objects.back().mesh;
  mesh.file = tidy_path(folder / node.text("file", ""));
  mesh.unit = node.text("unit", "");
  mesh.up = node.text("up", "");
  mesh.normals = normals == "smooth" ? NormalMode::Smooth : NormalMode::Flat;
  mesh.crease_deg = node.number("crease_deg", 35);
  if (!(mesh.crease_deg >= 0 && mesh.crease_deg <= 180))
    return fail(ErrorCode::BadInput,
                fmt::format("crease_deg = {}; 0 to 180 was expected", mesh.crease_deg),
                node.where("crease_deg"));
  out.places[key_of(out, "mesh")] = node.where("file");
  return {};
}

Result<std::array<double, 3>> three_numbers(const Node &node, const char *name) {
  UMOV_ASSIGN(v, node.numbers(name));
  if (v.size() != 3)
    return fail(ErrorCode::BadInput,
                fmt::format("{} has {} numbers; 3 were expected, [x, y, z]", name, v.size()),
                node.where(name));
  return std::array<double, 3>{v[0], v[1], v[2]};
}

Result<StateVector> read_state(const Node &orbit) {
  StateVector out;
  UMOV_ASSIGN(frame, orbit.choice("frame", "gcrs", {"gcrs", "eme2000", "teme", "itrs"}));
  out.frame = frame == "gcrs"      ? OrbitFrame::Gcrs
              : frame == "eme2000" ? OrbitFrame::Eme2000
              : frame == "teme"    ? OrbitFrame::Teme
                                   : OrbitFrame::Itrs;
  UMOV_ASSIGN(epoch, orbit.time("epoch"));
  UMOV_ASSIGN(position, three_numbers(orbit, "position_km"));
  UMOV_ASSIGN(velocity, three_numbers(orbit, "velocity_km_s"));
  out.state = {epoch, position, velocity};
  return out;
}

Result<void> read_orbit(const Node &object, const fs::path &folder, Scenario &out) {
  if (!object.has("orbit"))
    return {};
  UMOV_ASSIGN(orbit, object.child("orbit"));
  const auto norad = orbit.integer("norad", 0);
  if (norad < 0 || norad > 999'999'999)
    return fail(ErrorCode::BadInput,
                fmt::format("norad = {}; a catalogue number was expected", norad),
                orbit.where("norad"));
  ScenarioOrbit one;
  one.norad = static_cast<int>(norad);
  out.places[key_of(out, "orbit")] = orbit.where(orbit.has("file") ? "file" : "epoch");
  if (!orbit.has("file") && orbit.has("position_km")) {
    UMOV_ASSIGN(state, read_state(orbit));
    one.state = state;
  } else {
    UMOV_TRY(orbit.require("file"));
    for (const char *name : {"epoch", "frame", "position_km", "velocity_km_s"})
      if (orbit.has(name))
        return fail(ErrorCode::BadInput,
                    fmt::format("{} has no meaning with file; leave one of them out", name),
                    orbit.where(name));
    one.file = tidy_path(folder / orbit.text("file", ""));
  }
  out.objects.back().orbit = one;
  return {};
}

Result<void> read_parts(const Node &object, Scenario &out) {
  const toml::array *list = object.table().get_as<toml::array>("part");
  if (list == nullptr)
    return {};
  out.places[key_of(out, "part")] = object.where("part");
  for (const toml::node &item : *list) {
    if (!item.is_table())
      return fail(ErrorCode::BadInput, "part: a table [[object.part]] was expected",
                  object.where("part"));
    const Node node(*item.as_table(), "object.part", "object.part", out.file);
    UMOV_TRY(node.check());
    UMOV_ASSIGN(part, scenario::read_part(node));
    if (part.joint.name.empty()) // messages and columns call it by its place in the list
      part.joint.name = fmt::format("{}", out.objects.back().parts.size() + 1);
    out.objects.back().parts.push_back(part);
  }
  return {};
}

Result<void> read_attitude_of(const Node &object, const fs::path &folder, Scenario &out) {
  if (!object.has("attitude"))
    return {};
  ScenarioObject &one = out.objects.back();
  UMOV_ASSIGN(node, object.child("attitude"));
  out.places[key_of(out, "attitude")] = object.where("attitude");
  const auto begin = out.time ? std::optional(out.time->start) : std::nullopt;
  UMOV_ASSIGN(law, scenario::read_attitude(node, folder, {out.seed, begin}));
  one.attitude = law;
  const std::string mode = node.text("mode", "");
  one.has_assumed_epoch = begin && (mode == "spin" || mode == "tumble") && !node.has("epoch");
  return {};
}

Result<void> read_object(const Node &object, const fs::path &folder, Scenario &out) {
  UMOV_TRY(object.check());
  out.objects.emplace_back().name = object.text("name", "");
  Problems problems;
  problems.went(read_orbit(object, folder, out));
  if (object.has("mesh"))
    problems.went(read_mesh(object, folder, out));
  else // where it was is enough for some questions; whoever asks for its shape is told
    out.places[key_of(out, "mesh")] = object.where();
  problems.went(read_attitude_of(object, folder, out));
  problems.went(read_parts(object, out));
  problems.went(read_materials(object, out));
  return problems.told();
}

Result<void> read_objects(const Node &top, const fs::path &folder, Scenario &out) {
  UMOV_TRY(top.require("object"));
  const toml::array *list = top.table().get_as<toml::array>("object");
  constexpr std::size_t objects_max = 10'000;
  if (list->empty() || list->size() > objects_max)
    return fail(ErrorCode::BadInput,
                fmt::format("object: 1 to {} tables [[object]] were expected", objects_max),
                top.where("object"));
  Problems problems;
  for (const toml::node &item : *list) {
    if (!item.is_table())
      return fail(ErrorCode::BadInput, "object: a table [[object]] was expected",
                  top.where("object"));
    problems.went(read_object(Node(*item.as_table(), "object", "object", out.file), folder, out));
  }
  return problems.told();
}

Result<void> read_method(const Node &render, LightOptions &out) {
  UMOV_ASSIGN(method, render.choice("method", name_of(out.method), {"auto", "rays", "masks"}));
  out.method = method == "rays"    ? LightMethod::Rays
               : method == "masks" ? LightMethod::Masks
                                   : LightMethod::Auto;
  out.accuracy = render.number("accuracy", out.accuracy);
  if (!(out.accuracy >= 1e-6 && out.accuracy <= 1))
    return fail(ErrorCode::BadInput,
                fmt::format("accuracy = {}; 1e-6 to 1 was expected", out.accuracy),
                render.where("accuracy"));
  if (!render.has("accuracy_floor"))
    return {};
  out.accuracy_floor = render.number("accuracy_floor", 0);
  if (!(*out.accuracy_floor >= 0 && *out.accuracy_floor <= 10))
    return fail(ErrorCode::BadInput,
                fmt::format("accuracy_floor = {}; 0 to 10 was expected", *out.accuracy_floor),
                render.where("accuracy_floor"));
  return {};
}

Result<void> read_render(const Node &top, Scenario &out) {
  if (top.has("render")) {
    UMOV_ASSIGN(node, top.child("render"));
    const auto bounces = node.integer("bounces", 1);
    if (bounces < 1 || bounces > 64)
      return fail(ErrorCode::BadInput, fmt::format("bounces = {}; 1 to 64 was expected", bounces),
                  node.where("bounces"));
    out.light.bounces = static_cast<std::size_t>(bounces);
    UMOV_ASSIGN(between,
                node.choice("between", name_of(out.light.between), {"auto", "paths", "chains"}));
    out.light.between = between == "paths"    ? BetweenMethod::Paths
                        : between == "chains" ? BetweenMethod::Chains
                                              : BetweenMethod::Auto;
    UMOV_TRY(read_method(node, out.light));
    if (node.has("accuracy"))
      out.places["render.accuracy"] = node.where("accuracy");
    out.has_moonlight = node.boolean("moonlight", false);
    UMOV_ASSIGN(edge, node.choice("shadow_edge", "geometric", {"geometric", "refracted"}));
    out.has_refracted_shadow = edge == "refracted";
    if (node.has("earthshine")) {
      UMOV_ASSIGN(earth, node.child("earthshine"));
      EarthshineOptions options;
      options.albedo = earth.number("albedo", options.albedo);
      const auto patches = earth.integer("patches", static_cast<std::int64_t>(options.patches));
      if (!(options.albedo >= 0 && options.albedo <= 1))
        return fail(ErrorCode::BadInput,
                    fmt::format("albedo = {}; 0 to 1 was expected", options.albedo),
                    earth.where("albedo"));
      if (patches < 10 || patches > 100'000)
        return fail(ErrorCode::BadInput,
                    fmt::format("patches = {}; 10 to 100000 was expected", patches),
                    earth.where("patches"));
      options.patches = static_cast<std::size_t>(patches);
      options.accuracy = earth.number("accuracy", options.accuracy);
      if (!(options.accuracy >= 1e-4 && options.accuracy <= 1))
        return fail(ErrorCode::BadInput,
                    fmt::format("accuracy = {}; 1e-4 to 1 was expected", options.accuracy),
                    earth.where("accuracy"));
      out.earthshine = options;
    }
    UMOV_ASSIGN(sun, node.choice("sun", "disk", {"disk", "point"}));
    out.has_solar_disk = sun == "disk";
  }
  return {};
}

/// [materials]: what holds for all of them; those of an object are in [object.materials].
Result<void> read_vary(const Node &top, Scenario &out) {
  if (!top.has("materials"))
    return {};
  UMOV_ASSIGN(node, top.child("materials"));
  if (!node.has("vary"))
    return {};
  UMOV_ASSIGN(names, node.strings("vary"));
  for (const std::string &name : names)
    if (name != "haze")
      return fail(ErrorCode::BadInput,
                  fmt::format("vary: \"{}\" has no stated range; \"haze\" was expected", name),
                  node.where("vary"));
  out.varies_haze = !names.empty();
  out.places["materials.vary"] = node.where("vary");
  return {};
}

Result<void> read_output(const Node &top, Scenario &out) {
  if (!top.has("output"))
    return {};
  UMOV_ASSIGN(node, top.child("output"));
  out.output_dir = node.text("dir", "out");
  if (out.output_dir.empty())
    return fail(ErrorCode::BadInput, "dir = \"\"; a folder was expected", node.where("dir"));
  UMOV_ASSIGN(frame, node.choice("pol_frame", "equatorial", {"equatorial", "altaz", "scattering"}));
  out.frame = frame == "altaz"        ? PolarizationFrame::AltAz
              : frame == "scattering" ? PolarizationFrame::Scattering
                                      : PolarizationFrame::Equatorial;
  UMOV_ASSIGN(digits, node.choice("csv_digits", "error", {"error", "all"}));
  out.keeps_inputs = node.boolean("keep_inputs", false);
  out.has_all_csv_digits = digits == "all";
  if (node.has("formats")) {
    UMOV_ASSIGN(formats, node.strings("formats"));
    if (formats.empty())
      return fail(ErrorCode::BadInput, "formats is empty; ecsv, csv, fits or html was expected",
                  node.where("formats"));
    for (const std::string &format : formats)
      if (format != "ecsv" && format != "csv" && format != "fits" && format != "html")
        return fail(
            ErrorCode::BadInput,
            fmt::format("formats: \"{}\" is unknown; ecsv, csv, fits and html were expected",
                        format),
            node.where("formats"));
    out.formats = formats;
  }
  return {};
}

Result<void> read_air(const Node &top, const fs::path &folder, Scenario &out) {
  UMOV_ASSIGN(air, scenario::read_site_air(top));
  out.air = air;
  UMOV_ASSIGN(observation, scenario::read_observation(top, air, folder.string()));
  out.observation = observation;
  const bool has_bands_of_its_own = observation && !observation->bands.empty();
  if (air && !has_bands_of_its_own)
    return check_air_reaches(out.bands, top.where("bands"));
  return {};
}

Result<void> read_own_materials(const Node &top, Scenario &out) {
  UMOV_ASSIGN(own, scenario::read_material_tables(top));
  UMOV_TRY(scenario::check_own_names(top, own));
  out.own_materials = own;
  return {};
}

Result<Scenario> read_document(toml::table &document, const fs::path &path) {
  Scenario out;
  out.file = path.string();
  const Node top(document, "", "", out.file);
  UMOV_TRY(top.check_with_all_below());
  UMOV_TRY(top.require("umov"));
  if (const auto form = top.integer("umov", 1); form != 1)
    return fail(ErrorCode::BadInput, fmt::format("umov = {}; this version reads 1", form),
                top.where("umov"));
  const auto seed = top.integer("seed", 0);
  if (seed < 0)
    return fail(ErrorCode::BadInput, fmt::format("seed = {}; 0 or more was expected", seed),
                top.where("seed"));
  out.seed = static_cast<std::uint64_t>(seed);
  out.title = top.text("title", "");
  Problems problems;
  problems.went(read_observer(top, out));
  problems.went(read_earth(top, path.parent_path(), out));
  const bool has_time = problems.went(read_time(top, out));
  problems.went(scenario::read_bands(top, path.parent_path(), out));
  problems.went(read_render(top, out));
  problems.went(read_vary(top, out));
  problems.went(read_output(top, out));
  problems.went(read_air(top, path.parent_path(), out));
  note_places(top, out);
  // An attitude turns from the start of the time, and objects are made of the materials.
  if (problems.went(read_own_materials(top, out)) && has_time)
    problems.went(read_objects(top, path.parent_path(), out));
  UMOV_TRY(problems.told());
  return out;
}

} // namespace

Result<Scenario> read_scenario_text(const std::string &text, const fs::path &path,
                                    const std::vector<std::string> &overrides) {
  UMOV_ASSIGN(document, scenario::parse_toml(text, path.string()));
  for (const std::string &one : overrides)
    UMOV_TRY(override_key(document, one));
  return read_document(document, path);
}

Result<Scenario> read_scenario(const fs::path &path, const std::vector<std::string> &overrides) {
  UMOV_ASSIGN(text, read_file(path, 16u << 20));
  return read_scenario_text(text, path, overrides);
}

Where Scenario::place(const std::string &key) const {
  if (const auto found = places.find(key); found != places.end())
    return found->second;
  const auto table = places.find(key.substr(0, key.rfind('.')));
  return table == places.end() ? Where{file} : table->second;
}

Result<void> check_complete_for_run(const Scenario &s) {
  std::string missing;
  const bool has_orbits =
      std::all_of(s.objects.begin(), s.objects.end(),
                  [](const ScenarioObject &one) { return one.orbit.has_value(); });
  for (const auto &[is_there, name] : {std::pair{s.observer.has_value(), "[observer]"},
                                       {s.time.has_value(), "[time]"},
                                       {has_orbits, "object.orbit"}})
    if (!is_there)
      missing += (missing.empty() ? "" : ", ") + std::string(name);
  if (missing.empty())
    return {};
  return fail(ErrorCode::BadInput,
              "umov run also needs " + missing + "; without them it is a scene for umov signature",
              {s.file});
}

} // namespace umov
