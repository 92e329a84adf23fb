#include <umov/jobs/material_check.h>

#include <fmt/format.h>
#include <limits>
#include <optional>
#include <umov/core/parallel.h>
#include <umov/io/scenario.h>
#include <umov/jobs/material_tables.h>
#include <umov/surface/audit.h>

namespace umov::jobs {
namespace {

Result<std::vector<SurfaceAudit>> audits_of(const std::vector<Material> &materials,
                                            const MaterialCheckRequest &request, unsigned threads) {
  std::vector<SurfaceAudit> found(materials.size());
  std::vector<std::optional<Error>> failures(materials.size());
  parallel_for(materials.size(), threads, [&](std::size_t i) {
    const auto surface = Surface::compile(materials[i], bands_for(materials[i]));
    if (surface)
      found[i] = audit_surface(*surface, request.geometries, request.seed);
    else
      failures[i] = surface.error();
  });
  for (const auto &failure : failures)
    if (failure)
      return tl::unexpected(*failure);
  return found;
}

Table audit_table(const std::vector<std::string> &names, const std::vector<SurfaceAudit> &audits) {
  std::vector<double> reciprocity, cloude, albedo, gap, p;
  std::vector<std::string> verdict;
  for (const SurfaceAudit &a : audits) {
    reciprocity.push_back(a.reciprocity);
    cloude.push_back(a.cloude_min);
    albedo.push_back(a.albedo_max);
    gap.push_back(a.promises_energy ? a.energy_gap : std::numeric_limits<double>::quiet_NaN());
    p.push_back(a.polarization_max);
    verdict.emplace_back(a.is_fine() ? "fine" : "BAD");
  }
  Table table;
  table.add("material", "", "name", names);
  table.add("verdict", "", "reciprocity <= 1e-12, Cloude >= -1e-9, albedo <= 1 + 1e-4, energy 1e-3",
            std::move(verdict));
  table.add("reciprocity", "", "worst |M(v to l) - D M^T D| over m00", std::move(reciprocity));
  table.add("cloude_min", "", "smallest Cloude eigenvalue over m00", std::move(cloude));
  table.add("albedo_max", "", "largest directional albedo", std::move(albedo));
  table.add("energy_gap", "", "diffuse light against its promise", std::move(gap));
  table.add("p_max", "", "largest polarization of sunlight in the sample", std::move(p));
  return table;
}

} // namespace

Result<MaterialCheck> check_materials(const MaterialCheckRequest &request, unsigned threads) {
  std::vector<Material> materials;
  MaterialCheck out;
  for (const std::string &name : request.names) {
    UMOV_ASSIGN(material, read_material(name));
    for (const std::string &remark : material.remarks)
      out.remarks.push_back(fmt::format("{}: {}", name, remark));
    materials.push_back(std::move(material));
  }
  UMOV_ASSIGN(audits, audits_of(materials, request, threads));
  for (const SurfaceAudit &audit : audits)
    out.bad += audit.is_fine() ? 0u : 1u;
  out.table = audit_table(request.names, audits);
  return out;
}

} // namespace umov::jobs
