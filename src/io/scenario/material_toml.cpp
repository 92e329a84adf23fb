#include "io/scenario/parts.h"

#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>

namespace umov::scenario {

std::string list_toml(const std::vector<double> &values) {
  std::string out;
  for (const double v : values)
    out += (out.empty() ? "" : ", ") + shortest(v);
  return "[" + out + "]";
}

namespace {

/// By name where it is compiled in, by file where it was read from one, else in place.
std::string index_toml(const IndexTable &table) {
  if (table.file.empty())
    if (const auto known = find_index(table.name); known && *known == table)
      return quoted(table.name);
  if (!table.file.empty())
    return fmt::format("{{ file = {} }}",
                       quoted(tidy_path(std::filesystem::absolute(table.file)).string()));
  const auto &n = std::get<Tabulated>(table.n);
  if (n.wavelength_nm.empty())
    return fmt::format("{{ n = {}, k = {} }}", shortest(n.value[0]), shortest(table.k.value[0]));
  return fmt::format("{{ wavelength_nm = {}, n = {}, k = {} }}", list_toml(n.wavelength_nm),
                     list_toml(n.value), list_toml(table.k.value));
}

std::string layers_toml(const std::vector<Layer> &layers) {
  std::string out;
  for (const Layer &layer : layers)
    out +=
        fmt::format("{}{{ index = {}, thickness_nm = {}, coherent = {} }}", out.empty() ? "" : ", ",
                    index_toml(layer.index), shortest(layer.thickness_nm), layer.is_coherent);
  return "layers = [" + out + "]\n";
}

std::string distribution_toml(const DistributionChoice &choice) {
  std::string out = "distribution = { model = " + quoted(choice.model);
  for (const auto &[name, value] : choice.parameters)
    out += ", " + name + " = " + shortest(value);
  if (!choice.file.empty())
    out += ", file = " + quoted(tidy_path(std::filesystem::absolute(choice.file)).string());
  return out + " }\n";
}

std::string apparent_toml(const ApparentRoughness &a) {
  std::string out =
      fmt::format("apparent_roughness = {{ reference_nm = {}", shortest(a.reference_nm));
  if (a.hurst)
    out += ", hurst = " + shortest(*a.hurst);
  if (a.rms_height_nm)
    out += ", rms_height_nm = " + shortest(*a.rms_height_nm);
  return out + " }\n";
}

std::string haze_toml(const Haze &haze) {
  std::string out =
      fmt::format("haze = {{ {} = {}", haze.is_white ? "albedo" : "share", shortest(haze.share));
  if (!haze.is_white)
    out += fmt::format(", polarized = {}", haze.is_polarized);
  if (haze.high > 0)
    out += fmt::format(", range = {}", list_toml({haze.low, haze.high}));
  return out + " }\n";
}

std::string texts_toml(const Material &m) {
  std::string out;
  for (const auto &[key, text] :
       {std::pair{"description", &m.description}, {"source", &m.source}, {"assumed", &m.assumed}})
    if (!text->empty())
      out += fmt::format("{} = {}\n", key, quoted(*text));
  return out;
}

} // namespace

std::string material_toml(const Material &m) {
  std::string out = fmt::format("[material.{}]\n", quoted(m.name)) + texts_toml(m);
  if (m.measured)
    return out +
           fmt::format("table = {}\naccept = true\n",
                       quoted(tidy_path(std::filesystem::absolute(m.measured_file)).string()));
  out += "index = " + index_toml(m.index) + "\n";
  if (!m.layers.empty())
    out += layers_toml(m.layers);
  out += distribution_toml(m.distribution);
  if (m.direction)
    out += "direction = " + axis_toml(*m.direction) + "\n";
  out += fmt::format("shadowing = \"{}\"\ninterreflection = \"{}\"\n",
                     shadowing_names[static_cast<std::size_t>(m.shadowing)],
                     interreflection_names[static_cast<std::size_t>(m.interreflection)]);
  if (m.apparent_roughness)
    out += apparent_toml(*m.apparent_roughness);
  if (m.haze)
    out += haze_toml(*m.haze);
  if (!m.body)
    return out;
  const Tabulated &r = m.body->reflectance;
  const std::string reflectance = r.wavelength_nm.empty()
                                      ? shortest(r.value[0])
                                      : fmt::format("{{ wavelength_nm = {}, reflectance = {} }}",
                                                    list_toml(r.wavelength_nm), list_toml(r.value));
  return out + fmt::format("body = {{ reflectance = {}, polarized = {} }}\n", reflectance,
                           m.body->is_polarized);
}

} // namespace umov::scenario

namespace umov {

std::string material_as_toml(const Material &material) { return scenario::material_toml(material); }

} // namespace umov
