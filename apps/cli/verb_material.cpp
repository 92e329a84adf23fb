#include "verb_material.h"
#include "console.h"
#include "tables.h"
#include "verbs.h"

#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>
#include <umov/io/measured_file.h>
#include <umov/io/scenario.h>
#include <umov/surface/audit.h>
#include <umov/surface/distribution.h>

namespace umov::cli {
namespace {

std::string range_text(WavelengthRange range) {
  return range.last_nm > 1e7 ? "any" : fmt::format("{:.0f}-{:.0f}", range.first_nm, range.last_nm);
}

std::string lobe_text(const Material &m) {
  if (m.measured)
    return "measured";
  std::string out = m.distribution.model;
  for (const auto &[name, value] : m.distribution.parameters)
    out += fmt::format(" {}={}", name, shortest(value));
  return out;
}

Result<void> list_materials(const Common &common) {
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
  return put_table("", table, common);
}

Result<void> list_models(const Common &common) {
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
  return put_table("", table, common);
}

/// Wavelengths of the paper where the material has them, else the middle of its range.
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

Result<void> show(const std::string &name) {
  UMOV_ASSIGN(material, read_material(name));
  const auto bands = bands_for(material);
  UMOV_ASSIGN(surface, Surface::compile(material, bands));
  fmt::print("{}\n", material_as_toml(material));
  fmt::print("wavelengths   {} nm\npolarization  {}\n", range_text(range_of(material)),
             describe_polarization(material));
  for (const std::string &remark : material.remarks)
    fmt::print("remark        {}\n", remark);
  fmt::print("\n{:>8}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}\n", "band", "n", "k", "R(0)", "albedo 0",
             "albedo 60");
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const Vec3<Facet> up{0, 0, 1}, aslant{std::sqrt(0.75), 0, 0.5};
    const auto eta = surface.interface(b).substrate();
    fmt::print("{:>8}  {:>9.5f}  {:>9.5f}  {:>9.5f}  {:>9.5f}  {:>9.5f}\n", bands[b].name,
               eta.real(), eta.imag(), surface.interface(b).reflection(1).a, surface.albedo(b, up),
               surface.albedo(b, aslant));
  }
  return {};
}

struct IndexOptions {
  std::string name, output;
  std::vector<double> wavelengths;
};

Result<void> print_index(const IndexOptions &o, const Common &common) {
  Table table;
  if (o.name.empty()) {
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
    return put_table(o.output, table, common);
  }
  const bool is_file = o.name.ends_with(".yml") || o.name.ends_with(".yaml");
  UMOV_ASSIGN(index, is_file ? read_index_file(o.name) : find_index(o.name));
  std::vector<double> n, k;
  for (const double nm : o.wavelengths) {
    auto eta = index_at(index, Wavelength::nm(nm));
    if (!eta) {
      const auto others = indices_covering(index.name, Wavelength::nm(nm));
      return fail(ErrorCode::BadInput,
                  eta.error().message +
                      fmt::format(" Tables that cover it: {}.", fmt::join(others, ", ")));
    }
    n.push_back(eta->real());
    k.push_back(eta->imag());
  }
  table.add("wavelength_nm", "nm", "wavelength in vacuum", o.wavelengths);
  table.add("n", "", "real part of the index", std::move(n));
  table.add("k", "",
            index.has_k ? "imaginary part, > 0 absorbs"
                        : "none in the source: transparent or unknown",
            std::move(k));
  table.note("reference", index.reference);
  return put_table(o.output, table, common);
}

struct CheckOptions {
  std::vector<std::string> names;
  bool all = false;
  std::uint64_t geometries = 10'000, seed = 0;
  std::string output;
};

Result<void> check_materials(const CheckOptions &o, const Common &common) {
  UMOV_TRY(check_output(o.output));
  const std::vector<std::string> names = o.all ? material_library() : o.names;
  if (names.empty())
    return fail(ErrorCode::Usage, "name a material, or pass --all");
  std::vector<Material> materials;
  for (const std::string &name : names) {
    UMOV_ASSIGN(material, read_material(name));
    materials.push_back(material);
  }
  std::vector<SurfaceAudit> found(names.size());
  std::vector<std::optional<Error>> failures(names.size());
  parallel_for(names.size(), static_cast<unsigned>(common.threads), [&](std::size_t i) {
    const auto surface = Surface::compile(materials[i], bands_for(materials[i]));
    if (surface)
      found[i] = audit_surface(*surface, o.geometries, o.seed);
    else
      failures[i] = surface.error();
  });
  for (const auto &failure : failures)
    if (failure)
      return tl::unexpected(*failure);
  Table table;
  std::vector<double> reciprocity, cloude, albedo, gap, p;
  std::vector<std::string> verdict;
  std::size_t bad = 0;
  for (const SurfaceAudit &a : found) {
    reciprocity.push_back(a.reciprocity);
    cloude.push_back(a.cloude_min);
    albedo.push_back(a.albedo_max);
    gap.push_back(a.promises_energy ? a.energy_gap : std::numeric_limits<double>::quiet_NaN());
    p.push_back(a.polarization_max);
    verdict.emplace_back(a.is_fine() ? "fine" : "BAD");
    bad += a.is_fine() ? 0u : 1u;
  }
  table.add("material", "", "name", names);
  table.add("verdict", "", "reciprocity <= 1e-12, Cloude >= -1e-9, albedo <= 1 + 1e-4, energy 1e-3",
            std::move(verdict));
  table.add("reciprocity", "", "worst |M(v to l) - D M^T D| over m00", std::move(reciprocity));
  table.add("cloude_min", "", "smallest Cloude eigenvalue over m00", std::move(cloude));
  table.add("albedo_max", "", "largest directional albedo", std::move(albedo));
  table.add("energy_gap", "", "diffuse light against its promise", std::move(gap));
  table.add("p_max", "", "largest polarization of sunlight in the sample", std::move(p));
  UMOV_TRY(put_table(o.output, table, common));
  if (bad > 0)
    return fail(ErrorCode::Physics,
                fmt::format("{} of {} not physical; see the table", bad,
                            counted(names.size(), "material is", "materials are")));
  return {};
}

struct ImportOptions {
  std::string file, name, output;
  bool accept = false;
};

/// A page of refractiveindex.info or a measured BRDF, checked, as a material file beside it.
Result<void> import_file(const ImportOptions &o) {
  namespace fs = std::filesystem;
  const fs::path source = o.file;
  const std::string name = o.name.empty() ? source.stem().string() : o.name;
  const fs::path target =
      o.output.empty() ? source.parent_path() / (name + ".toml") : fs::path(o.output);
  const std::string beside =
      fs::proximate(source, target.has_parent_path() ? target.parent_path() : ".").string();
  std::string text;
  if (source.extension() == ".csv") {
    std::vector<std::string> remarks;
    UMOV_ASSIGN(measured, read_measured_file(source, o.accept, remarks));
    text = fmt::format("[material.\"{}\"]\ndescription = \"measured, {}\"\ntable = \"{}\"\n{}",
                       name, measured.has_polarization() ? "Mueller" : "brightness only", beside,
                       o.accept ? "accept = true\n" : "");
    for (const std::string &remark : remarks)
      fmt::print(stderr, "remark: {}\n", remark);
  } else {
    UMOV_ASSIGN(index, read_index_file(source));
    text =
        fmt::format("[material.\"{}\"]\nsource = \"{}\"\nassumed = \"roughness\"\n"
                    "index = {{ file = \"{}\" }}\ndistribution = {{ model = \"beckmann\", alpha = "
                    "0.1 }}\n",
                    name, index.reference, beside);
  }
  if (std::error_code code; fs::exists(target, code))
    return fail(ErrorCode::Device, "stands there already; name another file with -o",
                {target.string()});
  UMOV_TRY(write_file_atomically(target, text));
  fmt::print("written to {}; umov material show {}\n", target.string(), target.string());
  return {};
}

template <class F> auto finishing(const Exit &exit_with, F run) {
  return [exit_with, run] {
    const Result<void> done = run();
    exit_with(done ? 0 : report(done.error()));
  };
}

void add_check(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand(
      "check", "Reciprocity, realisability and energy of materials; or an explicit rough surface");
  auto o = std::make_shared<CheckOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("material", o->names, "Names or TOML files");
  verb->add_flag("--all", o->all, "Every material of the library");
  verb->add_option("--geometries", o->geometries, "Random geometries per band")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  verb->add_option("--seed", o->seed, "Of the geometries")->capture_default_str();
  verb->add_option("-o,--output", o->output, "Table: .csv, .ecsv or .json by its suffix");
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  auto explicit_surface = add_explicit_options(*verb);
  verb->callback(finishing(exit_with, [o, common, explicit_surface] {
    return explicit_surface->is_wanted ? check_explicit(*explicit_surface, o->output, *common)
                                       : check_materials(*o, *common);
  }));
}

void add_index(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand("index", "n and k of a table; without a name, all tables");
  auto o = std::make_shared<IndexOptions>();
  auto common = std::make_shared<Common>();
  auto *name = verb->add_option("index", o->name, "Name, or a page of refractiveindex.info (.yml)");
  auto *nm = verb->add_option("--wavelength", o->wavelengths, "[nm], separated by commas")
                 ->delimiter(',')
                 ->check(CLI::Range(1.0, 1e7));
  nm->needs(name);
  verb->add_option("-o,--output", o->output, "Table: .csv, .ecsv or .json by its suffix");
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, [o, common, nm]() -> Result<void> {
    if (!o->name.empty() && nm->count() == 0)
      return fail(ErrorCode::Usage, "--wavelength says at which wavelengths");
    return print_index(*o, *common);
  }));
}

} // namespace

