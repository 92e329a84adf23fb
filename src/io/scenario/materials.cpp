#include "io/scenario/parts.h"

#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov::scenario {
namespace {

const std::vector<std::string> shadowing_names{"ashikhmin", "smith", "smith_directional",
                                               "separable"};

Result<IndexTable> read_index(const Node &node) {
  UMOV_TRY(node.require("index"));
  if (node.get("index")->is_string()) {
    auto found = builtin_index(node.text("index", ""));
    if (!found)
      return fail(ErrorCode::BadInput, found.error().message, node.where("index"));
    return *found;
  }
  UMOV_ASSIGN(below, node.child("index"));
  UMOV_ASSIGN(n, below.numbers("n"));
  std::vector<double> k(n.size(), 0.0);
  if (below.has("k")) {
    UMOV_ASSIGN(given, below.numbers("k"));
    k = given;
  }
  IndexTable table;
  table.name = "in place";
  if (below.has("wavelength_nm")) {
    UMOV_ASSIGN(nm, below.numbers("wavelength_nm"));
    table.wavelength_nm = nm;
  }
  if (k.size() != n.size())
    return fail(
        ErrorCode::BadInput,
        fmt::format("n has {} numbers and k {}; as many of both were expected", n.size(), k.size()),
        below.where("k"));
  for (std::size_t i = 0; i < n.size(); ++i)
    table.eta.emplace_back(n[i], k[i]);
  return table;
}

Result<BodyLobe> read_body(const Node &node) {
  UMOV_ASSIGN(below, node.child("body"));
  UMOV_TRY(below.require("reflectance"));
  if (below.boolean("polarized", false))
    return fail(ErrorCode::BadInput, "polarized = true is not built yet; this version has false",
                below.where("polarized"));
  BodyLobe body;
  if (!below.get("reflectance")->is_table()) {
    UMOV_ASSIGN(one, below.numbers("reflectance"));
    body.reflectance = one;
    return body;
  }
  UMOV_ASSIGN(table, below.child("reflectance"));
  UMOV_ASSIGN(nm, table.numbers("wavelength_nm"));
  UMOV_ASSIGN(values, table.numbers("reflectance"));
  body.wavelength_nm = nm;
  body.reflectance = values;
  return body;
}

std::string list_toml(const std::vector<double> &values) {
  std::string out;
  for (const double v : values)
    out += (out.empty() ? "" : ", ") + shortest(v);
  return "[" + out + "]";
}

} // namespace

Result<Material> read_material_table(const Node &node, const std::string &name) {
  Material out;
  out.name = name;
  UMOV_ASSIGN(index, read_index(node));
  out.index = index;
  UMOV_ASSIGN(distribution, node.child("distribution"));
  UMOV_TRY(distribution.require("model"));
  UMOV_TRY(distribution.choice("model", "", {"blinn_phong"},
                               {"beckmann", "ggx", "ashikhmin_shirley", "table", "mirror"}));
  UMOV_TRY(distribution.require("m"));
  out.exponent = distribution.number("m", 0);
  UMOV_ASSIGN(shadowing, node.choice("shadowing", "ashikhmin", shadowing_names));
  for (std::size_t i = 0; i < shadowing_names.size(); ++i)
    if (shadowing == shadowing_names[i])
      out.shadowing = static_cast<Shadowing>(i);
  UMOV_TRY(node.choice("interreflection", "none", {"none"}, {"unpolarized", "single_bounce_q"}));
  if (node.has("body")) {
    UMOV_ASSIGN(body, read_body(node));
    out.body = body;
  }
  if (auto checked = umov::check(out); !checked)
    return fail(ErrorCode::BadInput, checked.error().message, node.where());
  return out;
}

Result<std::map<std::string, Material>> read_material_tables(const Node &top) {
  std::map<std::string, Material> out;
  const toml::table *all = top.table().get_as<toml::table>("material");
  if (all == nullptr)
    return out;
  for (const auto &[key, value] : *all) {
    const std::string name(key.str());
    const toml::table *table = value.as_table();
    if (table == nullptr)
      return fail(ErrorCode::BadInput, "a table [material." + name + "] was expected",
                  place_of(key.source(), top.file()));
    const Node node(*table, "material", "material." + name, top.file());
    UMOV_TRY(node.check());
    UMOV_ASSIGN(material, read_material_table(node, name));
    if (const auto built_in = builtin_material(name);
        built_in && material_toml(*built_in) != material_toml(material))
      return fail(ErrorCode::BadInput,
                  "[material." + name +
                      "] differs from the built-in material of that name; give "
                      "it a name of its own",
                  place_of(key.source(), top.file()));
    out.emplace(name, material);
  }
  return out;
}

Result<Material> find_material(const std::string &name, const Scenario &scenario) {
  if (const auto own = scenario.own_materials.find(name); own != scenario.own_materials.end())
    return own->second;
  if (name.ends_with(".toml"))
    return read_material(
        (std::filesystem::path(scenario.file).parent_path() / name).lexically_normal().string());
  auto found = builtin_material(name);
  if (found)
    return found;
  std::vector<std::string> known = builtin_material_names();
  for (const auto &[own, material] : scenario.own_materials)
    known.push_back(own);
  const auto near = nearest_name(name, known);
  return fail(ErrorCode::BadInput,
              fmt::format("unknown material \"{}\".{} Known: umov material list.", name,
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

std::string material_toml(const Material &m) {
  std::vector<double> n, k;
  for (const auto &eta : m.index.eta) {
    n.push_back(eta.real());
    k.push_back(eta.imag());
  }
  std::string out = fmt::format("[material.{}]\n", quoted(m.name));
  out += m.index.wavelength_nm.empty()
             ? fmt::format("index = {{ n = {}, k = {} }}\n", shortest(n[0]), shortest(k[0]))
             : fmt::format("index = {{ wavelength_nm = {}, n = {}, k = {} }}\n",
                           list_toml(m.index.wavelength_nm), list_toml(n), list_toml(k));
  out +=
      fmt::format("distribution = {{ model = \"blinn_phong\", m = {} }}\n", shortest(m.exponent));
  out += fmt::format("shadowing = \"{}\"\ninterreflection = \"none\"\n",
                     shadowing_names[static_cast<std::size_t>(m.shadowing)]);
  if (m.body)
    out += m.body->wavelength_nm.empty()
               ? fmt::format("body = {{ reflectance = {}, polarized = false }}\n",
                             shortest(m.body->reflectance[0]))
               : fmt::format("body = {{ reflectance = {{ wavelength_nm = {}, reflectance = {} }}, "
                             "polarized = false }}\n",
                             list_toml(m.body->wavelength_nm), list_toml(m.body->reflectance));
  return out;
}

} // namespace umov::scenario

namespace umov {

Result<Material> read_material(const std::string &name_or_path) {
  if (!name_or_path.ends_with(".toml"))
    return builtin_material(name_or_path);
  UMOV_ASSIGN(text, read_file(name_or_path));
  try {
    const toml::table document = toml::parse(text, name_or_path);
    const scenario::Node top(document, "", "", name_or_path);
    UMOV_TRY(top.check());
    UMOV_ASSIGN(all, scenario::read_material_tables(top));
    if (all.size() != 1)
      return fail(
          ErrorCode::BadInput,
          fmt::format("holds {} materials; one [material.NAME] table was expected", all.size()),
          {name_or_path});
    return all.begin()->second;
  } catch (const toml::parse_error &problem) {
    return fail(ErrorCode::BadInput, std::string(problem.description()),
                scenario::place_of(problem.source(), name_or_path));
  }
}

} // namespace umov
