#include "verb_material.h"
#include "console.h"
#include "tables.h"
#include "verbs.h"

#include <fmt/format.h>
#include <umov/io/index_file.h>
#include <umov/io/scenario.h>
#include <umov/jobs/material_tables.h>

namespace umov::cli {
namespace {

Result<void> list(bool models, const std::string &output, const Common &common) {
  if (models)
    return put_table(output, jobs::model_list(), common);
  UMOV_ASSIGN(table, jobs::material_list());
  return put_table(output, table, common);
}

Result<void> show(const std::string &name, const std::string &output, const Common &common) {
  UMOV_TRY(check_output(output));
  UMOV_ASSIGN(material, read_material(name));
  UMOV_ASSIGN(table, jobs::material_table(material));
  if (common.json || !output.empty())
    return put_table(output, table, common);
  fmt::print("{}\nwavelengths   {} nm\npolarization  {}\n", material_as_toml(material),
             jobs::range_text(range_of(material)), describe_polarization(material));
  for (const std::string &remark : material.remarks)
    fmt::print("remark        {}\n", remark);
  return put("", "\n" + to_text(table));
}

struct IndexOptions {
  std::string name, output;
  std::vector<double> wavelengths;
};

Result<void> print_index(const IndexOptions &o, const Common &common) {
  if (o.name.empty()) {
    UMOV_ASSIGN(all, jobs::index_list());
    return put_table(o.output, all, common);
  }
  UMOV_ASSIGN(index, is_index_file_name(o.name) ? read_index_file(o.name) : find_index(o.name));
  UMOV_ASSIGN(table, jobs::index_table(index, o.wavelengths));
  return put_table(o.output, table, common);
}

void add_index(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand("index", "n and k of a table; without a name, all tables");
  auto o = std::make_shared<IndexOptions>();
  auto common = std::make_shared<Common>();
  auto *name = verb->add_option("index", o->name,
                                "Name, a page of refractiveindex.info (.yml), or columns "
                                "wavelength, n, k (.csv .txt .dat)");
  auto *nm = verb->add_option("--wavelength", o->wavelengths, "[nm], separated by commas")
                 ->delimiter(',')
                 ->check(CLI::Range(1.0, 1e7));
  nm->needs(name);
  add_table_output(*verb, o->output);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, [o, common, nm]() -> Result<void> {
    if (!o->name.empty() && nm->count() == 0)
      return fail(ErrorCode::Usage, "--wavelength says at which wavelengths");
    return print_index(*o, *common);
  }));
}

void add_list(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand("list", "Materials, and whether and how they polarize");
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  auto models = std::make_shared<bool>(false);
  verb->add_flag("--models", *models, "Distributions of normals and their numbers instead");
  add_table_output(*verb, *output);
  add_common(*verb, *common, true);
  verb->callback(
      finishing(exit_with, [common, output, models] { return list(*models, *output, *common); }));
}

void add_show(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand("show", "Everything about one material");
  auto common = std::make_shared<Common>();
  auto name = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  verb->add_option("material", *name, "Name or TOML file")->required();
  add_table_output(*verb, *output);
  add_common(*verb, *common, true);
  verb->callback(
      finishing(exit_with, [name, output, common] { return show(*name, *output, *common); }));
}

} // namespace

void add_material(CLI::App &app, const Exit &exit_with) {
  auto *material = app.add_subcommand("material", "Materials that umov knows");
  material->require_subcommand(1);
  add_list(*material, exit_with);
  add_show(*material, exit_with);
  add_index(*material, exit_with);
  add_check(*material, exit_with);
  add_plot(*material, exit_with);
  add_import(*material, exit_with);
}

} // namespace umov::cli
