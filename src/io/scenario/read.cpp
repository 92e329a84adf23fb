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

using scenario::Node, scenario::Problems, scenario::wrong_value;
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
  const double lat_deg = node.number("lat_deg", 0), lon_deg = node.number("lon_deg", 0),
               alt_m = node.number("alt_m", 0);
  for (const auto &[name, site] :
       {std::pair{"lat_deg", make_site("", lat_deg, 0, 0)},
        {"lon_deg", make_site("", 0, lon_deg, 0)},
        {"alt_m", make_site("", 0, 0, alt_m)}}) // of one number each: all are told
    if (!site)
      problems.add({ErrorCode::BadInput, site.error().message, node.where(name)});
  UMOV_TRY(problems.told());
  UMOV_ASSIGN(site, make_site(node.text("name", ""), lat_deg, lon_deg, alt_m));
  out.observer = site;
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

Result<void> read_only(const Node &node, EpochFilter &out) {
  UMOV_ASSIGN(only, node.child("only"));
  Problems problems;
  const double lowest = only.number("alt_min_deg", 0), sun = only.number("sun_alt_max_deg", 90);
  for (const auto &[name, value] : {std::pair{"alt_min_deg", lowest}, {"sun_alt_max_deg", sun}})
    if (std::abs(value) > 90)
      problems.add(wrong_value(only, name, value, "-90 to 90"));
  out.altitude_min = Angle::degrees(lowest);
  if (only.has("sun_alt_max_deg"))
    out.sun_altitude_max = Angle::degrees(sun);
  out.sunlit = only.boolean("sunlit", true);
  return problems.told();
}

/// Epochs of one's own.
Result<void> read_epochs(const Node &node, ScenarioTime &out) {
  for (const char *name : {"start", "stop", "step_s"})
    if (node.has(name))
      return fail(ErrorCode::BadInput,
                  fmt::format("{}: epochs stand in place of start, stop and step_s; one way of "
                              "saying it was expected (set as a whole, time = {{ epochs = [...] }} "
                              "takes the place of both)",
                              name),
                  node.where(name));
  for (const toml::node &item : *node.get("epochs")->as_array()) {
    UMOV_ASSIGN(time, time_of(node, item));
    out.epochs.push_back(time);
  }
  if (out.epochs.empty())
    return fail(ErrorCode::BadInput, "epochs has none; one or more were expected",
                node.where("epochs"));
  out.start = out.epochs.front();
  out.stop = out.epochs.back();
  for (std::size_t k = 1; k < out.epochs.size(); ++k) {
    const double step = seconds_between(out.epochs[k], out.epochs[k - 1]);
    out.step_s = k == 1 ? step : std::min(out.step_s, step);
  }
  if (const auto count = epoch_count(out.span()); !count)
    return fail(ErrorCode::BadInput, count.error().message, node.where("epochs"));
  return {};
}

