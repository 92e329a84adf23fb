#include "io/scenario/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>
#include <umov/core/files.h>
#include <umov/core/stop.h>
#include <umov/core/text.h>
#include <umov/io/attitude_file.h>
#include <umov/io/index_file.h>
#include <umov/io/mesh_file.h>
#include <umov/io/trajectory_file.h>
#include <umov/shape/topology.h>
#include <umov/time/earth_orientation.h>
#include <utility>

namespace umov {
namespace {

Result<std::string> read_input(const std::filesystem::path &path, const Where &named_at,
                               LoadedObject &out) {
  if (path.empty())
    return fail(ErrorCode::BadInput, "the name of a file is empty; give one", named_at);
  auto text = read_file(path);
  if (!text)
    return tl::unexpected(scenario::named(text.error(), named_at));
  out.inputs.push_back({path.string(), sha256_hex(*text)});
  return text;
}

/// An object of a scenario, and how its keys are called.
struct Named {
  const Scenario &scenario;
  const ScenarioObject &object;
  std::size_t number;

  [[nodiscard]] Where place(const std::string &key) const {
    return scenario.place(fmt::format("object.{}.{}", number, key));
  }
  /// The key that says what a group of the mesh is made of.
  [[nodiscard]] std::string material_key(const std::string &group) const {
    return "materials." + (object.materials.contains(group) ? group : "default");
  }
};

/// The file of an attitude table, "" if there is none.
std::string attitude_file(const AttitudeLaw &law) {
  const auto *table = std::get_if<TableLaw>(&law);
  return table != nullptr ? table->file : std::string();
}

/// For the whole process, as Earth orientation is.
Result<void> load_earth(const Scenario &scenario, LoadedObject &out) {
  if (scenario.earth_orientation.empty())
    return {};
  const auto named = scenario.places.find("earth.eop");
  if (named == scenario.places.end()) { // the caller's own
    UMOV_ASSIGN(own, read_file(scenario.earth_orientation));
    out.inputs.push_back({scenario.earth_orientation.string(), sha256_hex(own)});
    return use_earth_orientation(own, scenario.earth_orientation.string());
  }
  UMOV_ASSIGN(text, read_input(scenario.earth_orientation, named->second, out));
  return use_earth_orientation(text, scenario.earth_orientation.string());
}

/// From when to when the orbit is asked for. A moment of the span is seen with the span's elements:
/// a file of several sets gives it the same orbit as a run.
std::pair<Epoch<Utc>, Epoch<Utc>> span_of_orbit(const ScenarioTime &span,
                                                const std::optional<Epoch<Utc>> &at) {
  if (!at || (seconds_between(*at, span.start) >= 0 && seconds_between(span.stop, *at) >= 0))
    return {span.start, span.stop};
  return {*at, *at};
}

Result<void> load_orbit(const Named &of, const LoadOptions &options, Diagnostics &diagnostics,
                        LoadedObject &out) {
  const Scenario &scenario = of.scenario;
  if (!of.object.orbit)
    return {};
  if (of.object.orbit->state) {
    if (!scenario.time)
      return {};
    const auto [first, last] = span_of_orbit(*scenario.time, options.at);
    StateVector state = *of.object.orbit->state;
    state.name = of.object.name;
    state.norad_cat_id = of.object.orbit->norad;
    auto orbit = integrate_orbit(state, first, last);
    if (!orbit)
      return fail(orbit.error().code, orbit.error().message, of.place("orbit"));
    out.orbit = Trajectory(*orbit);
    return {};
  }
  const std::string file = of.object.orbit->file.string();
  UMOV_ASSIGN(text, read_input(file, of.place("orbit"), out));
  if (!scenario.time)
    return {}; // a scene: its orbit is not asked for
  TrajectoryRequest request;
  request.norad = of.object.orbit->norad;
  std::tie(request.first, request.last) = span_of_orbit(*scenario.time, options.at);
  request.allow_bad_checksum = options.allow_bad_checksum;
  request.allow_old_elements = options.allow_old_elements;
  UMOV_ASSIGN(orbit, read_trajectory(text, file, request, diagnostics));
  out.orbit = orbit;
  return {};
}

/// Of a spin or a tumble, which alone have one.
Epoch<Utc> epoch_of(const AttitudeLaw &law) {
  const auto *const tumble = std::get_if<TumbleLaw>(&law);
  return tumble != nullptr ? tumble->epoch : std::get<SpinLaw>(law).epoch;
}

Result<void> load_attitude(const Named &of, const Mesh &mesh, const LoadOptions &options,
                           Diagnostics &diagnostics, LoadedObject &out) {
  const std::atomic<bool> *cancel = options.cancel;
  auto law = completed(
      of.object.attitude, mesh,
      [&](const std::string &file) -> Result<std::shared_ptr<const AttitudeTable>> {
        UMOV_ASSIGN(text, read_input(file, of.place("attitude"), out));
        UMOV_ASSIGN(table, read_attitude_table(text, file, diagnostics));
        return std::make_shared<const AttitudeTable>(table);
      },
      cancel);
  leave_if_stopped(cancel);
  if (!law)
    return fail(law.error().code, law.error().message,
                law.error().where.file.empty() ? of.place("attitude") : law.error().where);
  if (auto checked = check_attitude(*law); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, of.place("attitude"));
  if (of.object.lacks_epoch && options.turns_in_time)
    return fail(ErrorCode::BadInput,
                "[object.attitude] has no \"epoch\", and there is no time.start, which it would be "
                "else; when it has the attitude of `start` was expected. Add it.",
                of.place("attitude"));
  if (of.object.has_assumed_epoch) {
    const std::string begin = to_iso(epoch_of(*law)); // of the scenario, whose span may be another
    diagnostics.warn(
        fmt::format("attitude has no epoch: it turns from its start at time.start, {}, "
                    "and another start is another attitude. Set epoch = {} to keep "
                    "this one whatever the span",
                    begin, begin),
        of.place("attitude"));
  }
  out.attitude = *law;
  return {};
}

/// The mesh of the very bytes whose hashes are kept.
Result<MeshFile> load_mesh(const Named &of, const std::atomic<bool> *cancel,
                           Diagnostics &diagnostics, LoadedObject &out) {
  const ScenarioMesh &mesh = of.object.mesh;
  UMOV_ASSIGN(bytes, read_input(mesh.file, of.place("mesh"), out));
  auto read = read_mesh_bytes(
      bytes, mesh.file, {.unit = mesh.unit, .up = mesh.up, .cancel = cancel, .asks_for_mtl = false},
      diagnostics);
  leave_if_stopped(cancel);
  if (!read && read.error().where.line == 0) // such as no unit, which the scenario has to give
    return tl::unexpected(scenario::named(read.error(), of.place("mesh")));
  if (!read)
    return read;
  for (const MeshPart &file : read->files)
    out.inputs.push_back({file.path.string(), file.sha256});
  return read;
}

/// Every key of [object.materials] must mean some material of the mesh.
Result<void> check_material_keys(const Named &of, const Mesh &mesh) {
  for (const auto &[name, sides] : of.object.materials) {
    if (name == "default" ||
        std::find(mesh.groups.begin(), mesh.groups.end(), name) != mesh.groups.end())
      continue;
    const std::vector<std::string> groups = with_joined_groups(mesh).groups;
    const auto near = nearest_name(name, groups);
    return fail(ErrorCode::BadInput,
                fmt::format("\"{}\" is no material of {}.{} It has {}.", name,
                            of.object.mesh.file.string(),
                            near ? fmt::format(" Did you mean \"{}\"?", *near) : "",
                            fmt::join(groups, ", ")),
                of.place("materials." + name));
  }
  return {};
}

Result<MaterialNames> names_of(const Named &of, const Mesh &mesh, const MeshReport &report,
                               std::size_t group) {
  for (const std::string &key : {mesh.groups[group], std::string("default")})
    if (const auto found = of.object.materials.find(key); found != of.object.materials.end())
      return found->second;
  return fail(
      ErrorCode::BadInput,
      fmt::format("material \"{}\" ({} faces, {:.4g} m2) has no entry in [object.materials] "
                  "of {} and there is no \"default\". Known: umov material list.",
                  mesh.groups[group], report.group_triangles[group], report.group_area_m2[group],
                  of.scenario.file),
      {of.object.mesh.file.string()});
}

/// Wavelengths that a band asks a material for.
std::pair<double, double> range_of(const Band &band) {
  if (!band.curve)
    return {band.wavelength.nm(), band.wavelength.nm()};
  return {band.curve->wavelength_nm.front(), band.curve->wavelength_nm.back()};
}

/// Every table that a material (const or not) asks for its light.
auto tables_of(auto &material) {
  std::vector<decltype(&material.index)> out{&material.index};
  for (auto &layer : material.layers)
    out.push_back(&layer.index);
  return out;
}

/// The part of a curve's response outside a range of wavelengths.
double tail_of(const Passband &curve, const WavelengthRange &known) {
  double whole = 0, outside = 0;
  for (std::size_t k = 1; k < curve.wavelength_nm.size(); ++k) {
    const double a = curve.wavelength_nm[k - 1], b = curve.wavelength_nm[k];
    const double area = 0.5 * (curve.response[k - 1] + curve.response[k]) * (b - a);
    const double inside = std::min(b, known.last_nm) - std::max(a, known.first_nm);
    whole += area;
    outside += area * (1 - std::clamp(inside / (b - a), 0.0, 1.0));
  }
  return whole > 0 ? outside / whole : 0;
}

/// So little of a band that its light hardly depends on what is taken there.
constexpr double negligible_tail = 0.05;

bool covers(const IndexTable &table, const Band &band) {
  if (!band.curve)
    return index_at(table, band.wavelength).has_value();
  return table.holds_ends || tail_of(*band.curve, umov::range_of(table)) <= negligible_tail;
}

/// " NAME", or where it was written.
std::string named(const IndexTable &table) {
  return table.name == "in place" ? ", written in place," : " \"" + table.name + "\"";
}

/// What could stand in a material's place: the library's of which all is known in the band.
std::string materials_that_cover(const Band &band) {
  std::vector<std::string> out;
  for (const std::string &name : material_library()) {
    const auto one = read_material(name);
    const auto knows = [&](const IndexTable *table) { return covers(*table, band); };
    if (one && !one->measured && std::ranges::all_of(tables_of(*one), knows))
      out.push_back(name);
  }
  return fmt::format(" Materials that cover it: {}.", fmt::join(out, ", "));
}

/// A band that an index does not cover: whose it is, and what would. What a table that holds its
/// ends is asked beyond them is told.
Result<void> check_bands(const Material &material, const Named &of, const std::string &key,
                         Diagnostics &diagnostics) {
  if (material.measured)
    return {};
  for (const Band &band : of.scenario.bands)
    for (const IndexTable *table : tables_of(material)) {
      const auto [first, last] = range_of(band);
      const WavelengthRange known = umov::range_of(*table);
      if (!covers(*table, band))
        return fail(ErrorCode::BadInput,
                    fmt::format("{} = \"{}\": its index{} covers {:g}-{:g} nm; band \"{}\" "
                                "needs {}. Extrapolation is off.{}",
                                key, material.name, named(*table), known.first_nm, known.last_nm,
                                band.name,
                                band.curve ? fmt::format("{:g}-{:g} nm", first, last)
                                           : fmt::format("{:g} nm", first),
                                materials_that_cover(band)),
                    of.place(key));
      if (band.curve && (first < known.first_nm || last > known.last_nm))
        diagnostics.warn(fmt::format("material \"{}\" is known at {:g}-{:g} nm; band \"{}\" "
                                     "({:g}-{:g} nm) takes the values at the ends beyond, {} % "
                                     "of its response",
                                     material.name, known.first_nm, known.last_nm, band.name, first,
                                     last, percent(tail_of(*band.curve, known))),
                         {of.scenario.file});
    }
  return {};
}

/// After the check: tables that end within a band's tail hold their ends there.
void hold_tails(Material &material, const std::vector<Band> &bands) {
  for (IndexTable *table : tables_of(material)) {
    const WavelengthRange known = umov::range_of(*table);
    for (const Band &band : bands)
      if (band.curve && tail_of(*band.curve, known) > 0)
        table->holds_ends = true;
  }
}

/// Files that the materials of an object were read from, among its inputs, each once.
Result<void> note_material_files(const Named &of, const std::vector<Material> &materials,
                                 LoadedObject &out) {
  std::vector<std::string> files;
  for (const auto &[group, sides] : of.object.materials)
    for (const std::string &name : {sides.front, sides.back})
      if (scenario::is_material_file(name, of.scenario))
        files.push_back(scenario::material_file(name, of.scenario));
  for (const Material &material : materials) {
    files.push_back(material.index.file);
    for (const Layer &layer : material.layers)
      files.push_back(layer.index.file);
    files.push_back(material.distribution.file);
    files.push_back(material.measured_file);
  }
  for (const std::string &file : files) {
    const auto is_same = [&](const InputFile &input) { return input.path == file; };
    if (!file.empty() && std::ranges::none_of(out.inputs, is_same))
      UMOV_TRY(read_input(file, {of.scenario.file}, out));
  }
  return {};
}

/// As load_object; throws Failure where it is stopped.
Result<LoadedObject> load(const Scenario &scenario, std::size_t which, const LoadOptions &options,
                          Diagnostics &diagnostics) {
  LoadedObject out;
  const Named of{scenario, scenario.objects[which], which};
  if (which == 0) {
    UMOV_TRY(load_earth(scenario, out));
    out.inputs.insert(out.inputs.end(), scenario.band_files.begin(), scenario.band_files.end());
  }
  scenario::Problems missing;
  scenario::add_missing_files(scenario, which, options.reads_shape, missing);
  UMOV_TRY(missing.told());
  UMOV_TRY(load_orbit(of, options, diagnostics, out));
  if (!options.reads_shape)
    return out;
  if (of.object.mesh.file.empty())
    return fail(ErrorCode::BadInput, "[object] has no \"mesh\" (shape). Add it.", of.place("mesh"));
  UMOV_ASSIGN(read, load_mesh(of, options.cancel, diagnostics, out));
  UMOV_TRY(check_material_keys(of, read.mesh));
  UMOV_TRY(load_attitude(of, read.mesh, options, diagnostics, out));
  const std::vector<Joint> joints = joints_of(of.object.parts);
  if (auto checked = check_joints(joints, read.mesh); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, of.place("part"));
  read.mesh = with_joined_groups(read.mesh, joint_of_groups(read.mesh, joints));
  const MeshReport report = inspect(read.mesh, false, options.cancel);
  if (report.inward_parts > 0)
    diagnostics.warn(fmt::format("the faces of {} look inward: what is seen of them is their back. "
                                 "Turn them round where that is not meant",
                                 counted(report.inward_parts, "closed part")),
                     {of.object.mesh.file.string()});
  std::vector<Material> front, back;
  for (std::size_t i = 0; i < read.mesh.groups.size(); ++i) {
    UMOV_ASSIGN(names, names_of(of, read.mesh, report, i));
    UMOV_ASSIGN(one, scenario::find_material(names.front, scenario));
    UMOV_ASSIGN(other, scenario::find_material(names.back, scenario));
    front.push_back(one);
    back.push_back(other);
  }
  std::vector<Material> checked; // each once: it may be told of
  for (std::size_t i = 0; i < front.size(); ++i)
    for (const Material *material : {&front[i], &back[i]})
      if (std::find(checked.begin(), checked.end(), *material) == checked.end()) {
        UMOV_TRY(check_bands(*material, of, of.material_key(read.mesh.groups[i]), diagnostics));
        checked.push_back(*material);
      }
  for (auto *side : {&front, &back})
    for (Material &material : *side)
      hold_tails(material, scenario.bands);
  UMOV_TRY(note_material_files(of, checked, out));
  auto scene = make_scene(read.mesh, of.object.mesh.normals, scenario.bands, front, back,
                          diagnostics, of.object.mesh.crease_deg * pi / 180,
                          of.object.mesh.file.string(), options.cancel);
  if (!scene)
    return fail(scene.error().code, scene.error().message,
                scene.error().where.file.empty() ? Where{scenario.file} : scene.error().where);
  out.scene = std::move(*scene);
  for (const auto *side : {&out.scene.front, &out.scene.back})
    for (const Surface &surface : *side) {
      if (surface.has_mirror() && !scenario.has_solar_disk && options.source_is_sun)
        return fail(
            ErrorCode::BadInput,
            fmt::format("material \"{}\" is a mirror and would show a point Sun as nothing or "
                        "infinitely bright; take [render] sun = \"disk\"",
                        surface.material().name),
            {scenario.file});
      for (const std::string &remark : surface.material().remarks)
        diagnostics.warn("material \"" + surface.material().name + "\": " + remark,
                         {surface.material().measured_file});
    }
  return out;
}

} // namespace

void scenario::add_missing_files(const Scenario &scenario, std::size_t which, bool with_shape,
                                 Problems &problems) {
  const Named of{scenario, scenario.objects[which], which};
  const auto add = [&](const std::filesystem::path &file, const char *key) {
    std::error_code code;
    if (file.empty() || std::filesystem::exists(file, code))
      return;
    if (const auto text = read_file(file); !text)
      problems.add(named(text.error(), of.place(key)));
  };
  if (of.object.orbit && !of.object.orbit->state)
    add(of.object.orbit->file, "orbit");
  if (!with_shape)
    return;
  add(of.object.mesh.file, "mesh");
  add(attitude_file(of.object.attitude), "attitude");
}

Result<LoadedObject> load_object(const Scenario &scenario, std::size_t which,
                                 const LoadOptions &options, Diagnostics &diagnostics) {
  return without_failures([&] { return load(scenario, which, options, diagnostics); });
}

} // namespace umov