void add_material(CLI::App &app, const Exit &exit_with) {
  auto *material = app.add_subcommand("material", "Materials that umov knows");
  material->require_subcommand(1);
  auto *list = material->add_subcommand("list", "Materials, and whether and how they polarize");
  auto common = std::make_shared<Common>();
  auto models = std::make_shared<bool>(false);
  list->add_flag("--models", *models, "Distributions of normals and their numbers instead");
  add_common(*list, *common, true);
  list->callback(finishing(exit_with, [common, models] {
    return *models ? list_models(*common) : list_materials(*common);
  }));
  auto *shown = material->add_subcommand("show", "Everything about one material");
  auto name = std::make_shared<std::string>();
  shown->add_option("material", *name, "Name or TOML file")->required();
  shown->callback(finishing(exit_with, [name] { return show(*name); }));
  add_index(*material, exit_with);
  add_check(*material, exit_with);
  add_plot(*material, exit_with);
  auto *import = material->add_subcommand(
      "import",
      "Check a page of refractiveindex.info (.yml) or a measured BRDF (.csv), as a material");
  auto o = std::make_shared<ImportOptions>();
  import->add_option("file", o->file, "Input")->required();
  import->add_option("--name", o->name, "Name of the material; default: that of the file");
  import->add_option("-o,--output", o->output, "TOML file; default: beside the input");
  import->add_flag("--accept", o->accept,
                   "Take a measured table that is not physical, with a warning");
  import->callback(finishing(exit_with, [o] { return import_file(*o);
}));
} // namespace umov::cli

} // namespace umov::cli