Result<void> read_time(const Node &top, Scenario &out) {
  if (!top.has("time"))
    return {};
  UMOV_ASSIGN(node, top.child("time"));
  ScenarioTime time;
  Problems problems;
  if (node.has("epochs")) {
    problems.went(read_epochs(node, time));
    if (node.has("only"))
      problems.went(read_only(node, time.only));
    UMOV_TRY(problems.told());
    out.time = time;
    return {};
  }
  const auto start = node.time("start"), stop = node.time("stop");
  const bool has_start = problems.went(start), has_stop = problems.went(stop);
  time.step_s = node.number("step_s", 1);
  const bool has_step = time.step_s > 0;
  if (!has_step)
    problems.add(wrong_value(node, "step_s", time.step_s, "a positive number"));
  if (has_start && has_stop) {
    time.start = *start;
    time.stop = *stop;
    if (const auto count = epoch_count({*start, *stop, time.step_s}); has_step && !count)
      problems.add({ErrorCode::BadInput, count.error().message, node.where("stop")});
  }
  if (node.has("only"))
    problems.went(read_only(node, time.only));
  UMOV_TRY(problems.told());
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
      const auto below = node.child(name.c_str(), "sides");
      if (!problems.went(below) || !problems.went(below->require("front")) ||
          !problems.went(below->require("back")))
        continue;
      sides = {below->text("front", ""), below->text("back", "")};
    } else {
      problems.add({ErrorCode::BadInput,
                    fmt::format("{} is {}; the name of a material in quotes, or {{ front = ..., "
                                "back = ... }}, was expected",
                                name, scenario::described(value)),
                    scenario::place_of(key, value, out.file)});
      continue;
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
  Problems problems;
  if (problems.went(node.require("file")) && node.text("file", "").empty())
    problems.add(wrong_value(node, "file", "\"\"", "the name of a mesh"));
  const std::string normals =
      problems.taken(node.choice("normals", "flat", {"flat", "smooth"}), std::string("flat"));
  ScenarioMesh &mesh = out.objects.back().mesh;
  mesh.file = tidy_path(folder / node.text("file", ""));
  mesh.unit = node.text("unit", "");
  mesh.up = node.text("up", "");
  mesh.normals = normals == "smooth" ? NormalMode::Smooth : NormalMode::Flat;
  mesh.crease_deg = node.number("crease_deg", 35);
  if (!(mesh.crease_deg >= 0 && mesh.crease_deg <= 180))
    problems.add(wrong_value(node, "crease_deg", mesh.crease_deg, "0 to 180"));
  out.places[key_of(out, "mesh")] = node.where("file");
  return problems.told();
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
  Problems problems;
  const std::string frame = problems.taken(
      orbit.choice("frame", "gcrs", {"gcrs", "eme2000", "teme", "itrs"}), std::string("gcrs"));
  out.frame = frame == "gcrs"      ? OrbitFrame::Gcrs
              : frame == "eme2000" ? OrbitFrame::Eme2000
              : frame == "teme"    ? OrbitFrame::Teme
                                   : OrbitFrame::Itrs;
  const std::array<double, 3> none{};
  const auto epoch = problems.taken(orbit.time("epoch"), Epoch<Utc>{});
  const auto position = problems.taken(three_numbers(orbit, "position_km"), none);
  const auto velocity = problems.taken(three_numbers(orbit, "velocity_km_s"), none);
  UMOV_TRY(problems.told());
  out.state = {epoch, position, velocity};
  return out;
}

Result<void> read_orbit(const Node &object, const fs::path &folder, Scenario &out) {
  if (!object.has("orbit"))
    return {};
  UMOV_ASSIGN(orbit, object.child("orbit"));
  Problems problems;
  const auto norad = orbit.integer("norad", 0);
  if (norad < 0 || norad > 999'999'999)
    problems.add(wrong_value(orbit, "norad", norad, "a catalogue number"));
  ScenarioOrbit one;
  one.norad = static_cast<int>(norad);
  out.places[key_of(out, "orbit")] = orbit.where(orbit.has("file") ? "file" : "epoch");
  if (!orbit.has("file") && orbit.has("position_km")) {
    one.state = problems.taken(read_state(orbit), StateVector{});
  } else if (problems.went(orbit.require("file"))) {
    for (const char *name : {"epoch", "frame", "position_km", "velocity_km_s"})
      if (orbit.has(name))
        problems.add({ErrorCode::BadInput,
                      fmt::format("{} has no meaning with file; leave one of them out", name),
                      orbit.where(name)});
    one.file = tidy_path(folder / orbit.text("file", ""));
  }
  out.objects.back().orbit = one;
  return problems.told();
}

Result<void> read_parts(const Node &object, Scenario &out) {
  const toml::array *list = object.table().get_as<toml::array>("part");
  if (list == nullptr)
    return {};
  out.places[key_of(out, "part")] = object.where("part");
  Problems problems;
  for (const toml::node &item : *list) {
    if (!item.is_table())
      return scenario::no_table("part", item, "tables [[object.part]]", object.where("part"));
    const Node node(*item.as_table(), "object.part", "object.part", out.file);
    if (!problems.went(node.check()))
      continue;
    MovingJoint part = problems.taken(scenario::read_part(node), MovingJoint{});
    if (part.joint.name.empty()) // messages and columns call it by its place in the list
      part.joint.name = fmt::format("{}", out.objects.back().parts.size() + 1);
    out.objects.back().parts.push_back(part);
  }
  return problems.told();
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
  const bool has_none = (mode == "spin" || mode == "tumble") && !node.has("epoch");
  one.has_assumed_epoch = begin && has_none;
  one.lacks_epoch = !begin && has_none;
  return {};
}

