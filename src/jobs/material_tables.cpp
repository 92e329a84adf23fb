#include <umov/jobs/material_tables.h>

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>
#include <umov/io/scenario.h>
#include <umov/surface/distribution.h>
#include <umov/surface/surface.h>

namespace umov::jobs {

std::string range_text(WavelengthRange range) {
  return range.last_nm > 1e7 ? "any" : fmt::format("{:.0f}-{:.0f}", range.first_nm, range.last_nm);
}

std::vector<Band> bands_for(const Material &material) {
  const WavelengthRange range = range_of(material);
  std::vector<Band> out;
  for (const double nm : {425., 550., 650.})
    if (nm >= range.first_nm && nm <= range.last_nm)
      out.push_back({fmt::format("nm:{:g}", nm), Wavelength::nm(nm)});
  if (out.empty()) {
    const double nm = 0.5 * (range.first_nm + range.last_nm);
    out.push_back({fmt::format("nm:{:g}", nm), Wavelength::nm(nm)});
  }
  return out;
}

namespace {

std::string lobe_text(const Material &m) {
  if (m.measured)
    return "measured";
  std::string out = m.distribution.model;
  for (const auto &[name, value] : m.distribution.parameters)
    out += fmt::format(" {}={}", name, shortest(value));
  return out;
}

/// What the interface and the whole surface do, band by band.
Result<Table> optics_table(const Material &material) {
  const auto bands = bands_for(material);
  UMOV_ASSIGN(surface, Surface::compile(material, bands));
  std::vector<std::string> names;
  std::array<std::vector<double>, 5> values;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const Vec3<Facet> up{0, 0, 1}, aslant{std::sqrt(0.75), 0, 0.5};
    const auto eta = surface.interface(b).substrate();
    const std::array row{eta.real(), eta.imag(), surface.interface(b).reflection(1).a,
                         surface.albedo(b, up), surface.albedo(b, aslant)};
    names.push_back(bands[b].name);
    for (std::size_t i = 0; i < row.size(); ++i)
      values[i].push_back(row[i]);
  }
  Table out;
  out.add("band", "", "as a scenario spells it", std::move(names));
  out.add("n", "", "index of the substrate", std::move(values[0]));
  out.add("k", "", "its absorption", std::move(values[1]));
  out.add("reflectance_0", "", "of the interface at normal incidence", std::move(values[2]));
  out.add("albedo_0", "", "of the surface, lit from the normal", std::move(values[3]));
  out.add("albedo_60", "", "the same, lit from 60 deg", std::move(values[4]));
  return out;
}

} // namespace

Result<Table> material_list() {
  std::vector<std::string> names, polarizes, ranges, lobes, texts;
  for (const std::string &name : material_library()) {
    UMOV_ASSIGN(material, read_material(name));
    names.push_back(name);
    polarizes.push_back(describe_polarization(material));
    ranges.push_back(range_text(range_of(material)));
    lobes.push_back(lobe_text(material));
    texts.push_back(material.description.empty() ? "Table 1 of the paper" : material.description);
  }
  Table table;
  table.add("material", "", "name", std::move(names));
  table.add("nm", "", "wavelengths that its tables cover [nm]", std::move(ranges));
  table.add("lobe", "", "distribution of microfacet normals", std::move(lobes));
  table.add("polarization", "", "what it does to sunlight", std::move(polarizes));
  table.add("what", "", "description", std::move(texts));
  return table;
}

Table model_list() {
  std::vector<std::string> models, parameters, texts;
  for (const DistributionModel *model : distribution_models()) {
    std::string numbers = model->takes_table ? "file" : "";
    for (const DistributionParameter &one : model->parameters)
      numbers += fmt::format("{}{} ({:g} to {:g})", numbers.empty() ? "" : ", ", one.name, one.low,
                             one.high);
    models.emplace_back(model->name);
    texts.emplace_back(model->text);
    parameters.push_back(numbers);
  }
  Table table;
  table.add("model", "", "name", std::move(models));
  table.add("takes", "", "its numbers", std::move(parameters));
  table.add("what", "", "description", std::move(texts));
  return table;
}

Result<Table> material_table(const Material &material) {
  UMOV_ASSIGN(table, optics_table(material));
  table.note("material", material_as_toml(material));
  table.note("wavelengths_nm", range_text(range_of(material)));
  table.note("polarization", describe_polarization(material));
  for (const std::string &remark : material.remarks)
    table.note("remark", remark);
  return table;
}

Result<Table> index_list() {
  Table table;
  std::vector<std::string> names, ranges, references;
  for (const std::string &name : index_names()) {
    UMOV_ASSIGN(index, find_index(name));
    names.push_back(name);
    ranges.push_back(range_text(range_of(index)));
    references.push_back(index.reference.substr(0, 90));
  }
  table.add("index", "", "name", std::move(names));
  table.add("nm", "", "wavelengths covered [nm]", std::move(ranges));
  table.add("reference", "", "source", std::move(references));
  return table;
}

Result<Table> index_table(const IndexTable &index, const std::vector<double> &wavelengths_nm) {
  Table table;
  std::vector<double> n, k;
  for (const double nm : wavelengths_nm) {
    auto eta = index_at(index, Wavelength::nm(nm));
    if (!eta) {
      const auto others = indices_covering(index.name, Wavelength::nm(nm));
      return fail(ErrorCode::BadInput,
                  others.empty() ? eta.error().message
                                 : eta.error().message + fmt::format(" Tables that cover it: {}.",
                                                                     fmt::join(others, ", ")));
    }
    n.push_back(eta->real());
    k.push_back(eta->imag());
  }
  table.add("wavelength_nm", "nm", "wavelength in vacuum", wavelengths_nm);
  table.add("n", "", "real part of the index", std::move(n));
  table.add("k", "",
            index.has_k ? "imaginary part, > 0 absorbs"
                        : "none in the source: transparent or unknown",
            std::move(k));
  table.note("reference", index.reference);
  return table;
}

} // namespace umov::jobs
