#include "job_console.h"
#include "tables.h"
#include "verb_material.h"

#include <fmt/format.h>
#include <umov/core/text.h>
#include <umov/io/scenario.h>

namespace umov::cli {
namespace {

struct CheckOptions {
  jobs::MaterialCheckRequest request;
  bool all = false;
  std::string output;
};

Result<void> check_materials(const CheckOptions &o, const Common &common) {
  UMOV_TRY(check_output(o.output));
  jobs::MaterialCheckRequest request = o.request;
  if (o.all)
    request.names = material_library();
  if (request.names.empty())
    return fail(ErrorCode::Usage, "name a material, or pass --all");
  UMOV_ASSIGN(found, jobs::check_materials(request, static_cast<unsigned>(common.threads)));
  UMOV_TRY(put_table(o.output, found.table, common));
  for (const std::string &remark : found.remarks)
    fmt::print(stderr, "remark: {}\n", remark);
  if (found.bad > 0)
    return fail(ErrorCode::Physics,
                fmt::format("{} of {} not physical; see the table", found.bad,
                            counted(request.names.size(), "material is", "materials are")));
  return {};
}

} // namespace

void add_check(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand(
      "check", "Reciprocity, realisability and energy of materials; or an explicit rough surface");
  auto o = std::make_shared<CheckOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("material", o->request.names, "Names or TOML files");
  verb->add_flag("--all", o->all, "Every material of the library");
  verb->add_option("--geometries", o->request.geometries, "Random geometries per band")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  verb->add_option("--seed", o->request.seed, "Of the geometries")->capture_default_str();
  add_table_output(*verb, o->output);
  add_threads(*verb, *common);
  add_common(*verb, *common, true);
  auto explicit_surface = add_explicit_options(*verb);
  verb->callback(finishing(exit_with, [o, common, explicit_surface] {
    return explicit_surface->is_wanted ? check_explicit(*explicit_surface, o->output, *common)
                                       : check_materials(*o, *common);
  }));
}

} // namespace umov::cli
