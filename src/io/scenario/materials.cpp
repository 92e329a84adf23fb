#include "io/scenario/parse_toml.h"
#include "io/scenario/parts.h"

#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>
#include <umov/io/measured_file.h>

namespace umov::scenario {
namespace {

namespace fs = std::filesystem;

/// A file that a material names, from the folder of the file that names it.
fs::path beside(const Node &node, const std::string &file) {
  return tidy_path(fs::path(node.file()).parent_path() / file);
}

/// Numbers in place: { n, k } or { wavelength_nm, n, k }.
Result<IndexTable> read_index_in_place(const Node &below) {
  UMOV_ASSIGN(n, below.numbers("n"));
  std::vector<double> k(n.size(), 0.0), nm;
  if (below.has("k")) {
    UMOV_ASSIGN(given, below.numbers("k"));
    k = given;
  }
  if (below.has("wavelength_nm")) {
    UMOV_ASSIGN(given, below.numbers("wavelength_nm"));
    nm = given;
  }
  if (k.size() != n.size())
    return fail(
        ErrorCode::BadInput,
        fmt::format("n has {} numbers and k {}; as many of both were expected", n.size(), k.size()),
        below.where("k"));
  std::vector<std::complex<double>> eta;
  for (std::size_t i = 0; i < n.size(); ++i)
    eta.emplace_back(n[i], k[i]);
  return tabulated_index("in place", nm, eta);
}

Result<IndexTable> read_index(const Node &node) {
  UMOV_TRY(node.require("index"));
  if (node.get("index")->is_string()) {
    const std::string name = node.text("index", "");
    if (is_index_file_name(name))
      return named_in(read_index_file(beside(node, name)), node.where("index"));
    auto found = find_index(name);
    if (!found)
      return fail(ErrorCode::BadInput, found.error().message, node.where("index"));
    return *found;
  }
  UMOV_ASSIGN(below, node.child("index", "material.index"));
  if (!below.has("file"))
    return read_index_in_place(below);
  for (const char *name : {"n", "k", "wavelength_nm"})
    if (below.has(name))
      return fail(ErrorCode::BadInput, fmt::format("{} has no meaning beside file", name),
                  below.where(name));
  return named_in(read_index_file(beside(node, below.text("file", ""))), below.where("file"));
}

Result<std::vector<Layer>> read_layers(const Node &node) {
  std::vector<Layer> out;
  if (!node.has("layers"))
    return out;
  const toml::array *list = node.get("layers")->as_array();
  for (const toml::node &item : *list) {
    const toml::table *table = item.as_table();
    if (table == nullptr)
      return no_table("layers", item, "tables such as { index = \"SiO2\", thickness_nm = 100 }",
                      node.where("layers"));
    const Node layer(*table, "material.layers", node.label() + ".layers", node.file());
    UMOV_TRY(layer.check());
    UMOV_TRY(layer.require("thickness_nm"));
    UMOV_ASSIGN(index, read_index(layer));
    out.push_back({index, layer.number("thickness_nm", 0), layer.boolean("coherent", true)});
  }
  return out;
}

Result<Tabulated> read_reflectance(const Node &below) {
  UMOV_TRY(below.require("reflectance"));
  if (!below.get("reflectance")->is_table()) {
    UMOV_ASSIGN(one, below.numbers("reflectance"));
    return Tabulated{{}, one};
  }
  UMOV_ASSIGN(table, below.child("reflectance"));
  UMOV_ASSIGN(nm, table.numbers("wavelength_nm"));
  UMOV_ASSIGN(values, table.numbers("reflectance"));
  return Tabulated{nm, values};
}

Result<BodyLobe> read_body(const Node &node) {
  UMOV_ASSIGN(below, node.child("body"));
  UMOV_ASSIGN(reflectance, read_reflectance(below));
  return BodyLobe{reflectance, below.boolean("polarized", false)};
}

Result<std::optional<Haze>> read_haze(const Node &node) {
  if (!node.has("haze"))
    return std::optional<Haze>{};
  UMOV_ASSIGN(below, node.child("haze"));
  if (below.has("share") == below.has("albedo"))
    return fail(ErrorCode::BadInput, "haze takes share or albedo, one of them", node.where("haze"));
  Haze out;
  out.is_white = below.has("albedo");
  out.share = below.number(out.is_white ? "albedo" : "share", 0);
  out.is_polarized = below.boolean("polarized", false);
  if (below.has("range")) {
    UMOV_ASSIGN(range, below.numbers("range"));
    if (range.size() != 2 || !(range[1] > 0))
      return fail(ErrorCode::BadInput, "range = [smallest, largest] was expected",
                  below.where("range"));
    out.low = range[0];
    out.high = range[1];
  }
  return std::optional(out);
}

Result<DistributionChoice> read_distribution(const Node &node) {
  UMOV_ASSIGN(below, node.child("distribution"));
  UMOV_TRY(below.require("model"));
  DistributionChoice out{below.text("model", ""), {}, {}, {}, {}};
  for (const auto &[key, value] : below.table())
    if (value.is_number())
      out.parameters[std::string(key.str())] = below.number(std::string(key.str()).c_str(), 0);
  if (below.has("file")) {
    const fs::path path = beside(node, below.text("file", ""));
    UMOV_ASSIGN(normals, named_in(read_normals_file(path), below.where("file")));
    out.angle_deg = normals.angle_deg;
    out.density = normals.density;
    out.file = path.string();
  }
  if (const auto made = make_distribution(out); !made)
    return fail(ErrorCode::BadInput, made.error().message, node.where("distribution"));
  return out;
}

Result<std::optional<ApparentRoughness>> read_apparent_roughness(const Node &node) {
  if (!node.has("apparent_roughness"))
    return std::optional<ApparentRoughness>{};
  UMOV_ASSIGN(below, node.child("apparent_roughness"));
  ApparentRoughness out;
  if (below.has("hurst"))
    out.hurst = below.number("hurst", 1);
  if (below.has("rms_height_nm"))
    out.rms_height_nm = below.number("rms_height_nm", 0);
  out.reference_nm = below.number("reference_nm", 550);
  return std::optional(out);
}

Result<Material> read_measured(const Node &node, Material out) {
  Problems problems;
  for (const char *name : {"index", "layers", "distribution", "shadowing", "body", "haze",
                           "interreflection", "apparent_roughness", "direction"})
    if (node.has(name))
      problems.add({ErrorCode::BadInput,
                    fmt::format("{} has no meaning beside a measured table; leave it out", name),
                    node.where(name)});
  const fs::path path = beside(node, node.text("table", ""));
  MeasuredBrdf measured =
      problems.taken(named_in(read_measured_file(path, node.boolean("accept", false), out.remarks),
                              node.where("table")),
                     MeasuredBrdf{});
  UMOV_TRY(problems.told());
  out.measured = std::make_shared<MeasuredBrdf>(std::move(measured));
  out.measured_file = path.string();
  return out;
}

Result<void> read_scattering(const Node &node, Material &out) {
  Problems problems;
  out.index = problems.taken(read_index(node), IndexTable{});
  out.layers = problems.taken(read_layers(node), std::vector<Layer>{});
  out.distribution = problems.taken(read_distribution(node), DistributionChoice{});
  out.apparent_roughness =
      problems.taken(read_apparent_roughness(node), std::optional<ApparentRoughness>{});
  if (node.has("direction") && node.text("direction", "") != "uv")
    out.direction = problems.taken(read_axis(node, "direction", {1, 0, 0}), Vec3<Body>{});
  const std::string shadowing =
      problems.taken(node.choice("shadowing", "ashikhmin", shadowing_names), std::string());
  const std::string between =
      problems.taken(node.choice("interreflection", "none", interreflection_names), std::string());
  for (std::size_t i = 0; i < shadowing_names.size(); ++i)
    if (shadowing == shadowing_names[i])
      out.shadowing = static_cast<Shadowing>(i);
  for (std::size_t i = 0; i < interreflection_names.size(); ++i)
    if (between == interreflection_names[i])
      out.interreflection = static_cast<Interreflection>(i);
  if (node.has("body"))
    out.body = problems.taken(read_body(node), BodyLobe{});
  out.haze = problems.taken(read_haze(node), std::optional<Haze>{});
  return problems.told();
}

} // namespace

Result<Material> read_material_table(const Node &node, const std::string &name) {
  Material out;
  out.name = name;
  out.description = node.text("description", "");
  out.source = node.text("source", "");
  out.assumed = node.text("assumed", "");
  if (node.has("table"))
    return read_measured(node, out);
  UMOV_TRY(read_scattering(node, out));
  if (auto checked = check_material(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, node.where());
  return out;
}

std::map<std::string, Material> read_material_tables(const Node &top, Problems &problems) {
  std::map<std::string, Material> out;
  const toml::table *all = top.table().get_as<toml::table>("material");
  if (all == nullptr)
    return out;
  for (const auto &[key, value] : *all) {
    const std::string name(key.str());
    Material material;
    if (const toml::table *table = value.as_table()) {
      const Node node(*table, "material", "material." + name, top.file());
      if (problems.went(node.check()))
        material = problems.taken(read_material_table(node, name), std::move(material));
    } else {
      problems.add({ErrorCode::BadInput,
                    fmt::format("material.{0} is {1}; a table [material.{0}] was expected", name,
                                described(value)),
                    place_of(key.source(), top.file())});
    }
    out.emplace(name, std::move(material));
  }
  return out;
}

Result<void> check_own_names(const Node &top, const std::map<std::string, Material> &own) {
  for (const auto &[name, material] : own)
    if (const auto known = builtin_material(name);
        known && material_toml(*known) != material_toml(material))
      return fail(ErrorCode::BadInput,
                  "[material." + name +
                      "] differs from the paper's material of that name; give it "
                      "a name of its own",
                  top.where("material"));
  return {};
}

Result<Material> read_material_text(const std::string &text, const std::string &file) {
  UMOV_ASSIGN(document, scenario::parse_toml(text, file));
  const Node top(document, "", "", file);
  UMOV_TRY(top.check());
  Problems problems;
  const auto all = read_material_tables(top, problems);
  UMOV_TRY(problems.told());
  if (all.size() != 1)
    return fail(
        ErrorCode::BadInput,
        fmt::format("holds {} materials; one [material.NAME] table was expected", all.size()),
        {file});
  return all.begin()->second;
}

bool is_material_file(const std::string &name, const Scenario &scenario) {
  return name.ends_with(".toml") && !scenario.own_materials.contains(name);
}

std::string material_file(const std::string &name, const Scenario &scenario) {
  return tidy_path(fs::path(scenario.file).parent_path() / name).string();
}

Result<Material> find_material(const std::string &name, const Scenario &scenario) {
  if (const auto own = scenario.own_materials.find(name); own != scenario.own_materials.end())
    return own->second;
  if (is_material_file(name, scenario))
    return read_material(material_file(name, scenario));
  auto found = library_material(name);
  if (found)
    return found;
  std::vector<std::string> known = material_library();
  for (const auto &[own, material] : scenario.own_materials)
    known.push_back(own);
  const auto near = nearest_name(name, known);
  return fail(ErrorCode::BadInput,
              fmt::format("unknown material \"{}\".{} Known: umov material list.", name,
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

} // namespace umov::scenario