Result<void> read_object(const Node &object, const fs::path &folder, Scenario &out) {
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
      return scenario::no_table("object", item, "tables [[object]]", top.where("object"));
    problems.went(read_object(Node(*item.as_table(), "object", "object", out.file), folder, out));
  }
  return problems.told();
}

/// One of the words of a key; "" where it is none of them, which is told.
std::string word_of(const Node &node, Problems &problems, const char *name, const char *usual,
                    const std::vector<std::string> &known) {
  return problems.taken(node.choice(name, usual, known), std::string());
}

Result<void> read_method(const Node &render, LightOptions &out) {
  Problems problems;
  const std::string method =
      word_of(render, problems, "method", name_of(out.method), {"auto", "rays", "masks"});
  out.method = method == "rays"    ? LightMethod::Rays
               : method == "masks" ? LightMethod::Masks
                                   : LightMethod::Auto;
  out.accuracy = render.number("accuracy", out.accuracy);
  if (!(out.accuracy >= 1e-6 && out.accuracy <= 1))
    problems.add(wrong_value(render, "accuracy", out.accuracy, "1e-6 to 1"));
  if (!render.has("accuracy_floor"))
    return problems.told();
  out.accuracy_floor = render.number("accuracy_floor", 0);
  if (!(*out.accuracy_floor >= 0 && *out.accuracy_floor <= 10))
    problems.add(wrong_value(render, "accuracy_floor", *out.accuracy_floor, "0 to 10"));
  return problems.told();
}

