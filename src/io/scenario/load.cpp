#include "io/scenario/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>
#include <umov/io/obj.h>
#include <umov/io/trajectory_file.h>
#include <umov/shape/topology.h>

namespace umov {
namespace {

Result<std::string> read_input(const std::filesystem::path &path, const Where &named_at,
                               LoadedObject &out) {
  auto text = read_file(path);
  if (!text)
    return fail(text.error().code,
                fmt::format("{} (named in {})", text.error().message,
                            to_text(named_at).substr(0, to_text(named_at).size() - 2)),
                text.error().where);
  out.inputs.push_back({path.string(), sha256_hex(*text)});
  return text;
}

Where place(const Scenario &scenario, const std::string &key) {
  const auto found = scenario.places.find(key);
  return found == scenario.places.end() ? Where{scenario.file} : found->second;
}

Result<void> load_orbit(const Scenario &scenario, const LoadOptions &options,
                        Diagnostics &diagnostics, LoadedObject &out) {
  if (!scenario.orbit)
    return {};
  const std::string file = scenario.orbit->file.string();
  UMOV_ASSIGN(text, read_input(file, place(scenario, "object.orbit"), out));
  if (!scenario.time)
    return {}; // a scene: its orbit is not asked for
  TrajectoryRequest request;
  request.norad = scenario.orbit->norad;
  request.first = scenario.time->start;
  request.last = scenario.time->stop;
  request.allow_bad_checksum = options.allow_bad_checksum;
  request.allow_old_elements = options.allow_old_elements;
  UMOV_ASSIGN(orbit, read_trajectory(text, file, request, diagnostics));
  out.orbit = orbit;
  return {};
}

/// Every key of [object.materials] must mean some material of the mesh.
Result<void> check_material_keys(const Scenario &scenario, const Mesh &mesh) {
  for (const auto &[name, sides] : scenario.materials) {
    if (name == "default" ||
        std::find(mesh.groups.begin(), mesh.groups.end(), name) != mesh.groups.end())
      continue;
    const auto near = nearest_name(name, mesh.groups);
    return fail(ErrorCode::BadInput,
                fmt::format("\"{}\" is no material of {}.{} It has {}.", name,
                            scenario.mesh.file.string(),
                            near ? fmt::format(" Did you mean \"{}\"?", *near) : "",
                            fmt::join(mesh.groups, ", ")),
                place(scenario, "object.materials." + name));
  }
  return {};
}

Result<MaterialNames> names_of(const Scenario &scenario, const Mesh &mesh, const MeshReport &report,
                               std::size_t group) {
  for (const std::string &key : {mesh.groups[group], std::string("default")})
    if (const auto found = scenario.materials.find(key); found != scenario.materials.end())
      return found->second;
  return fail(
      ErrorCode::BadInput,
      fmt::format("material \"{}\" ({} faces, {:.4g} m2) has no entry in [object.materials] "
                  "of {} and there is no \"default\". Known: umov material list.",
                  mesh.groups[group], report.group_triangles[group], report.group_area_m2[group],
                  scenario.file),
      {scenario.mesh.file.string()});
}

/// A material that the mesh uses but no MTL file defines is only a name: an error where the
/// scenario does not map every material by name.
Result<void> check_mtl(const Scenario &scenario, const ObjMesh &read) {
  if (!read.lacks_mtl)
    return {};
  for (const std::string &group : read.mesh.groups)
    if (!scenario.materials.contains(group) &&
        std::find(read.defined.begin(), read.defined.end(), group) == read.defined.end())
      return fail(ErrorCode::BadInput,
                  fmt::format("the MTL file is missing and material \"{}\" has no entry of its own "
                              "in [object.materials] of {}. Add the file or the entry.",
                              group, scenario.file),
                  {scenario.mesh.file.string()});
  return {};
}

/// A band that an index does not cover: which compiled-in tables would.
Result<void> check_bands(const Material &material, const Scenario &scenario) {
  if (material.measured)
    return {};
  std::vector<const IndexTable *> tables{&material.index};
  for (const Layer &layer : material.layers)
    tables.push_back(&layer.index);
  for (const Band &band : scenario.bands)
    for (const IndexTable *table : tables)
      if (const auto eta = index_at(*table, band.wavelength); !eta) {
        const auto others = indices_covering(table->name, band.wavelength);
        return fail(ErrorCode::BadInput,
                    fmt::format("material \"{}\", band \"{}\": {}{}", material.name, band.name,
                                eta.error().message,
                                others.empty() ? ""
                                               : fmt::format(" Tables that cover it: {}.",
                                                             fmt::join(others, ", "))),
                    {scenario.file});
      }
  return {};
}

} // namespace

Result<LoadedObject> load_object(const Scenario &scenario, const LoadOptions &options,
                                 Diagnostics &diagnostics) {
  LoadedObject out;
  UMOV_TRY(load_orbit(scenario, options, diagnostics, out));
  UMOV_TRY(read_input(scenario.mesh.file, place(scenario, "object.mesh"), out));
  UMOV_ASSIGN(read, read_obj(scenario.mesh.file,
                             {.unit = scenario.mesh.unit, .up = scenario.mesh.up}, diagnostics));
  for (const auto &file : read.files) {
    UMOV_ASSIGN(text, read_file(file));
    out.inputs.push_back({file.string(), sha256_hex(text)});
  }
  UMOV_TRY(check_mtl(scenario, read));
  UMOV_TRY(check_material_keys(scenario, read.mesh));
  const MeshReport report = inspect(read.mesh);
  std::vector<Material> front, back;
  for (std::size_t i = 0; i < read.mesh.groups.size(); ++i) {
    UMOV_ASSIGN(names, names_of(scenario, read.mesh, report, i));
    UMOV_ASSIGN(one, scenario::find_material(names.front, scenario));
    UMOV_ASSIGN(other, scenario::find_material(names.back, scenario));
    front.push_back(one);
    back.push_back(other);
  }
  for (std::size_t i = 0; i < front.size(); ++i)
    for (const Material *material : {&front[i], &back[i]})
      UMOV_TRY(check_bands(*material, scenario));
  auto scene =
      make_scene(read.mesh, scenario.mesh.normals, scenario.bands, front, back, diagnostics,
                 scenario.mesh.crease_deg * pi / 180, scenario.mesh.file.string());
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

} // namespace umov
