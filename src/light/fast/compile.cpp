#include "light/fast/compile.h"

#include "kernel/disk_lobe.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <umov/core/quantity.h>

namespace umov {
namespace {

/// Appends what is summed for slots of these materials.
void add_slot(const std::vector<const Surface *> &surfaces, CompiledScene &out) {
  backend::SlotTerms terms;
  auto fit = fit_surfaces(surfaces);
  terms.is_general = !fit.has_value();
  if (fit) {
    const auto count = [](const auto &list) { return static_cast<std::uint32_t>(list.size()); };
    terms.lobe_first = count(out.data.lobes);
    terms.lobe_count = count(fit->lobes);
    terms.profile_first = count(out.data.profiles);
    terms.profile_count = count(fit->profiles);
    terms.product_first = count(out.data.products);
    terms.product_count = count(fit->products);
    const auto append = [](auto &to, const auto &from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    const auto is_polarized = [](const backend::Product &product) {
      return product.kind != backend::ProductKind::Even;
    };
    terms.is_polarized = std::any_of(fit->products.begin(), fit->products.end(), is_polarized);
    out.has_u = out.has_u || terms.is_polarized;
    append(out.data.lobes, fit->lobes);
    append(out.widths, fit->widths);
    append(out.data.profiles, fit->profiles);
    append(out.data.products, fit->products);
    for (const double slope : fit->widths) {
      constexpr double half_width = 1.5e-7; // of the difference of two rounded unit vectors, 95 %
      const double width = std::max(slope, 1e-9);
      out.rounding.push_back({8 * pi * width * width, half_width / width});
    }
    if (fit->family) {
      terms.family = count(out.data.families);
      out.data.families.push_back(*fit->family);
    }
  }
  out.data.slots.push_back(terms);
  out.slots.emplace_back();
  out.fits.push_back(std::move(fit));
}

} // namespace

Result<Colours> colours_of(const Scene &scene, const CompiledScene &sums, bool is_intensity_only,
                           double &diffuse_error) {
  std::vector<const Surface *> surfaces;
  std::vector<std::optional<SurfaceLight>> light;
  diffuse_error = 0;
  for (std::size_t s = 0; s < sums.slots.size(); ++s) {
    surfaces.push_back(&surface_of_slot(scene, sums.slots[s].front()));
    for (const std::uint32_t slot : sums.slots[s])
      if (!surface_of_slot(scene, slot).is_same(*surfaces.back()))
        return fail(
            ErrorCode::BadInput,
            fmt::format("mesh groups \"{}\" and \"{}\" have one material in these sums, but "
                        "\"{}\" and \"{}\" here; name it when the engine is made",
                        scene.mesh.groups[group_of_slot(sums.slots[s].front())],
                        scene.mesh.groups[group_of_slot(slot)], surfaces.back()->material().name,
                        surface_of_slot(scene, slot).material().name));
    light.emplace_back();
    if (!sums.fits[s])
      continue;
    UMOV_ASSIGN(one, light_in(*sums.fits[s], *surfaces.back()));
    diffuse_error = std::max(diffuse_error, one.diffuse_error);
    light.back() = std::move(one);
  }
  return Colours(std::move(surfaces), std::move(light), sums.data.slots, is_intensity_only);
}

CompiledScene compile_scene(const Scene &scene, const std::vector<Scene> &hypotheses,
                            const SharedSlots &shared, const FacetClasses &classes,
                            const GroupPlan &plan, bool tells_spread, bool is_intensity_only) {
  CompiledScene out;
  out.area_m2 = 0;
  for (const FacetClass &c : classes.list)
    out.area_m2 += c.area_m2;
  if (!(out.area_m2 > 0))
    out.area_m2 = 1;
  std::map<std::uint32_t, std::uint32_t> slots;        // of the scene -> compiled
  std::vector<std::vector<const Surface *>> materials; // as data.slots
  for (const GroupPlan::Group &group : plan.groups) {
    const auto [it, is_new] =
        slots.emplace(group.slot, static_cast<std::uint32_t>(out.data.slots.size()));
    if (is_new) {
      add_slot(surfaces_of(scene, hypotheses, group.slot), out);
      out.slots.back() = shared[group.slot];
    }
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
      out.has_u = out.has_u || terms.is_general;
    }
    const auto index = static_cast<std::uint32_t>(out.data.groups.size());
    out.data.groups.push_back(facets);
    if (tells_spread)
      out.data.cluster_error.push_back(error);
    if (out.data.chunks.empty() || out.data.chunks.back().slot != it->second ||
        out.data.chunks.back().count == backend::groups_per_chunk)
      out.data.chunks.push_back({index, 0, it->second});
    ++out.data.chunks.back().count;
  }
  out.data.cones = ConesStore<double>(out.data.groups);
  double diffuse_error = 0;
  out.colours = colours_of(scene, out, is_intensity_only, diffuse_error).value(); // made for it
  return out;
}

namespace {

void round_patches(const SceneStore<double> &from, SceneStore<float> &out) {
  const auto f = [](double x) { return static_cast<float>(x); };
  out.patches_of = from.patches_of;
  out.patches.reserve(from.patches.size());
  for (const auto &patch : from.patches) {
    auto &to = out.patches.emplace_back();
    std::transform(std::begin(patch.corner), std::end(patch.corner), to.corner, f);
    std::transform(std::begin(patch.first), std::end(patch.first), to.first, f);
    std::transform(std::begin(patch.second), std::end(patch.second), to.second, f);
    to.share = f(patch.share);
    to.node_first = patch.node_first;
    to.node_count = patch.node_count;
  }
  const auto round = [&](const std::vector<double> &list, std::vector<float> &to) {
    std::transform(list.begin(), list.end(), std::back_inserter(to), f);
  };
  round(from.node_first, out.node_first);
  round(from.node_second, out.node_second);
  round(from.node_weight, out.node_weight);
}

} // namespace

SceneStore<float> round_scene(const SceneStore<double> &from) {
  const auto f = [](double x) { return static_cast<float>(x); };
  SceneStore<float> out;
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
  out.cones = ConesStore<float>(out.groups);
  for (const auto &error : from.cluster_error) {
    auto &to = out.cluster_error.emplace_back();
    std::transform(std::begin(error.value), std::end(error.value), to.value, f);
  }
  round_patches(from, out);
  for (const auto &lobe : from.lobes)
    out.lobes.push_back(kernel::round_lobe(lobe));
  for (const auto &family : from.families) {
    auto &to = out.families.emplace_back();
    to.node_count = family.node_count;
    std::transform(std::begin(family.node), std::end(family.node), to.node, kernel::round_lobe);
    for (std::size_t lobe = 0; lobe < backend::family_lobes_max; ++lobe)
      std::transform(std::begin(family.weight[lobe]), std::end(family.weight[lobe]),
                     to.weight[lobe], f);
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