Result<void> read_earthshine(const Node &render, Scenario &out) {
  UMOV_ASSIGN(earth, render.child("earthshine"));
  Problems problems;
  EarthshineOptions options;
  options.albedo = earth.number("albedo", options.albedo);
  const auto patches = earth.integer("patches", static_cast<std::int64_t>(options.patches));
  if (!(options.albedo >= 0 && options.albedo <= 1))
    problems.add(wrong_value(earth, "albedo", options.albedo, "0 to 1"));
  if (patches < 10 || patches > 100'000)
    problems.add(wrong_value(earth, "patches", patches, "10 to 100000"));
  options.patches = static_cast<std::size_t>(patches);
  options.accuracy = earth.number("accuracy", options.accuracy);
  if (!(options.accuracy >= 1e-4 && options.accuracy <= 1))
    problems.add(wrong_value(earth, "accuracy", options.accuracy, "1e-4 to 1"));
  out.earthshine = options;
  return problems.told();
}

Result<void> read_render(const Node &top, Scenario &out) {
  if (!top.has("render"))
    return {};
  UMOV_ASSIGN(node, top.child("render"));
  Problems problems;
  const auto bounces = node.integer("bounces", static_cast<std::int64_t>(out.light.bounces));
  if (bounces < 1 || bounces > 64)
    problems.add(wrong_value(node, "bounces", bounces, "1 to 64"));
  out.light.bounces = static_cast<std::size_t>(bounces);
  const std::string between =
      word_of(node, problems, "between", name_of(out.light.between), {"auto", "paths", "chains"});
  out.light.between = between == "paths"    ? BetweenMethod::Paths
                      : between == "chains" ? BetweenMethod::Chains
                                            : BetweenMethod::Auto;
  problems.went(read_method(node, out.light));
  if (node.has("accuracy"))
    out.places["render.accuracy"] = node.where("accuracy");
  out.has_moonlight = node.boolean("moonlight", false);
  out.has_refracted_shadow = word_of(node, problems, "shadow_edge", "geometric",
                                     {"geometric", "refracted"}) == "refracted";
  if (node.has("earthshine"))
    problems.went(read_earthshine(node, out));
  out.has_solar_disk = word_of(node, problems, "sun", "disk", {"disk", "point"}) == "disk";
  return problems.told();
}

/// [materials]: what holds for all of them; those of an object are in [object.materials].
Result<void> read_vary(const Node &top, Scenario &out) {
  if (!top.has("materials"))
    return {};
  UMOV_ASSIGN(node, top.child("materials"));
  if (!node.has("vary"))
    return {};
  UMOV_ASSIGN(names, node.strings("vary"));
  Problems problems;
  for (const std::string &name : names)
    if (name != "haze")
      problems.add({ErrorCode::BadInput,
                    fmt::format("vary: \"{}\" has no stated range; \"haze\" was expected", name),
                    node.where("vary")});
  UMOV_TRY(problems.told());
  out.varies_haze = !names.empty();
  out.places["materials.vary"] = node.where("vary");
  return {};
}

Result<void> read_formats(const Node &node, Scenario &out) {
  UMOV_ASSIGN(formats, node.strings("formats"));
  if (formats.empty())
    return fail(ErrorCode::BadInput, "formats is empty; ecsv, csv, fits or html was expected",
                node.where("formats"));
  Problems problems;
  for (const std::string &format : formats)
    if (format != "ecsv" && format != "csv" && format != "fits" && format != "html")
      problems.add(
          {ErrorCode::BadInput,
           fmt::format("formats: \"{}\" is unknown; ecsv, csv, fits and html were expected",
                       format),
           node.where("formats")});
  out.formats = formats;
  return problems.told();
}

Result<void> read_output(const Node &top, Scenario &out) {
  if (!top.has("output"))
    return {};
  UMOV_ASSIGN(node, top.child("output"));
  Problems problems;
  out.output_dir = node.text("dir", "out");
  if (out.output_dir.empty())
    problems.add(wrong_value(node, "dir", "\"\"", "a folder"));
  const std::string frame =
      word_of(node, problems, "pol_frame", "equatorial", {"equatorial", "altaz", "scattering"});
  out.frame = frame == "altaz"        ? PolarizationFrame::AltAz
              : frame == "scattering" ? PolarizationFrame::Scattering
                                      : PolarizationFrame::Equatorial;
  out.has_all_csv_digits =
      word_of(node, problems, "csv_digits", "error", {"error", "all"}) == "all";
  out.keeps_inputs = node.boolean("keep_inputs", false);
  if (node.has("formats"))
    problems.went(read_formats(node, out));
  return problems.told();
}

Result<void> read_air(const Node &top, const fs::path &folder, Scenario &out) {
  Problems problems;
  const auto air =
      problems.taken(scenario::read_site_air(top, folder, out.band_files), decltype(out.air){});
  const auto observation = problems.taken(scenario::read_observation(top, air, folder.string()),
                                          decltype(out.observation){});
  UMOV_TRY(problems.told());
  out.air = air;
  out.observation = observation;
  const bool has_bands_of_its_own = observation && !observation->bands.empty();
  if (air && !has_bands_of_its_own)
    return check_air_reaches(out.bands, *air, top.where("bands"),
                             observation ? observation->width_nm : 0);
  return {};
}

void read_own_materials(const Node &top, Scenario &out, Problems &problems) {
  out.own_materials = scenario::read_material_tables(top, problems);
  problems.went(scenario::check_own_names(top, out.own_materials));
}

Result<Scenario> read_document(toml::table &document, const fs::path &path) {
  Scenario out;
  out.file = path.string();
  const Node top(document, "", "", out.file);
  Problems problems;
  const bool has_objects = top.has("object"); // else it is told what stands there
  scenario::settle_keys(document, out.file, problems);
  problems.went(top.require("umov"));
  if (const auto form = top.integer("umov", 1); form != 1)
    return fail(ErrorCode::BadInput, fmt::format("umov = {}; this version reads 1", form),
                top.where("umov"));
  const auto seed = top.integer("seed", 0);
  if (seed < 0)
    problems.add(wrong_value(top, "seed", seed, "0 or more"));
  out.seed = static_cast<std::uint64_t>(seed);
  out.title = top.text("title", "");
  problems.went(read_observer(top, out));
  problems.went(read_earth(top, path.parent_path(), out));
  if (!problems.went(read_time(top, out)))
    out.time.emplace(); // attitudes may turn from its start
  problems.went(scenario::read_bands(top, path.parent_path(), out));
  problems.went(read_render(top, out));
  problems.went(read_vary(top, out));
  problems.went(read_output(top, out));
  problems.went(read_air(top, path.parent_path(), out));
  note_places(top, out);
  read_own_materials(top, out, problems);
  if (top.has("object") || !has_objects)
    problems.went(read_objects(top, path.parent_path(), out));
  // Whoever loads the objects would tell of these; where all is told, they are too.
  for (std::size_t k = 0; problems.has_some() && k < out.objects.size(); ++k)
    scenario::add_missing_files(out, k, true, problems);
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
