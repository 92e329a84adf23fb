#include "lightcurve/engine/compile.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace umov {
namespace {

/// Appends what is summed for one slot and what colours it.
void add_slot(const Scene &scene, std::uint32_t slot, CompiledScene &out,
              std::vector<const Surface *> &surfaces, std::size_t &columns) {
  const Surface &surface = surface_of_slot(scene, slot);
  backend::SlotTerms terms;
  SlotLight light;
  light.slot = slot;
  light.surface = &surface;
  light.column = columns;
  columns += surface.band_count();
  surfaces.push_back(&surface);
  auto fit = fit_surface(surface);
  terms.is_general = !fit.has_value();
  if (fit) {
    terms.lobe_first = static_cast<std::uint32_t>(out.data.lobes.size());
    terms.lobe_count = static_cast<std::uint32_t>(fit->lobes.size());
    terms.profile_first = static_cast<std::uint32_t>(out.data.profiles.size());
    terms.profile_count = static_cast<std::uint32_t>(fit->profiles.size());
    terms.product_first = static_cast<std::uint32_t>(out.data.products.size());
    terms.product_count = static_cast<std::uint32_t>(fit->products.size());
    light.is_grey = fit->lobes.size() <= 1;
    light.products = std::move(fit->light);
    light.diffuse_error = fit->diffuse_error;
    const auto append = [](auto &to, const auto &from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(out.data.lobes, fit->lobes);
    append(out.widths, fit->widths);
    append(out.data.profiles, fit->profiles);
    append(out.data.products, fit->products);
  }
  out.data.slots.push_back(terms);
  out.slots.push_back(std::move(light));
}

} // namespace

CompiledScene compile_scene(const Scene &scene, const FacetClasses &classes, const GroupPlan &plan,
                            double cluster_rad) {
  CompiledScene out;
  out.area_m2 = 0;
  for (const FacetClass &c : classes.list)
    out.area_m2 += c.area_m2;
  if (!(out.area_m2 > 0))
    out.area_m2 = 1;
  std::map<std::uint32_t, std::uint32_t> slots; // of the scene -> compiled
  std::vector<const Surface *> surfaces;
  std::size_t columns = 0;
  for (const GroupPlan::Group &group : plan.groups) {
    const auto [it, is_new] =
        slots.emplace(group.slot, static_cast<std::uint32_t>(out.data.slots.size()));
    if (is_new)
      add_slot(scene, group.slot, out, surfaces, columns);
    const backend::SlotTerms &terms = out.data.slots[it->second];
    // A Gaussian lobe with unlike normals is off by m spread^2 / 2 of its value at the peak.
    double narrowest = 1;
    for (std::size_t k = 0; k < terms.lobe_count; ++k)
      narrowest = std::min(narrowest, out.widths[terms.lobe_first + k]);
    backend::FacetGroup<double> facets;
    backend::LaneNumbers<double> error;
    for (std::size_t lane = 0; lane < backend::lanes; ++lane) {
      // Lanes without a class repeat the first one's normal, so that they never keep a group alive.
      const std::uint32_t of =
          group.member[lane] == no_index ? group.member[0] : group.member[lane];
      const FacetClass &c = classes.list[of];
      facets.nx[lane] = c.normal.x;
      facets.ny[lane] = c.normal.y;
      facets.nz[lane] = c.normal.z;
      facets.area[lane] = group.member[lane] == no_index ? 0 : c.area_m2 / out.area_m2;
      error.value[lane] = 0.5 * c.spread2 / std::max(narrowest * narrowest, 1e-12);
      if (terms.is_general && group.member[lane] != no_index)
        ++out.general_classes;
    }
    const auto index = static_cast<std::uint32_t>(out.data.groups.size());
    out.data.groups.push_back(facets);
    if (cluster_rad > 0)
      out.data.cluster_error.push_back(error);
    if (out.data.chunks.empty() || out.data.chunks.back().slot != it->second ||
        out.data.chunks.back().count == backend::groups_per_chunk)
      out.data.chunks.push_back({index, 0, it->second});
    ++out.data.chunks.back().count;
  }
  out.fresnel = FresnelTable(std::move(surfaces));
  return out;
}

backend::SceneData<float> round_scene(const backend::SceneData<double> &from) {
  const auto f = [](double x) { return static_cast<float>(x); };
  backend::SceneData<float> out;
  out.chunks = from.chunks;
  out.slots = from.slots;
  out.products = from.products;
  out.groups.resize(from.groups.size());
  for (std::size_t g = 0; g < from.groups.size(); ++g)
    for (std::size_t lane = 0; lane < backend::lanes; ++lane) {
      out.groups[g].nx[lane] = f(from.groups[g].nx[lane]);
      out.groups[g].ny[lane] = f(from.groups[g].ny[lane]);
      out.groups[g].nz[lane] = f(from.groups[g].nz[lane]);
      out.groups[g].area[lane] = f(from.groups[g].area[lane]);
    }
  for (const auto &error : from.cluster_error) {
    auto &to = out.cluster_error.emplace_back();
    std::transform(std::begin(error.value), std::end(error.value), to.value, f);
  }
  for (const auto &lobe : from.lobes) {
    auto &to = out.lobes.emplace_back();
    to.kind = lobe.kind;
    to.joint = lobe.joint;
    to.shape = f(lobe.shape);
    to.peak = f(lobe.peak);
    to.per_width2 = f(lobe.per_width2);
    std::transform(std::begin(lobe.masking), std::end(lobe.masking), to.masking, f);
    to.masking_limit = f(lobe.masking_limit);
    to.masking_scale = f(lobe.masking_scale);
  }
  for (const auto &profile : from.profiles) {
    auto &to = out.profiles.emplace_back();
    std::transform(std::begin(profile.c), std::end(profile.c), to.c, f);
    to.degree = profile.degree;
    to.bend = f(profile.bend);
  }
  return out;
}

} // namespace umov
