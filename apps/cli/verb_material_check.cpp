#include "tables.h"
#include "verb_material.h"

#include <fmt/format.h>
#include <limits>
#include <umov/core/parallel.h>
#include <umov/core/text.h>
#include <umov/io/scenario.h>
#include <umov/jobs/material_tables.h>
#include <umov/surface/audit.h>

namespace umov::cli {
namespace {

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
    const auto surface = Surface::compile(materials[i], jobs::bands_for(materials[i]));
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
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const std::string &remark : materials[i].remarks)
      fmt::print(stderr, "remark: {}: {}\n", names[i], remark);
  if (bad > 0)
    return fail(ErrorCode::Physics,
                fmt::format("{} of {} not physical; see the table", bad,
                            counted(names.size(), "material is", "materials are")));
  return {};
}

} // namespace

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
